#include "server/app/render_film.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <future>
#include <iostream>
#include <memory>
#include <utility>

#include "render/h264_encoder.hpp"
#include "render/h264_level.hpp"
#include "render/mp4_writer.hpp"
#include "server/app/output_file.hpp"
#include "server/app/report.hpp"
#include "server/commands/frame_types.hpp"
#include "server/streams/film_range.hpp"

namespace tweend::app {
namespace {

class FilmFile final : public streams::PictureSink {
 public:
  FilmFile(std::unique_ptr<OutputFile> file, render::Mp4Writer writer, std::size_t pictures)
      : file_(std::move(file)), writer_(std::move(writer)), report_(pictures) {}

  Status add(const render::ImageView& image) override {
    TWEEND_TRY(writer_.add(image));
    report_.done(writer_.pictures());
    return {};
  }
  Result<std::uint64_t> finish() override {
    TWEEND_TRY(writer_.finish());
    TWEEND_TRY(file_->commit());
    return writer_.bytes();
  }

 private:
  const std::unique_ptr<OutputFile> file_;  // before the writer, which writes to it
  render::Mp4Writer writer_;
  Report report_;
};

streams::FilmRange range_of(const OfflineOptions& o) { return {o.from_s.value_or(0.0), o.to_s, o.film_fps}; }

Result<std::size_t> pictures_of(const OfflineOptions& o, double clip_s) {
  return streams::pictures_of(range_of(o), clip_s, render::Mp4Writer::kMostPictures, "--");
}

/// Where the film ends if nothing else is said.
Result<double> clip_end_s(const stage::SceneView& view) {
  if (view.scene->actors.empty()) {
    return fail(ErrorCode::NotFound, "expected an actor whose clip says how long the film is, found none; say it with --to S");
  }
  return stage::clip_of(*view.scene->actors.front(), view.players->front())->duration_s();
}

}  // namespace

Status check_film(const OfflineOptions& o) {
  if (!o.mp4.ends_with(".mp4")) {
    return fail(ErrorCode::InvalidParams, fmt::format("expected a name that ends with .mp4 after --mp4, found \"{}\"", o.mp4));
  }
  if (o.size.width % 2 != 0 || o.size.height % 2 != 0) {
    return fail(ErrorCode::InvalidParams,
                fmt::format("expected even sides of a film after --size, found {}x{}", o.size.width, o.size.height));
  }
  if (std::max(o.size.width, o.size.height) > render::kH264MostPixels) {
    return fail(ErrorCode::InvalidParams, fmt::format("expected sides of a film of at most {} pixels after --size, found {}x{}",
                                                      render::kH264MostPixels, o.size.width, o.size.height));
  }
  constexpr double kLeast = commands::kFilmRate.min, kMost = commands::kFilmRate.max;
  if (o.film_fps < kLeast || o.film_fps > kMost) {
    return fail(ErrorCode::InvalidParams,
                fmt::format("expected {} to {} pictures a second after --fps, found {}", kLeast, kMost, o.film_fps));
  }
  if (o.to_s) TWEEND_TRY(pictures_of(o, 0.0));
  if (!render::has_h264()) {
    return fail(ErrorCode::Unavailable,
                "expected a build with H.264 for --mp4, found one without; build tweend with -DTWEEND_H264=ON");
  }
  return {};
}

Status render_film(const OfflineOptions& o, const OfflineScene& scene) {
  const stage::SceneViewPtr view = scene.view();
  TWEEND_ASSIGN(const double clip_s, o.to_s ? Result<double>(*o.to_s) : clip_end_s(*view));
  TWEEND_ASSIGN(const std::size_t pictures, pictures_of(o, clip_s));
  TWEEND_ASSIGN(std::unique_ptr<OutputFile> file, OutputFile::open(o.mp4));
  TWEEND_ASSIGN(render::Mp4Writer writer, render::Mp4Writer::open({o.size, o.film_fps, pictures}, *file));
  const auto source = std::make_shared<streams::ClipSource>(view, range_of(o).from_s, o.film_fps, pictures, steady_now_us());
  std::promise<Result<streams::Film>> promise;
  const commands::Services& services = scene.services();
  const auto maker = std::make_shared<streams::FilmMaker>(
      streams::FilmMaker::Parts{source, std::make_unique<FilmFile>(std::move(file), std::move(writer), pictures), o.size,
                                scene.camera()},
      services.workers, services.renderer, [&promise](const Result<streams::Film>& film) { promise.set_value(film); });
  maker->go_on();
  TWEEND_ASSIGN(const streams::Film film, promise.get_future().get());
  std::cout << fmt::format("{}: {} x {}, {} picture{} at {} a second, {:.1f} kB\n", o.mp4, o.size.width, o.size.height,
                           film.pictures, film.pictures == 1 ? "" : "s", o.film_fps, static_cast<double>(film.bytes) / 1000.0);
  return {};
}

}  // namespace tweend::app
