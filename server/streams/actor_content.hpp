#pragma once

#include <boost/asio/io_context.hpp>
#include <string>
#include <utility>
#include <vector>

#include "protocol/pose_q16.hpp"
#include "protocol/vertices_meshopt.hpp"
#include "server/base/worker_pool.hpp"
#include "server/model/evaluate.hpp"
#include "server/streams/content.hpp"
#include "server/streams/stream_key.hpp"

namespace tweend::streams {

/// What one actor shows, evaluated on a worker straight into the packet: its vertices or its pose.
class ActorContent : public Content {
 public:
  ActorContent(std::string scene, std::string actor, boost::asio::io_context& strand, WorkerPool& workers, ContentOwner& owner)
      : scene_(std::move(scene)), actor_name_(std::move(actor)), strand_(strand), workers_(workers), owner_(owner) {}

  [[nodiscard]] bool follow(const stage::SceneViewPtr& view) final;
  [[nodiscard]] bool shows_the_same(const stage::SceneView& next) const noexcept final;
  [[nodiscard]] ClockUs earliest_us() const noexcept final { return (*view_->players)[actor_].anchor_us; }
  [[nodiscard]] ContentReading read(ClockUs at_us) final;
  void begin(NewPacketPtr packet, ClockUs deadline_us) final;
  [[nodiscard]] std::string what_is_gone() const final;

 protected:
  /// Sets the header's kind and encoding and fills the payload. On a worker, one packet at a time.
  virtual void fill(const stage::ActorShow& show, model::Evaluator& evaluator, Packet& packet) = 0;

 private:
  void evaluate();
  void evaluated();

  const std::string scene_;
  const std::string actor_name_;
  boost::asio::io_context& strand_;
  WorkerPool& workers_;
  ContentOwner& owner_;
  stage::SceneViewPtr view_;
  std::size_t actor_ = 0;  ///< its index in the view
  // The evaluation under way, handed to a worker and back. Members and not a closure: nothing is allocated for a packet.
  stage::ActorShow show_;
  model::Evaluator evaluator_;
  NewPacketPtr packet_;
};

/// An actor's vertices.
class VerticesContent final : public ActorContent {
 public:
  VerticesContent(std::string scene, const VerticesSpec& spec, boost::asio::io_context& strand, WorkerPool& workers,
                  ContentOwner& owner)
      : ActorContent(std::move(scene), spec.actor, strand, workers, owner), encoding_(spec.encoding) {}
  [[nodiscard]] bool chained() const noexcept override { return encoding_ == VerticesEncoding::Meshopt; }

 private:
  void fill(const stage::ActorShow& show, model::Evaluator& evaluator, Packet& packet) override;

  const VerticesEncoding encoding_;
  std::vector<float> floats_;  ///< what is to be encoded: positions, then normals
  Payload draft_;              ///< as long as a packet may become
  protocol::VerticesMeshoptEncoder meshopt_;
};

/// An actor's pose: of each joint in the skeleton's order, then the morph weights.
class PoseContent final : public ActorContent {
 public:
  PoseContent(std::string scene, const PoseSpec& spec, boost::asio::io_context& strand, WorkerPool& workers,
              ContentOwner& owner)
      : ActorContent(std::move(scene), spec.actor, strand, workers, owner), encoding_(spec.encoding) {}
  [[nodiscard]] bool chained() const noexcept override { return encoding_ == PoseEncoding::Q16; }

 private:
  void fill(const stage::ActorShow& show, model::Evaluator& evaluator, Packet& packet) override;

  const PoseEncoding encoding_;
  std::vector<float> floats_;  ///< what is to be encoded: joints, then weights
  Payload draft_;              ///< as long as a packet may become
  protocol::PoseQ16Encoder q16_;
};

}  // namespace tweend::streams
