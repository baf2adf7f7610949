#pragma once

#include <boost/asio/io_context.hpp>
#include <memory>
#include <string>

#include "render/image_encoder.hpp"
#include "render/render_thread.hpp"
#include "server/base/worker_pool.hpp"
#include "server/streams/content.hpp"
#include "server/streams/frame_composer.hpp"

namespace tweend::streams {

/// Pictures of a scene, in two steps: composed on a worker and drawn by the render thread; then encoded on a worker, while
/// the next one is drawn already.
class FrameContent final : public Content, public render::FrameJob, public std::enable_shared_from_this<FrameContent> {
 public:
  FrameContent(FramesSpec spec, boost::asio::io_context& strand, WorkerPool& workers, render::RenderThread& renderer,
               ContentOwner& owner)
      : spec_(std::move(spec)), strand_(strand), workers_(workers), renderer_(renderer), owner_(owner) {}

  [[nodiscard]] bool follow(const stage::SceneViewPtr& view) override;
  [[nodiscard]] bool shows_the_same(const stage::SceneView& next) const noexcept override;
  [[nodiscard]] ClockUs earliest_us() const noexcept override;
  [[nodiscard]] ContentReading read(ClockUs at_us) override;
  void begin(NewPacketPtr packet, ClockUs deadline_us) override;
  void look_from(const StreamKey& key) override { spec_.camera = std::get<FramesSpec>(key.what).camera; }
  [[nodiscard]] std::string what_is_gone() const override;

  // render::FrameJob, on the render thread
  [[nodiscard]] const render::Picture& picture() const noexcept override { return picture_; }
  void drawn(Result<render::PixelsPtr> pixels) noexcept override;

 private:
  void compose();  // worker
  void drawn_on_strand();
  void encode_next();
  void encode();  // worker
  [[nodiscard]] Status write(const render::ImageView& image, Payload& payload);
  void encoded();

  FramesSpec spec_;
  boost::asio::io_context& strand_;
  WorkerPool& workers_;
  render::RenderThread& renderer_;
  ContentOwner& owner_;
  stage::SceneViewPtr view_;

  // The picture that is being drawn: filled on the strand, handed on from thread to thread, never at two at once.
  bool waiting_ = false;  ///< drawn, while the one before is still being encoded
  stage::Show show_;
  std::optional<model::CameraRequest> camera_;
  ClockUs deadline_us_ = 0;
  FrameComposer composer_;
  render::Picture picture_;
  NewPacketPtr drawing_packet_;
  Result<render::PixelsPtr> pixels_{render::PixelsPtr()};
  // The picture that is being encoded.
  bool encoding_ = false;
  NewPacketPtr encoding_packet_;
  Result<render::PixelsPtr> encoding_pixels_{render::PixelsPtr()};
  render::JpegEncoder jpeg_;
  Status outcome_;
};

}  // namespace tweend::streams
