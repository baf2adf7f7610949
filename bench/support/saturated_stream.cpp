#include "bench/support/saturated_stream.hpp"

#include <boost/asio/post.hpp>
#include <utility>

#include "bench/support/server_process.hpp"

namespace tweend::bench {
namespace {

constexpr std::size_t kBefore = 2;  // until the first step of one picture runs beside the last of another
constexpr std::size_t kAfter = 1;

/// Several samples a pixel would not be what the bare loop draws.
render::RenderOptions one_sample() {
  render::RenderOptions options;
  options.samples = 1;
  return options;
}

}  // namespace

PictureThreads::PictureThreads() : renderer(one_sample()) {
  if (!renderer.device()) give_up(renderer.device().error().message);
}

PictureThreads::~PictureThreads() {
  renderer.stop();
  workers.stop();
  work_.reset();
  thread_.join();
}

SaturatedStream::SaturatedStream(PictureThreads& threads, const stage::SceneViewPtr& view, streams::FramesSpec spec)
    : threads_(threads),
      content_(std::make_shared<streams::FrameContent>(std::move(spec), 60.0, threads.strand, threads.workers, threads.desk,
                                                       static_cast<streams::ContentOwner&>(*this))) {
  if (!content_->follow(view)) give_up(content_->what_is_gone());
}

ClockUs SaturatedStream::reading_us(std::size_t index) noexcept { return 15'625 * static_cast<ClockUs>(index); }

double SaturatedStream::run(std::size_t pictures) {
  make(next_, kBefore + pictures + kAfter);
  return seconds_between(made_us_[kBefore - 1], made_us_[kBefore + pictures - 1]) / static_cast<double>(pictures);
}

std::span<const std::byte> SaturatedStream::make(std::size_t index) {
  make(index, 1);
  return latest_->payload.bytes();
}

void SaturatedStream::make(std::size_t first, std::size_t count) {
  next_ = first;
  end_ = first + count;
  count_ = count;
  made_us_.clear();
  boost::asio::post(threads_.strand, [this] { ready(); });
  done_.acquire();
}

void SaturatedStream::ready() {
  if (next_ == end_) return;
  const ClockUs at_us = reading_us(next_++);
  static_cast<void>(content_->read(at_us));
  content_->begin(pool_->take(), at_us);
}

void SaturatedStream::made(Result<streams::NewPacketPtr> packet) {
  if (!packet) give_up(packet.error().message);
  latest_ = std::move(*packet);
  made_us_.push_back(steady_now_us());
  if (made_us_.size() == count_) done_.release();
}

}  // namespace tweend::bench
