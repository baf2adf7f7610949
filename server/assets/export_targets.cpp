#include "server/assets/export_targets.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <span>

namespace tweend::assets {
namespace {

std::vector<float> less(std::vector<float> a, std::span<const float> b) {
  for (std::size_t i = 0; i < a.size(); ++i) a[i] -= b[i];
  return a;
}

}  // namespace

ExportTargets::ExportTargets(const model::Actor& actor) : actor_(actor), rest_(actor) {
  if (actor.model->morphs) {
    for (const model::MorphTarget& target : actor.model->morphs->targets()) {
      names_.push_back(unique_.unique(target.name));
      weights_.push_back(target.default_weight);
    }
  }
  own_ = names_.size();
  for (const model::ClipPtr& clip : actor.clips) {
    if (clip->type() == model::ClipType::Vertex) add_keys(*clip);
  }
  weights_.resize(names_.size(), 0.0F);
}

void ExportTargets::add_keys(const model::Clip& clip) {
  for (std::size_t k = 0; k < clip.keyframes.size(); ++k) {
    const model::ContentHash& hash = clip.keyframes[k].vertices->hash();
    const bool at_rest = rest_.is_identity() && hash == actor_.model->rest->hash();
    if (!at_rest && !target_of_.contains(hash)) add_key(clip, k);
  }
  // A clip that only ever shows the mesh at rest still has a length, and an animation needs something to move.
  if (names_.empty() && clip.keyframes.size() > 1) add_key(clip, 0);
}

void ExportTargets::add_key(const model::Clip& clip, std::size_t key) {
  target_of_.emplace(clip.keyframes[key].vertices->hash(), names_.size());
  names_.push_back(unique_.unique(fmt::format("{}:{}", clip.name, key)));
  keys_.push_back(clip.keyframes[key].vertices);
}

bool ExportTargets::has_normals() const noexcept {
  if (!keys_.empty()) return true;
  if (own_ == 0) return false;
  return std::ranges::any_of(actor_.model->morphs->targets(), [](const model::MorphTarget& t) { return !t.normals.empty(); });
}

std::optional<std::size_t> ExportTargets::of_key(const model::VertexKey& key) const {
  const auto at = target_of_.find(key.hash());
  return at == target_of_.end() ? std::nullopt : std::optional(at->second);
}

Result<Displacements> ExportTargets::displacements(std::size_t target) const {
  if (target < own_) {
    const model::MorphTarget& own = actor_.model->morphs->targets()[target];
    return Displacements{own.first_vertex, own.positions, own.normals};
  }
  TWEEND_ASSIGN(RestVertices vertices, rest_.unskinned(*keys_[target - own_]));
  const model::VertexKey& base = *actor_.model->rest;
  return Displacements{0, less(std::move(vertices.positions), base.positions()),
                       less(std::move(vertices.normals), base.normals())};
}

}  // namespace tweend::assets
