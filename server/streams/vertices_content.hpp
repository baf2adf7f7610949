#pragma once

#include <boost/asio/io_context.hpp>
#include <string>

#include "server/base/worker_pool.hpp"
#include "server/model/evaluate.hpp"
#include "server/streams/content.hpp"

namespace tweend::streams {

/// An actor's vertices, evaluated on a worker straight into the packet.
class VerticesContent final : public Content {
 public:
  VerticesContent(const VerticesSpec& spec, std::string scene, boost::asio::io_context& strand, WorkerPool& workers,
                  ContentOwner& owner)
      : spec_(spec), scene_(std::move(scene)), strand_(strand), workers_(workers), owner_(owner) {}

  [[nodiscard]] bool follow(const stage::SceneViewPtr& view) override;
  [[nodiscard]] bool shows_the_same(const stage::SceneView& next) const noexcept override;
  [[nodiscard]] ClockUs earliest_us() const noexcept override { return (*view_->players)[actor_].anchor_us; }
  [[nodiscard]] ContentReading read(ClockUs at_us) override;
  void begin(NewPacketPtr packet, ClockUs deadline_us) override;
  [[nodiscard]] std::string what_is_gone() const override;

 private:
  void evaluate();
  void evaluated();

  const VerticesSpec spec_;
  const std::string scene_;
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

}  // namespace tweend::streams
