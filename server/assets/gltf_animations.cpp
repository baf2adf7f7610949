#include "server/assets/gltf_animations.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "server/assets/gltf_attribute_rules.hpp"
#include "server/assets/gltf_tracks.hpp"
#include "server/assets/unique_names.hpp"

namespace tweend::assets {
namespace {

using animation::Interpolation;
using animation::Property;

constexpr GltfAccessorRule kTimesRule{"SCALAR", gltf_numbers::kFloat};

/// What a channel moves.
struct Target {
  Property property = Property::Translation;
  std::uint32_t first = 0;  ///< the joint, or the first weight
  std::size_t count = 1;    ///< weights

  [[nodiscard]] GltfAccessorRule rule() const {
    if (property == Property::Weight) return {"SCALAR", gltf_numbers::kSignedFractions};
    if (property == Property::Rotation) return {"VEC4", gltf_numbers::kSignedFractions};
    return {"VEC3", gltf_numbers::kFloat};
  }
};

Result<Interpolation> read_interpolation(const JsonNode& sampler) {
  const auto node = sampler.find("interpolation");
  if (!node) return Interpolation::Linear;
  TWEEND_ASSIGN(const std::string_view text, node->text());
  if (text == "LINEAR") return Interpolation::Linear;
  if (text == "STEP") return Interpolation::Step;
  if (text == "CUBICSPLINE") return Interpolation::Cubic;
  return node->expected("LINEAR, STEP or CUBICSPLINE");
}

/// The numbers of one element of a channel's output, of which there are `count` side by side for weights.
class Output {
 public:
  Output(const std::vector<float>& floats, const GltfAccessor& accessor, const Target& target)
      : floats_(floats), width_(accessor.width), elements_(target.count) {}
  [[nodiscard]] glm::vec4 at(std::size_t row, std::size_t element) const {
    glm::vec4 value(0.0F);
    for (std::size_t i = 0; i < width_; ++i) {
      value[static_cast<glm::length_t>(i)] = floats_[(row * elements_ + element) * width_ + i];
    }
    return value;
  }

 private:
  const std::vector<float>& floats_;
  std::size_t width_;
  std::size_t elements_;
};

class AnimationReader {
 public:
  AnimationReader(const GltfFile& file, const GltfScene& scene, const GltfMesh& mesh, GltfAccessors& accessors,
                  const Limits& limits, GltfWarnings& warnings)
      : file_(file),
        scene_(scene),
        mesh_(mesh),
        accessors_(accessors),
        limits_(limits),
        warnings_(warnings),
        values_left_(limits.keyed_values) {}

  Result<model::Clip> read(const JsonNode& node, std::string name) {
    tracks_.clear();
    times_.clear();
    list_of_accessor_.clear();
    TWEEND_ASSIGN(const JsonNode channels, node.get("channels"));
    TWEEND_ASSIGN(const JsonNode samplers, node.get("samplers"));
    TWEEND_TRY(channels.expect_array());
    TWEEND_TRY(samplers.expect_array());
    std::set<std::pair<Property, std::uint32_t>> moved;
    for (std::size_t i = 0; i < channels.size(); ++i) {
      TWEEND_ASSIGN(const std::optional<Target> target, read_target(channels.at(i)));
      if (!target) continue;
      if (!moved.emplace(target->property, target->first).second) {
        return channels.at(i).error("expected a target that no other channel of the animation has, found one that has");
      }
      TWEEND_ASSIGN(const JsonNode reference, channels.at(i).get("sampler"));
      TWEEND_ASSIGN(const std::size_t index, reference.index(samplers.size(), "samplers of the animation"));
      TWEEND_TRY(read_sampler(samplers.at(index), *target));
    }
    model::Clip clip = make_clip(std::move(name), tracks_, times_);
    if (clip.keyframes.size() > limits_.keyframes_per_clip) {
      return node.error(
          fmt::format("expected at most {} keyframes, found {}", limits_.keyframes_per_clip, clip.keyframes.size()),
          ErrorCode::Limit);
    }
    return clip;
  }

 private:
  /// Nothing: there is nothing to be moved here.
  Result<std::optional<Target>> read_target(const JsonNode& channel) {
    constexpr std::array<std::string_view, 4> kPaths{"translation", "rotation", "scale", "weights"};
    TWEEND_ASSIGN(const JsonNode target, channel.get("target"));
    TWEEND_ASSIGN(const JsonNode path, target.get("path"));
    TWEEND_ASSIGN(const std::string_view text, path.text());
    const auto reference = target.find("node");
    if (!reference) return std::optional<Target>();
    const auto* const known = std::find(kPaths.begin(), kPaths.end(), text);
    if (known == kPaths.end()) {
      warnings_.add(path, "expected translation, rotation, scale or weights, found another: the channel is left out");
      return std::optional<Target>();
    }
    TWEEND_ASSIGN(const JsonNode node, file_.refer(*reference, "nodes"));
    const auto joint = scene_.joint_of_node[node.position()];
    if (!joint) return std::optional<Target>();
    Target found{static_cast<Property>(known - kPaths.begin()), *joint, 1};
    if (found.property == Property::Weight) {
      const auto weights = mesh_.weights_of_node[node.position()];
      if (!weights) {
        warnings_.add(*reference, "expected a node whose mesh has morph targets, found one without: the channel is left out");
        return std::optional<Target>();
      }
      found.first = weights->first;
      found.count = weights->count;
    }
    return std::optional(found);
  }

