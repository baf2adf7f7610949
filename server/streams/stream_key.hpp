#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>

#include "render/picture.hpp"
#include "server/model/camera.hpp"

namespace tweend::streams {

enum class PoseEncoding : std::uint8_t { F32, Q16 };

/// Pose of one actor.
struct PoseSpec {
  std::string actor;
  PoseEncoding encoding = PoseEncoding::F32;
  bool operator==(const PoseSpec&) const = default;
};

enum class VerticesEncoding : std::uint8_t { F32, Q16, Meshopt };

/// Vertices of one actor.
struct VerticesSpec {
  std::string actor;
  VerticesEncoding encoding = VerticesEncoding::F32;
  bool operator==(const VerticesSpec&) const = default;
};

enum class FrameEncoding : std::uint8_t { Jpeg, Png, H264, Rgba };

/// Pictures of a scene.
struct FramesSpec {
  std::string actor;  ///< whose media time the packets carry; empty: the first's
  FrameEncoding encoding = FrameEncoding::Jpeg;
  render::Size size;
  int quality = 80;                              ///< of a JPEG, 1 to 100
  std::optional<model::CameraRequest> camera{};  ///< the viewer's own; empty: the scene's
  std::int64_t bit_rate = 0;                     ///< of H.264, bits a second; 0: as many as its quality takes
  std::size_t rung = 0;                          ///< of a JPEG, how far down the ladder (rungs.hpp); 0: as asked for
  bool operator==(const FramesSpec&) const = default;
};

/// What tells producers apart: streams with equal keys share one.
struct StreamKey {
  std::string scene;
  double rate = 30.0;  ///< packets a second
  std::variant<VerticesSpec, FramesSpec, PoseSpec> what;
  bool operator==(const StreamKey&) const = default;
};

/// What tells streams apart for whoever reads their figures: all of the key but the camera, which has no end of values, as
/// Prometheus labels without braces.
[[nodiscard]] std::string labels_of(const StreamKey& key);

/// Whether a producer of one can be turned into a producer of the other: only rate (not of H.264) and camera differ.
[[nodiscard]] bool same_but_view(const StreamKey& a, const StreamKey& b);

}  // namespace tweend::streams
