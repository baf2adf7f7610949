#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "tests/streams/streaming.hpp"

namespace tweend::test {

/// RGBA, top row first.
struct Decoded {
  render::Size size;
  std::vector<std::uint8_t> rgba;
};

[[nodiscard]] Decoded decode_jpeg(std::span<const std::byte> file);
[[nodiscard]] Decoded decode_png(std::span<const std::byte> file);
/// As a stream of rgba has it.
[[nodiscard]] Decoded decode_rgba(std::span<const std::byte> bytes, render::Size size);
[[nodiscard]] Decoded decoded(const render::ImageView& image);
/// By the packet's own encoding; only rgba needs the size.
[[nodiscard]] Decoded decoded(const streams::Packet& packet, render::Size size);

/// The mean difference of two pictures' channels, 0 to 255; 255 where they are not of one size.
[[nodiscard]] double mean_difference(const Decoded& a, const Decoded& b);
/// How many pixels are not what the first one (the background) is.
[[nodiscard]] std::size_t covered(const Decoded& picture);

inline constexpr render::Size kSmall{64, 48};

/// A camera above the squares of tests/support/scenes.hpp, so high that the first four heights are in view.
[[nodiscard]] model::CameraRequest from_above(float height = 8.0F);

[[nodiscard]] streams::StreamKey frames_of(std::string scene, streams::FrameEncoding encoding = streams::FrameEncoding::Rgba,
                                           double rate = 100.0);
/// The same, seen by an own camera.
[[nodiscard]] streams::StreamKey seen_by(streams::StreamKey key, model::CameraRequest camera);

/// The picture of what a view shows at a reading, drawn for itself; waits for it.
[[nodiscard]] Decoded picture_of(Streaming& s, const streams::StreamKey& key, const stage::SceneViewPtr& view,
                                 ClockUs at_us = steady_now_us());

}  // namespace tweend::test
