#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>

#include "render/picture.hpp"
#include "server/model/camera.hpp"

namespace tweend::streams {

/// Pose of one actor, 32-bit floats.
struct PoseSpec {
  std::string actor;
  bool operator==(const PoseSpec&) const = default;
};

/// Vertices of one actor, positions then normals, 32-bit floats.
struct VerticesSpec {
  std::string actor;
  bool operator==(const VerticesSpec&) const = default;
};

enum class FrameEncoding : std::uint8_t { Jpeg, Png, Rgba };

/// Pictures of a scene.
struct FramesSpec {
  std::string actor;  ///< whose media time the packets carry; empty: the first's
  FrameEncoding encoding = FrameEncoding::Jpeg;
  render::Size size;
  int quality = 80;                            ///< of a JPEG, 1 to 100
  std::optional<model::CameraRequest> camera;  ///< the viewer's own; empty: the scene's
  bool operator==(const FramesSpec&) const = default;
};

/// What tells producers apart: streams with equal keys share one.
struct StreamKey {
  std::string scene;
  double rate = 30.0;  ///< packets a second
  std::variant<VerticesSpec, FramesSpec, PoseSpec> what;
  bool operator==(const StreamKey&) const = default;
};

/// Whether a producer of one can be turned into a producer of the other: only rate and camera differ.
[[nodiscard]] bool same_but_view(const StreamKey& a, const StreamKey& b);

}  // namespace tweend::streams
