// One viewer and eight: pictures of 640 x 360 pixels, sixty a second, over loopback. Eight who look the same way share one
// producer, so that a picture should cost the server what it costs with one of them, but for the bytes it sends. Eight who look
// from eight sides are eight times the work: how many pictures a second that leaves is told, and promised to nobody.

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "bench/support/picture_viewer.hpp"
#include "bench/support/ratio.hpp"
#include "bench/support/server_process.hpp"
#include "bench/support/server_requests.hpp"

namespace {

using namespace tweend::bench;

constexpr std::size_t kMany = 8;
constexpr int kRounds = 7;
constexpr double kRoundSeconds = 1.2;
constexpr double kSettleSeconds = 0.2;

/// @param side  from 0: where the eye stands around the sphere
void add_viewer(Viewers& viewers, const ServerProcess& server, std::size_t side) {
  viewers.push_back(std::make_unique<PictureViewer>(
      server.port(),
      fmt::format(
          R"({{"kind":"frames","rate":60,"width":640,"height":360,"camera":{{"orbit":{{"azimuth":{},"elevation":0.2}}}}}})",
          0.7 * static_cast<double>(side))));
}

/// What a while of watching came to.
struct Seen {
  double cpu_ms_per_picture = 0.0;  ///< of the server, for each picture that it made
  double made_per_s = 0.0;
  double delivered_per_s = 0.0;  ///< to each viewer, on average
};

Seen watch_for_a_while(const ServerProcess& server, LineClient& client, const Viewers& viewers, double seconds) {
  watch(viewers, kSettleSeconds);
  const auto delivered = [&] {
    std::size_t pictures = 0;
    for (const auto& viewer : viewers) pictures += viewer->pictures();
    return static_cast<double>(pictures);
  };
  const double made_before = stat(client, "packets_produced_total");
  const double cpu_before_s = server.cpu_seconds(), delivered_before = delivered();
  const auto start = std::chrono::steady_clock::now();
  watch(viewers, seconds);
  const double cpu_s = server.cpu_seconds() - cpu_before_s, delivered_now = delivered() - delivered_before;
  const double took_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const double made = stat(client, "packets_produced_total") - made_before;
  if (made == 0.0 || delivered_now == 0.0) give_up("no pictures came");
  return {1e3 * cpu_s / made, made / took_s, delivered_now / took_s / static_cast<double>(viewers.size())};
}

/// Eight viewers of one view are given the same bytes, made once.
void require_shared(LineClient& client, const Viewers& viewers) {
  for (const auto& viewer : viewers) viewer->keep_pictures();
  watch(viewers, 0.5);
  if (const auto producers = stat(client, "producers"); producers != 1) {
    give_up(fmt::format("expected one producer for eight viewers of one view, found {}", producers));
  }
  std::size_t shared = 0;
  for (const auto& [sequence, bytes] : viewers.front()->kept()) {
    std::size_t holders = 0;
    for (const auto& viewer : viewers) {
      const auto at = viewer->kept().find(sequence);
      if (at == viewer->kept().end()) continue;  // skipped it
      if (at->second != bytes) give_up(fmt::format("picture {} is not the same for all viewers", sequence));
      ++holders;
    }
    if (holders == viewers.size()) ++shared;
  }
  if (shared < 5) give_up(fmt::format("expected pictures that all eight viewers were given, found {}", shared));
}

Seen middle_of(const std::vector<Seen>& rounds) {
  const auto median_of = [&](double Seen::*what) {
    std::vector<double> values;
    for (const Seen& seen : rounds) values.push_back(seen.*what);
    return median(std::move(values));
  };
  return {median_of(&Seen::cpu_ms_per_picture), median_of(&Seen::made_per_s), median_of(&Seen::delivered_per_s)};
}

void print(const char* name, const Seen& seen) {
  std::printf("%-28s %14.2f %8.1f %14.1f\n", name, seen.cpu_ms_per_picture, seen.made_per_s, seen.delivered_per_s);
}

}  // namespace

int main() {
  const ServerProcess server;
  LineClient client(server.port());
  add_sphere(client, {}, 0.2F);
  must(client, "playback.play", R"({"loop":"repeat"})");
  Viewers viewers;
  const auto crowd = [&](bool many, bool same) {
    viewers.resize(1);  // the first one stays, so that the producer does
    while (many && viewers.size() < kMany) add_viewer(viewers, server, same ? 0 : viewers.size());
  };
  add_viewer(viewers, server, 0);
  crowd(true, true);
  require_shared(client, viewers);
  add_viewer(viewers, server, 0);
  viewers.erase(viewers.begin(), viewers.end() - 1);  // one that keeps nothing

  std::vector<Seen> one, many;
  std::vector<double> ratios;
  for (int round = 0; round < kRounds; ++round) {
    crowd(false, true);
    one.push_back(watch_for_a_while(server, client, viewers, kRoundSeconds));
    crowd(true, true);
    many.push_back(watch_for_a_while(server, client, viewers, kRoundSeconds));
    ratios.push_back(many.back().cpu_ms_per_picture / one.back().cpu_ms_per_picture);
  }
  crowd(false, true);
  crowd(true, false);
  const Seen sides = watch_for_a_while(server, client, viewers, 2.0);
  std::printf("pictures of 640 x 360 at 60/s  CPU ms/picture   made/s   to each viewer/s\n");
  print("1 viewer", middle_of(one));
  print("8 viewers of one view", middle_of(many));
  print("8 viewers from 8 sides", sides);
  return report({{"frame_viewers/eight_of_one_view", median(ratios), 1.1}}) ? 0 : 1;
}
