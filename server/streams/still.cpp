#include "server/streams/still.hpp"

#include <memory>
#include <utility>

#include "render/image_encoder.hpp"
#include "server/streams/frame_composer.hpp"

namespace tweend::streams {
namespace {

/// How long a picture may wait behind those of streams, which show what is now.
constexpr ClockUs kPatienceUs = 100'000;

class StillJob final : public render::FrameJob, public std::enable_shared_from_this<StillJob> {
 public:
  StillJob(StillRequest request, WorkerPool& workers, StillDone done)
      : request_(std::move(request)), workers_(workers), done_(std::move(done)) {}

  void compose(render::RenderThread& renderer) {
    if (request_.time_s) {
      stage::show_time(*request_.view, *request_.time_s, request_.now_us, show_);
    } else {
      stage::show_at(*request_.view, request_.now_us, show_);
    }
    FrameComposer().compose(show_, request_.camera, request_.size, picture_);
    renderer.submit(shared_from_this(), request_.now_us + kPatienceUs);
  }

  [[nodiscard]] const render::Picture& picture() const noexcept override { return picture_; }

  void drawn(Result<render::PixelsPtr> pixels) noexcept override {
    if (!pixels) return done_(pixels.error());
    workers_.post([self = shared_from_this(), pixels = std::move(*pixels)] { self->done_(self->encode(pixels->view())); });
  }

 private:
  [[nodiscard]] Result<Still> encode(const render::ImageView& image) const {
    Still still{show_.actors.empty() ? 0.0 : show_.actors.front().time_s, {}};
    if (request_.format == ImageFormat::Png) {
      TWEEND_ASSIGN(still.file, render::encode_png(image));
      return still;
    }
    still.file.resize(render::JpegEncoder::most_bytes(image.size));
    TWEEND_ASSIGN(const std::size_t bytes, render::JpegEncoder().encode(image, request_.quality, still.file));
    still.file.resize(bytes);
    return still;
  }

  const StillRequest request_;
  WorkerPool& workers_;
  const StillDone done_;
  stage::Show show_;
  render::Picture picture_;
};

}  // namespace

void render_still(StillRequest request, WorkerPool& workers, render::RenderThread& renderer, StillDone done) {
  const auto job = std::make_shared<StillJob>(std::move(request), workers, std::move(done));
  workers.post([job, &renderer] { job->compose(renderer); });
}

}  // namespace tweend::streams
