// How soon one sees what one has asked for: from `playback.seek` sent to the last byte of the first packet that shows it, over
// loopback, while fifty others watch the same stream and are sent that packet first. Beside it, in turn, `server.ping` on the
// same connection: what asking costs at all, under the same load. While the player is paused, a packet is made as soon as
// something changes; while it plays, packets keep to their grid, and half its period is waited on average.
// The client and the fifty have one processor, the server has the other.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <memory>
#include <random>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "bench/support/picture_viewer.hpp"
#include "bench/support/ratio.hpp"
#include "bench/support/seeking_viewer.hpp"
#include "bench/support/server_process.hpp"
#include "bench/support/server_requests.hpp"
#include "bench/support/sphere_scene.hpp"

namespace {

using namespace tweend::bench;
using tweend::protocol::PacketHeader;

constexpr std::size_t kWatchers = 50;
constexpr double kDurationSeconds = 2.0;  // of the sphere's clip
constexpr float kLobes = 0.2F;
const SphereGrid kSphere;

struct Case {
  const char* name;
  std::string_view stream;  ///< parameters
  double rate;
  bool playing;
  std::size_t seeks;
};

constexpr std::string_view kVertices = R"({"kind":"vertices","rate":240})";
constexpr std::string_view kPictures = R"({"kind":"frames","width":640,"height":360,"rate":60})";
constexpr std::array<Case, 4> kCases{{{"vertices f32, paused", kVertices, 240, false, 240},
                                      {"vertices f32, playing", kVertices, 240, true, 120},
                                      {"jpeg 640 x 360, paused", kPictures, 60, false, 90},
                                      {"jpeg 640 x 360, playing", kPictures, 60, true, 70}}};

/// Others who watch, read for on a thread of their own.
class Audience {
 public:
  Audience(const ServerProcess& server, const std::string& stream) {
    while (viewers_.size() < kWatchers) viewers_.push_back(std::make_unique<PictureViewer>(server.port(), stream));
    thread_ = std::thread([this] {
      while (!leaving_) watch(viewers_, 0.1);
    });
  }
  ~Audience() {
    leaving_ = true;
    thread_.join();
  }
  Audience(const Audience&) = delete;
  Audience& operator=(const Audience&) = delete;

 private:
  Viewers viewers_;
  std::atomic<bool> leaving_{false};
  std::thread thread_;
};

struct Latencies {
  std::vector<double> ping_ms, seek_ms;

  [[nodiscard]] double ratio() const { return median(seek_ms) / median(ping_ms); }
};

double percentile(std::vector<double> values, double p) {
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(p * static_cast<double>(values.size() - 1))];
}

std::int64_t in_us(double seconds) { return std::llround(seconds * 1e6); }

/// Media time that lies up to half a second behind `from_us`, over the seam of the clip.
bool just_after(std::int64_t media_us, std::int64_t from_us) {
  const std::int64_t duration_us = in_us(kDurationSeconds);
  return ((media_us - from_us) % duration_us + duration_us) % duration_us < 500'000;
}

/// Where to seek: whole milliseconds, far from where it stands.
double elsewhere(std::mt19937& random, std::int64_t media_us) {
  std::uniform_int_distribution<std::int64_t> ahead_ms(700, 1300);
  return static_cast<double>((media_us / 1000 + ahead_ms(random)) % 2000) / 1e3;
}

/// The packets a seek is shown by hold the blend of the two keyframes at that time.
void require_right(SeekingViewer& viewer) {
  const std::vector<float> from = kSphere.positions(0.0F), to = kSphere.positions(kLobes);
  for (const double time_s : {0.25, 1.0, 1.625}) {
    static_cast<void>(viewer.seek_ms(time_s, [&](const PacketHeader& h) { return h.media_us == in_us(time_s); }));
    const auto u = static_cast<float>(time_s <= 1.0 ? time_s : 2.0 - time_s);
    std::vector<float> found(viewer.payload().size() / sizeof(float));
    std::memcpy(found.data(), viewer.payload().data(), viewer.payload().size());
    if (found.size() != 2 * from.size()) give_up(fmt::format("expected {} numbers, found {}", 2 * from.size(), found.size()));
    for (std::size_t i = 0; i < from.size(); ++i) {
      if (const float want = from[i] + u * (to[i] - from[i]); std::abs(found[i] - want) > 1e-4F) {
        give_up(fmt::format("at {} s: expected {} as coordinate {}, found {}", time_s, want, i, found[i]));
      }
    }
  }
}

Latencies measure_case(const Case& c, const ServerProcess& server, LineClient& client) {
  must(client, c.playing ? "playback.play" : "playback.pause", "{}");
  const std::string stream(c.stream);
  const Audience audience(server, stream);
  SeekingViewer viewer(server.port(), stream);  // the last to come is the last to be sent to
  if (stat(client, "producers") != 1 || stat(client, "streams") != kWatchers + 1) give_up("expected one producer for them all");
  if (!c.playing && c.stream == kVertices) require_right(viewer);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> pause(0.0, 0.008);
  Latencies latencies;
  for (std::size_t i = 0; i < c.seeks; ++i) {
    viewer.rest(1.0 / c.rate + pause(random));
    latencies.ping_ms.push_back(viewer.ping_ms());
    viewer.rest(1.0 / c.rate + pause(random));
    const double time_s = elsewhere(random, viewer.header().media_us);
    latencies.seek_ms.push_back(viewer.seek_ms(time_s, [&](const PacketHeader& header) {
      return c.playing ? just_after(header.media_us, in_us(time_s)) : header.media_us == in_us(time_s);
    }));
  }
  return latencies;
}

}  // namespace

int main() {
  pin_to_processor(1);
  const ServerProcess server;
  pin_to_processor(0);
  LineClient client(server.port());
  add_sphere(client, kSphere, kLobes);
  std::printf("from a seek sent to the packet that shows it, ms, while %zu watch\n%-26s %9s %9s %12s %9s\n", kWatchers, "",
              "median", "p99", "ping median", "p99");
  std::vector<double> ratios;
  for (const Case& c : kCases) {
    const Latencies found = measure_case(c, server, client);
    std::printf("%-26s %9.2f %9.2f %12.2f %9.2f\n", c.name, median(found.seek_ms), percentile(found.seek_ms, 0.99),
                median(found.ping_ms), percentile(found.ping_ms, 0.99));
    ratios.push_back(found.ratio());
  }
  return report({{"latency_seek_to_packet_vs_ping", ratios.front(), 7.0}}) ? 0 : 1;
}
