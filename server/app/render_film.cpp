#include "server/app/render_film.hpp"

#include <fmt/format.h>

#include <cmath>
#include <future>
#include <iostream>
#include <memory>
#include <utility>

#include "render/h264_encoder.hpp"
#include "render/mp4_writer.hpp"
#include "server/app/output_file.hpp"
#include "server/app/report.hpp"
#include "server/streams/clip_film.hpp"

namespace tweend::app {
namespace {

constexpr double kMostPictures = 1e8;

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

/// How many pictures, and from where on.
Result<std::size_t> pictures_of(const OfflineOptions& o, const stage::SceneView& view, double from_s) {
  if (!o.to_s && view.scene->actors.empty()) {
    return fail(ErrorCode::NotFound, "expected an actor whose clip says how long the film is, found none; say it with --to S");
  }
  const double to_s = o.to_s ? *o.to_s : stage::clip_of(*view.scene->actors.front(), view.players->front())->duration_s();
  if (to_s < from_s) {
    return fail(ErrorCode::InvalidParams, fmt::format("expected --from before the clip's end, {} s, found {}", to_s, from_s));
  }
  if ((to_s - from_s) * o.film_fps > kMostPictures) {
    return fail(ErrorCode::Limit, fmt::format("expected a film of at most {:.0f} pictures, found {:.0f}", kMostPictures,
                                              (to_s - from_s) * o.film_fps));
  }
  return streams::film_pictures(from_s, to_s, o.film_fps);
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
  if (o.film_fps < streams::kSlowestFilm) {
    return fail(ErrorCode::InvalidParams,
                fmt::format("expected at least {} pictures a second after --fps, found {}", streams::kSlowestFilm, o.film_fps));
  }
  if (o.to_s && *o.to_s < o.from_s.value_or(0.0)) {
    return fail(ErrorCode::InvalidParams,
                fmt::format("expected --to S from {} on, where the film begins, found {}", o.from_s.value_or(0.0), *o.to_s));
  }
  if (!render::has_h264()) {
    return fail(ErrorCode::Unavailable,
                "expected a build with H.264 for --mp4, found one without; build tweend with -DTWEEND_H264=ON");
  }
  return {};
}

Status render_film(const OfflineOptions& o, const OfflineScene& scene) {
  const double from_s = o.from_s.value_or(0.0);
  const stage::SceneViewPtr view = scene.view();
  TWEEND_ASSIGN(const std::size_t pictures, pictures_of(o, *view, from_s));
  TWEEND_ASSIGN(std::unique_ptr<OutputFile> file, OutputFile::open(o.mp4));
  TWEEND_ASSIGN(render::Mp4Writer writer, render::Mp4Writer::open({o.size, o.film_fps, pictures}, *file));
  const auto source = std::make_shared<streams::ClipSource>(view, from_s, o.film_fps, pictures, steady_now_us());
  std::promise<Result<streams::Film>> promise;
  const commands::Services& services = scene.services();
  const auto maker = std::make_shared<streams::FilmMaker>(
      streams::FilmMaker::Parts{source, std::make_unique<FilmFile>(std::move(file), std::move(writer), pictures), o.size,
                                scene.camera()},
      services.workers, services.renderer, [&promise](const Result<streams::Film>& film) { promise.set_value(film); });
  maker->go_on();
  TWEEND_ASSIGN(const streams::Film film, promise.get_future().get());
  std::cout << fmt::format("{}: {} x {}, {} pictures at {} a second, {:.1f} kB\n", o.mp4, o.size.width, o.size.height,
                           film.pictures, o.film_fps, static_cast<double>(film.bytes) / 1000.0);
  return {};
}

}  // namespace tweend::app
