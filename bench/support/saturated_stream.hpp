#pragma once

#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <cstddef>
#include <memory>
#include <semaphore>
#include <span>
#include <thread>
#include <vector>

#include "render/render_thread.hpp"
#include "server/base/worker_pool.hpp"
#include "server/streams/frame_content.hpp"

namespace tweend::bench {

/// The threads that pictures are made on, as the server has them.
class PictureThreads {
 public:
  PictureThreads();
  ~PictureThreads();
  PictureThreads(const PictureThreads&) = delete;
  PictureThreads& operator=(const PictureThreads&) = delete;

  boost::asio::io_context strand{1};
  WorkerPool workers{2};
  render::RenderThread renderer;
  streams::PictureDesk desk{strand, workers, renderer};

 private:
  boost::asio::executor_work_guard<boost::asio::io_context::executor_type> work_{strand.get_executor()};
  std::thread thread_{[this] { strand.run(); }};
};

/// A stream without a pace: a picture is begun as soon as the one before is on its last leg.
class SaturatedStream final : public streams::ContentOwner {
 public:
  SaturatedStream(PictureThreads& threads, const stage::SceneViewPtr& view, streams::FramesSpec spec);

  /// What the clock reads when picture `index` is taken: 64ths of a second, so that blends are exact in any arithmetic and
  /// no edge falls on another pixel because of it.
  [[nodiscard]] static ClockUs reading_us(std::size_t index) noexcept;
  /// Makes `pictures`, and a few before and after them so that the steps overlap as they do in a stream that runs.
  /// @return seconds that one took
  double run(std::size_t pictures);
  /// Makes picture `index` alone; its payload is good until the next call.
  [[nodiscard]] std::span<const std::byte> make(std::size_t index);

  // On the strand.
  void ready() override;
  void made(Result<streams::NewPacketPtr> packet) override;

 private:
  void make(std::size_t first, std::size_t count);

  PictureThreads& threads_;
  std::shared_ptr<streams::PacketPool> pool_ = std::make_shared<streams::PacketPool>();
  std::shared_ptr<streams::FrameContent> content_;
  std::size_t next_ = 0, end_ = 0, count_ = 0;
  std::vector<ClockUs> made_us_;
  streams::PacketPtr latest_;
  std::binary_semaphore done_{0};
};

}  // namespace tweend::bench