  Result<std::size_t> read_times(const JsonNode& reference) {
    TWEEND_ASSIGN(const GltfAccessor accessor, accessors_.describe(reference, kTimesRule));
    const auto known = list_of_accessor_.find(accessor.node.position());
    if (known != list_of_accessor_.end()) return known->second;
    TWEEND_TRY(accessors_.check_backed(accessor));
    if (accessor.count > limits_.keyframes_per_clip) {
      return accessor.node.error(
          fmt::format("expected at most {} keyframes, found {}", limits_.keyframes_per_clip, accessor.count), ErrorCode::Limit);
    }
    TWEEND_ASSIGN(std::vector<float> times, accessors_.floats(accessor));
    for (std::size_t i = 0; i < times.size(); ++i) {
      if (times[i] < 0.0F || (i > 0 && times[i] <= times[i - 1])) {
        return accessor.node.error(fmt::format("expected times >= 0, each beyond the one before; found {} at key {}{}",
                                               times[i], i, i > 0 ? fmt::format(" behind {}", times[i - 1]) : ""));
      }
    }
    list_of_accessor_.emplace(accessor.node.position(), times_.size());
    times_.push_back(std::move(times));
    return times_.size() - 1;
  }

  Status read_sampler(const JsonNode& sampler, const Target& target) {
    TWEEND_TRY(sampler.expect_object());
    TWEEND_ASSIGN(const JsonNode input, sampler.get("input"));
    TWEEND_ASSIGN(const JsonNode output, sampler.get("output"));
    TWEEND_ASSIGN(const Interpolation interpolation, read_interpolation(sampler));
    TWEEND_ASSIGN(const std::size_t list, read_times(input));
    const std::size_t keys = times_[list].size();
    TWEEND_ASSIGN(const GltfAccessor accessor, accessors_.describe(output, target.rule()));
    const std::size_t rows = interpolation == Interpolation::Cubic ? 3 : 1;
    TWEEND_TRY(expect_count(accessor, keys * rows * target.count, output));
    if (keys * target.count > values_left_) {
      TWEEND_TRY(accessors_.check_backed(accessor));
      return accessor.node.error(
          fmt::format("expected at most {} more keyed values, found {}", values_left_, keys * target.count), ErrorCode::Limit);
    }
    values_left_ -= keys * target.count;
    TWEEND_ASSIGN(const std::vector<float> floats, accessors_.floats(accessor));
    const Output rows_of(floats, accessor, target);
    for (std::size_t element = 0; element < target.count; ++element) {
      GltfTrack track{{target.first + static_cast<std::uint32_t>(element), target.property}, interpolation, list, {}, {}};
      TWEEND_TRY(fill(track, rows_of, element, keys, accessor.node));
      tracks_.push_back(std::move(track));
    }
    return {};
  }

  /// CUBICSPLINE has three rows a key: the in-tangent, the value, the out-tangent.
  static Status fill(GltfTrack& track, const Output& output, std::size_t element, std::size_t keys, const JsonNode& node) {
    const bool cubic = track.interpolation == Interpolation::Cubic;
    track.values.reserve(keys);
    for (std::size_t key = 0; key < keys; ++key) {
      glm::vec4 value = output.at(cubic ? 3 * key + 1 : key, element);
      if (track.channel.property == Property::Rotation) {
        const glm::dvec4 wide(value);
        const double length = glm::length(wide);
        if (!(length > 1e-30))
          return node.error(fmt::format("expected unit quaternions, found one of length 0 at key {}", key));
        value = glm::vec4(wide / length);
      }
      track.values.push_back(value);
      if (cubic) track.tangents.push_back({output.at(3 * key, element), output.at(3 * key + 2, element)});
    }
    return {};
  }

  const GltfFile& file_;
  const GltfScene& scene_;
  const GltfMesh& mesh_;
  GltfAccessors& accessors_;
  const Limits& limits_;
  GltfWarnings& warnings_;
  std::size_t values_left_;
  // Of the animation that is being read:
  std::vector<GltfTrack> tracks_;
  std::vector<std::vector<float>> times_;
  std::map<std::size_t, std::size_t> list_of_accessor_;  ///< place in times_, by index of the accessor
};

}  // namespace

Result<std::vector<model::Clip>> read_gltf_animations(const GltfFile& file, const GltfScene& scene, const GltfMesh& mesh,
                                                      GltfAccessors& accessors, const Limits& limits, GltfWarnings& warnings,
                                                      GltfProgress& progress) {
  std::vector<model::Clip> clips;
  const auto animations = file.root().find("animations");
  const std::size_t count = file.count("animations");
  if (count > limits.clips_per_actor) {
    return animations->error(fmt::format("expected at most {} animations, found {}", limits.clips_per_actor, count),
                             ErrorCode::Limit);
  }
  std::vector<std::string> names;
  for (std::size_t i = 0; i < count; ++i) {
    TWEEND_ASSIGN(const std::string_view name, animations->at(i).text_or_empty("name"));
    names.emplace_back(name);
  }
  names = make_unique(std::move(names), [](std::size_t i) { return fmt::format("animation_{}", i); });
  AnimationReader reader(file, scene, mesh, accessors, limits, warnings);
  for (std::size_t i = 0; i < count; ++i) {
    TWEEND_ASSIGN(model::Clip clip, reader.read(animations->at(i), std::move(names[i])));
    clips.push_back(std::move(clip));
    progress.part_done();
  }
  return clips;
}

}  // namespace tweend::assets
