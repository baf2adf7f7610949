#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <future>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "server/streams/hub.hpp"
#include "tests/support/running_stage.hpp"

namespace tweend::test {

/// The key of a stream of an actor's vertices.
inline streams::StreamKey vertices_of(std::string scene, std::string actor, double rate) {
  return {std::move(scene), rate, streams::VerticesSpec{std::move(actor)}};
}

/// A packet's payload as numbers.
inline std::vector<float> floats_of(const streams::Packet& packet) {
  const auto floats = packet.payload.floats();
  return {floats.begin(), floats.end()};
}

/// A connection that keeps all it is given.
class RecordingSink final : public streams::PacketSink {
 public:
  void offer(std::uint32_t stream, const streams::PacketPtr& packet) override {
    {
      const std::lock_guard lock(mutex_);
      packets_.push_back({stream, packet});
    }
    changed_.notify_all();
  }
  void flush() override {}
  void ended(std::uint32_t stream, const std::string& reason) override {
    {
      const std::lock_guard lock(mutex_);
      ends_.push_back({stream, reason});
    }
    changed_.notify_all();
  }

  /// The packets of a stream so far.
  [[nodiscard]] std::vector<streams::PacketPtr> packets(std::uint32_t stream) const {
    const std::lock_guard lock(mutex_);
    return of(stream);
  }
  /// The packets of a stream once there are so many; perhaps more.
  std::vector<streams::PacketPtr> wait_for(std::uint32_t stream, std::size_t count) {
    std::unique_lock lock(mutex_);
    const bool came = changed_.wait_for(lock, kPatience, [&] { return of(stream).size() >= count; });
    EXPECT_TRUE(came) << "expected " << count << " packets of stream " << stream << ", found " << of(stream).size();
    auto packets = of(stream);
    while (packets.size() < count) packets.push_back(std::make_shared<streams::PacketPool>()->take());  // has failed already
    return packets;
  }
  /// Waits for a packet of a stream that fits; the packets so far, that one last.
  template <class Fits>
  std::vector<streams::PacketPtr> wait_until(std::uint32_t stream, Fits fits) {
    std::unique_lock lock(mutex_);
    std::vector<streams::PacketPtr> packets;
    const bool came = changed_.wait_for(lock, kPatience, [&] {
      packets = of(stream);
      const auto at = std::find_if(packets.begin(), packets.end(), [&](const streams::PacketPtr& p) { return fits(*p); });
      if (at == packets.end()) return false;
      packets.erase(at + 1, packets.end());
      return true;
    });
    EXPECT_TRUE(came) << "the packet never came";
    return packets;
  }
  /// Why a stream ended; waits for it.
  std::string wait_for_end(std::uint32_t stream) {
    std::unique_lock lock(mutex_);
    std::string reason;
    const bool came = changed_.wait_for(lock, kPatience, [&] {
      const auto at = std::find_if(ends_.begin(), ends_.end(), [stream](const auto& e) { return e.first == stream; });
      if (at == ends_.end()) return false;
      reason = at->second;
      return true;
    });
    EXPECT_TRUE(came) << "stream " << stream << " never ended";
    return reason;
  }
  [[nodiscard]] std::size_t ends() const {
    const std::lock_guard lock(mutex_);
    return ends_.size();
  }

 private:
  [[nodiscard]] std::vector<streams::PacketPtr> of(std::uint32_t stream) const {
    std::vector<streams::PacketPtr> found;
    for (const auto& [to, packet] : packets_) {
      if (to == stream) found.push_back(packet);
    }
    return found;
  }

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<std::pair<std::uint32_t, streams::PacketPtr>> packets_;
  std::vector<std::pair<std::uint32_t, std::string>> ends_;
};

/// A stage with streams on it, as the server wires them; sinks are called on a thread of their own.
class Streaming {
 public:
  /// @param render  off where a test draws nothing: a context takes its time to open
  explicit Streaming(std::vector<model::ScenePtr> scenes, std::size_t worker_threads = 2,
                     render::RenderOptions render = {.off = true})
      : stage(std::move(scenes)),
        workers(worker_threads),
        renderer(render),
        delivery(1),
        hub(*stage, workers, renderer, deliver(), stage.metrics) {
    stage.start([this](const std::string& scene, const stage::SceneViewPtr& view) { hub.follow(scene, view); });
  }
  ~Streaming() {
    stage.store.release();
    stage->post([this] { hub.stop(); });
    stage.settle();
    renderer.stop();
    workers.stop();  // before the stage, on which evaluations under way still end
    stage.stop();
    delivery.stop();
  }
  Streaming(const Streaming&) = delete;
  Streaming& operator=(const Streaming&) = delete;

  [[nodiscard]] Post deliver() {
    return [this](Task task) { delivery.post(std::move(task)); };
  }
  void subscribe(const streams::StreamKey& key, std::uint32_t stream) { subscribe(key, sink, stream); }
  void subscribe(const streams::StreamKey& key, const std::shared_ptr<RecordingSink>& to, std::uint32_t stream) {
    stage->post([this, key, to, stream] { hub.subscribe(key, {to, stream}); });
  }
  void unsubscribe(const streams::StreamKey& key, std::uint32_t stream) {
    stage->post([this, key, stream] { hub.unsubscribe(key, sink.get(), stream); });
  }
  /// Returns when all that the strand has handed on by now has reached the sinks.
  void settle() {
    stage.settle();
    std::promise<void> passed;
    delivery.post([&passed] { passed.set_value(); });
    passed.get_future().wait();
  }
  /// Lets an actor that moves send so many packets: time in which others could have sent some that they should not.
  void let_pass(const streams::StreamKey& moving, std::size_t packets) {
    const auto other = std::make_shared<RecordingSink>();
    subscribe(moving, other, 1);
    static_cast<void>(other->wait_for(1, packets));
    stage->post([this, moving, other] { hub.unsubscribe(moving, other.get(), 1); });
    settle();
  }

  RunningStage stage;
  WorkerPool workers;
  render::RenderThread renderer;
  WorkerPool delivery;
  streams::Hub hub;
  std::shared_ptr<RecordingSink> sink = std::make_shared<RecordingSink>();
};

}  // namespace tweend::test
