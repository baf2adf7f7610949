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
  StillJob(StillRequest request, DrawnStillDone done) : request_(std::move(request)), done_(std::move(done)) {}

  void compose(render::RenderThread& renderer) {
    if (request_.time_s) {
      stage::show_time(*request_.view, *request_.time_s, request_.now_us, show_);
    } else {
      stage::show_at(*request_.view, request_.now_us, show_);
    }
    composer_.compose(show_, request_.camera, request_.size, picture_);
    renderer.submit(shared_from_this(), request_.now_us + kPatienceUs);
  }

  [[nodiscard]] const render::Picture& picture() const noexcept override { return picture_; }

  void drawn(Result<render::PixelsPtr> pixels) noexcept override {
    if (!pixels) return done_(pixels.error());
    done_(DrawnStill{show_.actors.empty() ? 0.0 : show_.actors.front().time_s, std::move(*pixels)});
  }

 private:
  const StillRequest request_;
  const DrawnStillDone done_;
  stage::Show show_;
  FrameComposer composer_;  ///< the picture borrows of it
  render::Picture picture_;
};

Result<Still> encode(const DrawnStill& drawn, ImageFormat format, int quality) {
  const render::ImageView image = drawn.pixels->view();
  TWEEND_ASSIGN(std::vector<std::byte> file,
                format == ImageFormat::Png ? render::encode_png(image) : render::encode_jpeg(image, quality));
  return Still{drawn.time_s, std::move(file)};
}

}  // namespace

void draw_still(StillRequest request, WorkerPool& workers, render::RenderThread& renderer, DrawnStillDone done) {
  const auto job = std::make_shared<StillJob>(std::move(request), std::move(done));
  workers.post([job, &renderer] { job->compose(renderer); });
}

void render_still(StillRequest request, WorkerPool& workers, render::RenderThread& renderer, StillDone done) {
  const ImageFormat format = request.format;
  const int quality = request.quality;
  draw_still(std::move(request), workers, renderer,
             [&workers, format, quality, done = std::move(done)](Result<DrawnStill> drawn) {
               if (!drawn) return done(drawn.error());
               workers.post([drawn = std::move(*drawn), format, quality, done] { done(encode(drawn, format, quality)); });
             });
}

}  // namespace tweend::streams
