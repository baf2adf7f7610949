#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "server/base/result.hpp"
#include "server/model/clip.hpp"

namespace tweend::assets {

/// One channel of an animation, with keys of its own.
struct GltfTrack {
  animation::Channel channel;
  animation::Interpolation interpolation = animation::Interpolation::Linear;
  std::size_t times = 0;                       ///< which of the lists of times are its own
  std::vector<glm::vec4> values;               ///< shape [those times]
  std::vector<model::KeyedTangents> tangents;  ///< the same shape, or empty
};

/// When the keys of several tracks are, brought onto one line.
struct GltfTimeline {
  std::vector<double> times_s;  ///< ascending, at least kSameTimeSeconds apart
  /// Key number `key` of the list of times `list` stands at a time.
  struct Key {
    std::uint32_t list = 0;
    std::uint32_t key = 0;
  };
  std::vector<std::vector<Key>> keys;  ///< shape [times_s]
};

/// Keys of different lists that are less than kSameTimeSeconds apart stand at one time, the earliest; such keys of one list
/// move apart.
/// @param lists  each strictly ascending, >= 0
[[nodiscard]] GltfTimeline merge_times(const std::vector<std::vector<float>>& lists);

/// The keyframes of a clip; without ids. Tracks have different channels.
/// @param lists  that the tracks' `times` index
[[nodiscard]] model::Clip make_clip(std::string name, const std::vector<GltfTrack>& tracks,
                                    const std::vector<std::vector<float>>& lists);

}  // namespace tweend::assets
