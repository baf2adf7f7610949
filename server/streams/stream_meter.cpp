#include "server/streams/stream_meter.hpp"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

namespace tweend::streams {
namespace {

struct Row {
  std::string_view name;
  std::string_view type;
  std::string_view help;
  StreamMeter::Value StreamMeter::*value;
};
constexpr std::array<Row, 5> kRows{{
    {"tweend_stream_readers", "gauge", "Subscriptions that share the stream", &StreamMeter::readers},
    {"tweend_stream_produced_total", "counter", "Packets of the stream evaluated and encoded", &StreamMeter::produced},
    {"tweend_stream_sent_total", "counter", "Packets of the stream handed to sockets, of all readers", &StreamMeter::sent},
    {"tweend_stream_skipped_total", "counter", "Packets of the stream that a slow reader never saw, of all readers",
     &StreamMeter::skipped},
    {"tweend_stream_queued", "gauge", "Packets of the stream that wait for their readers, of all readers",
     &StreamMeter::queued},
}};

}  // namespace

std::shared_ptr<StreamMeter> StreamMeters::meter(std::string labels) {
  const std::lock_guard lock(mutex_);
  std::erase_if(meters_, [](const auto& m) { return m.expired(); });
  for (const auto& weak : meters_) {
    if (auto held = weak.lock(); held && held->labels == labels) return held;
  }
  auto meter = std::make_shared<StreamMeter>();
  meter->labels = std::move(labels);
  meters_.push_back(meter);
  return meter;
}

std::vector<StreamMeters::Reading> StreamMeters::read() const {
  std::vector<Reading> readings;
  const std::lock_guard lock(mutex_);
  for (const Row& row : kRows) {
    for (const auto& weak : meters_) {
      if (const auto meter = weak.lock()) {
        readings.push_back(
            {std::string(row.name) + "{" + meter->labels + "}", ((*meter).*row.value).load(std::memory_order_relaxed)});
      }
    }
  }
  return readings;
}

std::string StreamMeters::prometheus_text() const {
  std::string text;
  const std::lock_guard lock(mutex_);
  for (const Row& row : kRows) {
    text += "# HELP " + std::string(row.name) + " " + std::string(row.help) + "\n# TYPE " + std::string(row.name) + " " +
            std::string(row.type) + "\n";
    for (const auto& weak : meters_) {
      const auto meter = weak.lock();
      if (!meter) continue;
      text += std::string(row.name) + "{" + meter->labels + "} " +
              std::to_string(((*meter).*row.value).load(std::memory_order_relaxed)) + "\n";
    }
  }
  return text;
}

}  // namespace tweend::streams
