#include "server/assets/glb_influences.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/container/static_vector.hpp>
#include <vector>

namespace tweend::assets {
namespace {

constexpr std::size_t kMostInfluences = 8;
constexpr std::size_t kSetInfluences = 4;

struct Influence {
  std::uint16_t entry = 0;
  float weight = 0.0F;
};
using Influences = boost::container::static_vector<Influence, kMostInfluences>;

/// Those of a vertex, heaviest first.
Influences influences_of(const animation::SkinInfluences& skin, std::size_t vertex) {
  Influences found;
  double sum = 0.0;
  for (std::size_t i = vertex * skin.per_vertex; i < (vertex + 1) * skin.per_vertex; ++i) {
    if (!(skin.weights[i] > 0.0F)) continue;
    const auto same = std::ranges::find(found, skin.entries[i], &Influence::entry);
    if (same != found.end()) {
      same->weight += skin.weights[i];
    } else {
      found.push_back({skin.entries[i], skin.weights[i]});
    }
    sum += skin.weights[i];
  }
  std::ranges::stable_sort(found, std::ranges::greater(), &Influence::weight);
  double others = 0.0;
  for (std::size_t i = 1; i < found.size(); ++i) {
    found[i].weight = static_cast<float>(found[i].weight / sum);
    others += found[i].weight;
  }
  if (!found.empty()) found.front().weight = static_cast<float>(1.0 - others);  // takes what rounding has left
  return found;
}

}  // namespace

void add_influences(const model::Skin& skin, std::span<const std::uint32_t> vertices, GlbPrimitive& primitive,
                    GlbDocument& document) {
  const animation::SkinInfluences all = skin.influences();
  const std::size_t sets = (all.per_vertex + kSetInfluences - 1) / kSetInfluences;
  std::vector<std::vector<std::uint16_t>> joints(sets);
  std::vector<std::vector<float>> weights(sets);
  for (const std::uint32_t v : vertices) {
    Influences found = influences_of(all, v);
    found.resize(sets * kSetInfluences);
    for (std::size_t i = 0; i < found.size(); ++i) {
      joints[i / kSetInfluences].push_back(found[i].entry);
      weights[i / kSetInfluences].push_back(found[i].weight);
    }
  }
  for (std::size_t set = 0; set < sets; ++set) {
    primitive.attributes.emplace_back(fmt::format("JOINTS_{}", set), add_joints(document, joints[set]));
    primitive.attributes.emplace_back(fmt::format("WEIGHTS_{}", set),
                                      add_floats(document, weights[set], GlbShape::Vec4, GlbUse::Vertices, false));
  }
}

}  // namespace tweend::assets
