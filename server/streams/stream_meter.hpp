#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace tweend::streams {

/// What has become of the packets of one kind of stream: of all producers with these labels. Any thread may count; a packet
/// knows its meter.
struct StreamMeter {
  using Value = std::atomic<std::int64_t>;
  std::string labels;  ///< what tells the streams apart, as Prometheus labels without braces
  Value readers{0};
  Value produced{0};
  Value sent{0};     ///< packets handed to sockets
  Value skipped{0};  ///< packets that a slow reader never saw
  Value queued{0};   ///< packets that wait for their readers now
};

/// The meters of all producers there are; once there is none of them, its streams count from 0 again. Safe from any thread.
class StreamMeters {
 public:
  /// The meter with these labels; a new one where there is none.
  [[nodiscard]] std::shared_ptr<StreamMeter> meter(std::string labels);

  struct Reading {
    std::string name;  ///< with labels, as in the text
    std::int64_t value;
  };
  [[nodiscard]] std::vector<Reading> read() const;
  /// Prometheus text, to be appended to that of Metrics.
  [[nodiscard]] std::string prometheus_text() const;

 private:
  mutable std::mutex mutex_;
  mutable std::vector<std::weak_ptr<StreamMeter>> meters_;
};

}  // namespace tweend::streams
