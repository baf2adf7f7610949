#include "server/streams/clip_film.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>
#include <vector>

#include "render/mp4_writer.hpp"

namespace tweend::streams {
namespace {

Error unwanted() { return fail(ErrorCode::Unavailable, "nobody waits for the film any more"); }

/// Says what to do about a film that gets too long; all else says so itself.
Error advised(Error error) {
  if (error.code == ErrorCode::Limit) error.message += "; ask for part of it, for fewer pictures a second or for smaller ones";
  return error;
}

/// An MP4 file that its maker hands over once it is whole.
class MemoryFilm final : public PictureSink {
 public:
  MemoryFilm(render::Mp4Options options, std::shared_ptr<MemoryFile> file, std::weak_ptr<const void> wanted)
      : options_(options), file_(std::move(file)), wanted_(std::move(wanted)) {}

  Status add(const render::ImageView& image) override {
    if (wanted_.expired()) return unwanted();
    if (!writer_) {
      TWEEND_ASSIGN(render::Mp4Writer opened, render::Mp4Writer::open(options_, *file_));
      writer_.emplace(std::move(opened));
    }
    return writer_->add(image);
  }
  Result<std::uint64_t> finish() override {
    if (!writer_) return fail(ErrorCode::Unavailable, "the server stops");
    TWEEND_TRY(writer_->finish());
    return writer_->bytes();
  }

 private:
  const render::Mp4Options options_;
  const std::shared_ptr<MemoryFile> file_;
  const std::weak_ptr<const void> wanted_;
  std::optional<render::Mp4Writer> writer_;
};

}  // namespace

std::size_t film_pictures(double from_s, double to_s, double fps) noexcept {
  const double pictures = std::round((to_s - from_s) * fps);
  return pictures >= 1.0 ? static_cast<std::size_t>(pictures) : 1;
}

FilmSource::Next ClipSource::next(stage::Show& out) {
  if (next_ == pictures_ || cancelled_) return Next::End;
  stage::show_time(*view_, from_s_ + static_cast<double>(next_++) / fps_, now_us_, out);
  return Next::Picture;
}

/// One of the places; given back with its last copy.
class FilmQueue::Place {
 public:
  explicit Place(std::shared_ptr<FilmQueue> queue) : queue_(std::move(queue)) {}
  ~Place() {
    {
      const std::lock_guard lock(queue_->mutex_);
      --queue_->places_taken_;
    }
    queue_->begin_next();
  }
  Place(const Place&) = delete;
  Place& operator=(const Place&) = delete;

 private:
  const std::shared_ptr<FilmQueue> queue_;
};

Status FilmQueue::make(ClipFilm film, std::weak_ptr<const void> wanted, Done done) {
  drop_unwanted();
  {
    const std::lock_guard lock(mutex_);
    if (stopping_) return fail(ErrorCode::Unavailable, "the server stops");
    if (waiting_.size() >= kWaiting) {
      return fail(ErrorCode::Unavailable,
                  fmt::format("expected at most {} films to be waited for, found as many; ask again later", kWaiting));
    }
    waiting_.push_back({std::move(film), std::move(wanted), std::move(done)});
  }
  begin_next();
  return {};
}

void FilmQueue::begin_next() {
  drop_unwanted();
  Order next;
  {
    const std::lock_guard lock(mutex_);
    if (under_way_ || waiting_.empty() || places_taken_ == kPlaces) return;
    next = std::move(waiting_.front());
    waiting_.pop_front();
    under_way_ = true;
    ++places_taken_;
  }
  begin(std::move(next));
}

void FilmQueue::begin(Order order) {
  const ClipFilm& film = order.film;
  const auto source = std::make_shared<ClipSource>(film.view, film.from_s, film.fps, film.pictures, film.now_us);
  {
    const std::lock_guard lock(mutex_);
    source_ = source;
    if (stopping_) source->cancel();
  }
  auto file = std::make_shared<MemoryFile>(limits_.film_bytes);
  auto sink =
      std::make_unique<MemoryFilm>(render::Mp4Options{film.size, film.fps, film.pictures}, file, std::move(order.wanted));
  const auto maker = std::make_shared<FilmMaker>(
      FilmMaker::Parts{source, std::move(sink), film.size, film.camera}, workers_, renderer_,
      [self = shared_from_this(), file, place = std::make_shared<const Place>(shared_from_this()),
       wanted_pictures = film.pictures, done = std::move(order.done)](const Result<Film>& made) mutable {
        if (!made) {
          done(advised(made.error()));
        } else if (made->pictures < wanted_pictures) {
          done(fail(ErrorCode::Unavailable, "the server stops"));
        } else {
          done(MadeFilm{std::move(file->bytes), std::move(place)});
        }
        // In this order: a place is free once its memory is.
        file.reset();
        place.reset();
        self->ended();
      });
  file.reset();
  maker->go_on();
}

void FilmQueue::drop_unwanted() {
  std::vector<Order> gone;
  {
    const std::lock_guard lock(mutex_);
    const auto first =
        std::stable_partition(waiting_.begin(), waiting_.end(), [](const Order& o) { return !o.wanted.expired(); });
    gone.assign(std::make_move_iterator(first), std::make_move_iterator(waiting_.end()));
    waiting_.erase(first, waiting_.end());
  }
  for (const Order& order : gone) order.done(unwanted());
}

void FilmQueue::ended() {
  {
    const std::lock_guard lock(mutex_);
    source_.reset();
    under_way_ = false;
    idle_.notify_all();
  }
  begin_next();
}

void FilmQueue::stop() {
  std::deque<Order> given_up;
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
    given_up.swap(waiting_);
    if (source_) source_->cancel();
  }
  for (const Order& order : given_up) order.done(fail(ErrorCode::Unavailable, "the server stops"));
  std::unique_lock lock(mutex_);
  idle_.wait(lock, [this] { return !under_way_; });
}

}  // namespace tweend::streams
