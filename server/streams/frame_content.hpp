#pragma once

#include <boost/asio/io_context.hpp>
#include <memory>
#include <optional>
#include <string>

#include "render/h264_encoder.hpp"
#include "render/image_encoder.hpp"
#include "render/render_thread.hpp"
#include "server/base/worker_pool.hpp"
#include "server/streams/content.hpp"
#include "server/streams/picture_desk.hpp"

namespace tweend::streams {

/// Pictures of a scene, in two steps: drawn, shared with all who look the same way at the same moment; then encoded on a
/// worker, while the next one is drawn already.
class FrameContent final : public Content, public PictureUser, public std::enable_shared_from_this<FrameContent> {
 public:
  /// @param rate  packets a second that are to be expected
  FrameContent(FramesSpec spec, double rate, boost::asio::io_context& strand, WorkerPool& workers, PictureDesk& desk,
               ContentOwner& owner)
      : spec_(std::move(spec)), rate_(rate), strand_(strand), workers_(workers), desk_(desk), owner_(owner) {}

  [[nodiscard]] bool follow(const stage::SceneViewPtr& view) override;
  [[nodiscard]] bool shows_the_same(const stage::SceneView& next) const noexcept override;
  [[nodiscard]] ClockUs earliest_us() const noexcept override;
  [[nodiscard]] ContentReading read(ClockUs at_us) override;
  void begin(NewPacketPtr packet, ClockUs deadline_us) override;
  [[nodiscard]] bool chained() const noexcept override { return spec_.encoding == FrameEncoding::H264; }
  void look_from(const StreamKey& key) override { spec_.camera = std::get<FramesSpec>(key.what).camera; }
  void refine(bool refined) override { refined_ = refined; }
  [[nodiscard]] std::string what_is_gone() const override;

  // PictureUser
  void drawn(const Result<render::PixelsPtr>& pixels) override;

 private:
  /// A packet on its way, and how it is to be encoded.
  struct Order {
    NewPacketPtr packet;
    int quality = 0;
  };
  void encode_next();
  void encode();  // worker
  [[nodiscard]] Status write(const render::ImageView& image, Packet& packet);
  [[nodiscard]] Status write_h264(const render::ImageView& image, Packet& packet);
  void encoded();

  FramesSpec spec_;
  const double rate_;
  boost::asio::io_context& strand_;
  WorkerPool& workers_;
  PictureDesk& desk_;
  ContentOwner& owner_;
  stage::SceneViewPtr view_;
  MomentPtr moment_;      ///< what was read last
  bool refined_ = false;  ///< what is begun next is as good as was asked for

  // The picture that is being drawn.
  bool waiting_ = false;  ///< drawn, while the one before is still being encoded
  Order drawing_;
  Result<render::PixelsPtr> pixels_{render::PixelsPtr()};
  // The picture that is being encoded: filled on the strand, read by a worker, never at both at once.
  bool encoding_ = false;
  Order encoded_;
  Result<render::PixelsPtr> encoding_pixels_{render::PixelsPtr()};
  render::JpegEncoder jpeg_;
  Payload draft_;                            ///< as long as a JPEG may become
  std::optional<render::H264Encoder> h264_;  ///< opened with the first picture
  Status outcome_;
};

}  // namespace tweend::streams
