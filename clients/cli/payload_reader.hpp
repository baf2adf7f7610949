#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <span>
#include <vector>

#include "clients/cli/connection.hpp"
#include "protocol/pose_q16.hpp"
#include "protocol/vertices_meshopt.hpp"

namespace tweend::cli {

/// Reads the packets of one stream of vertices, in any encoding. It has to be given all that come, in their order: some need
/// their predecessor.
class VerticesReader {
 public:
  /// @param layout  as stream.open answered it
  explicit VerticesReader(const Json& layout);

  /// @return shape [n × 3], model space; valid until the next call
  /// Throws NoServer, naming the packet, where it holds no such vertices.
  [[nodiscard]] std::span<const float> positions(const Packet& packet);

 private:
  std::size_t count_;
  protocol::VerticesMeshoptDecoder meshopt_;
  std::vector<float> positions_;
  std::vector<float> normals_;
};

/// The same of one stream of poses.
class PoseReader {
 public:
  explicit PoseReader(const Json& layout);

  [[nodiscard]] std::size_t joint_count() const noexcept { return joint_count_; }
  [[nodiscard]] std::size_t weight_count() const noexcept { return weights_.size(); }
  /// @return shape [joints × 10]: translation xyz, rotation xyzw, scale xyz; valid until the next call
  /// Throws NoServer, naming the packet, where it holds no such pose.
  [[nodiscard]] std::span<const float> joints(const Packet& packet);

 private:
  std::size_t joint_count_;
  protocol::PoseQ16Decoder q16_;
  std::vector<float> joints_;
  std::vector<float> weights_;
};

}  // namespace tweend::cli
