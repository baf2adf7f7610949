#include "server/model/morph_targets.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_set>
#include <utility>

namespace tweend::model {
namespace {

bool all_finite(std::span<const float> values) {
  return std::all_of(values.begin(), values.end(), [](float v) { return std::isfinite(v); });
}

Status check(const MorphTarget& t, std::size_t vertex_count) {
  const std::size_t run = t.positions.size() / 3;
  const auto fits = [&](const std::vector<float>& s) { return s.empty() || s.size() == t.positions.size(); };
  if (t.positions.size() % 3 != 0 || t.first_vertex > vertex_count || run > vertex_count - t.first_vertex || !fits(t.normals) ||
      !fits(t.tangents)) {
    return fail(ErrorCode::InvalidParams,
                fmt::format("expected displacements of a run of the {} vertices, found {} numbers from vertex {} for the morph "
                            "target \"{}\"",
                            vertex_count, t.positions.size(), t.first_vertex, t.name));
  }
  if (all_finite(t.positions) && all_finite(t.normals) && all_finite(t.tangents) && std::isfinite(t.default_weight)) return {};
  return fail(ErrorCode::InvalidParams,
              fmt::format("expected finite displacements and weights of the morph target \"{}\", found others", t.name));
}

}  // namespace

Result<MorphTargetsPtr> MorphTargets::make(std::vector<MorphTarget> targets, std::size_t vertex_count) {
  std::unordered_set<std::string_view> names;
  std::vector<float> reach(vertex_count, 0.0F);
  std::vector<std::uint64_t> words;
  const std::shared_ptr<MorphTargets> all(new MorphTargets);
  all->targets_ = std::move(targets);
  for (const MorphTarget& t : all->targets_) {
    TWEEND_TRY(check(t, vertex_count));
    if (!names.insert(t.name).second) {
      return fail(ErrorCode::InvalidParams,
                  fmt::format("expected names of morph targets that are used once, found \"{}\" again", t.name));
    }
    for (std::size_t i = 0; i + 2 < t.positions.size(); i += 3) {
      reach[t.first_vertex + i / 3] += std::hypot(t.positions[i], t.positions[i + 1], t.positions[i + 2]);
    }
    all->views_.push_back({t.first_vertex, t.positions.size() / 3, {t.positions, t.normals, t.tangents}});
    all->default_weights_.push_back(t.default_weight);
    words.push_back(t.first_vertex);
    for (const ContentHash& h :
         {hash_bytes(std::as_bytes(std::span(t.name))), hash_bytes(std::as_bytes(std::span(&t.default_weight, 1))),
          hash_bytes(std::as_bytes(std::span(t.positions))), hash_bytes(std::as_bytes(std::span(t.normals))),
          hash_bytes(std::as_bytes(std::span(t.tangents)))}) {
      words.insert(words.end(), {h.high, h.low});
    }
  }
  all->reach_ = reach.empty() ? 0.0F : *std::max_element(reach.begin(), reach.end());
  all->hash_ = hash_bytes(std::as_bytes(std::span(words)));
  return MorphTargetsPtr(all);
}

}  // namespace tweend::model
