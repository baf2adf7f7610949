#include "server/streams/film.hpp"

#include <utility>

#include "server/base/clock.hpp"

namespace tweend::streams {
namespace {

/// How long a picture may wait behind those of streams, which show what is now.
constexpr ClockUs kPatienceUs = 1'000'000;

}  // namespace

FilmMaker::FilmMaker(Parts parts, WorkerPool& workers, render::RenderThread& renderer, FilmDone done)
    : source_(std::move(parts.source)),
      sink_(std::move(parts.sink)),
      size_(parts.size),
      camera_(std::move(parts.camera)),
      workers_(workers),
      renderer_(renderer),
      done_(std::move(done)) {}

void FilmMaker::go_on() {
  {
    const std::lock_guard lock(mutex_);
    if (ended_) return;
    if (std::exchange(drawing_, true)) {
      asked_again_ = true;
      return;
    }
  }
  workers_.post([self = shared_from_this()] { self->compose(); });
}

void FilmMaker::give_up(const Error& error) {
  const std::lock_guard lock(mutex_);
  if (ended_) return;
  end(error);
  if (over()) workers_.post([self = shared_from_this()] { self->finish(); });
}

std::size_t FilmMaker::pictures() const {
  const std::lock_guard lock(mutex_);
  return pictures_;
}

void FilmMaker::compose() {
  for (;;) {
    const FilmSource::Next next = source_->next(show_);
    if (next == FilmSource::Next::Picture) {
      composer_.compose(show_, camera_, size_, picture_);
      return renderer_.submit(shared_from_this(), steady_now_us() + kPatienceUs);
    }
    const std::lock_guard lock(mutex_);
    if (next == FilmSource::Next::Later && !ended_ && std::exchange(asked_again_, false)) continue;
    drawing_ = false;
    if (next == FilmSource::Next::End) end();
    if (!over()) return;
    break;
  }
  finish();
}

void FilmMaker::drawn(Result<render::PixelsPtr> pixels) noexcept {
  const std::lock_guard lock(mutex_);
  if (!pixels) end(pixels.error());
  if (ended_) {
    drawing_ = false;
    if (over()) workers_.post([self = shared_from_this()] { self->finish(); });
    return;
  }
  if (encoding_) {
    waiting_ = std::move(*pixels);
  } else {
    encode_later(std::move(*pixels));
  }
}

void FilmMaker::encode(render::PixelsPtr pixels) {
  const Status added = sink_->add(pixels->view());
  pixels.reset();
  {
    const std::lock_guard lock(mutex_);
    if (added) {
      ++pictures_;
    } else {
      end(added);
    }
    if (waiting_ && !ended_) return encode_later(std::move(waiting_));
    if (std::exchange(waiting_, {})) drawing_ = false;
    encoding_ = false;
    if (!over()) return;
  }
  finish();
}

void FilmMaker::encode_later(render::PixelsPtr pixels) {
  encoding_ = true;
  // The next one first: it is short, and is drawn while this one is encoded.
  workers_.post([self = shared_from_this()] { self->compose(); });
  workers_.post([self = shared_from_this(), pixels = std::move(pixels)]() mutable { self->encode(std::move(pixels)); });
}

void FilmMaker::end(const Status& outcome) {
  ended_ = true;
  if (outcome_) outcome_ = outcome;  // the first thing that went wrong is the reason
}

void FilmMaker::finish() {
  const auto result = [&]() -> Result<Film> {
    TWEEND_TRY(outcome_);
    TWEEND_ASSIGN(const std::uint64_t bytes, sink_->finish());
    return Film{pictures_, bytes};
  }();
  sink_.reset();
  done_(result);
}

}  // namespace tweend::streams
