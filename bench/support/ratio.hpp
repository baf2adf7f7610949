#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

namespace tweend::bench {

/// Keeps the compiler from dropping or hoisting the work that wrote to `memory`.
inline void keep(const void* memory) { asm volatile("" : : "r"(memory) : "memory"); }

[[nodiscard]] inline double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// What `measure` found for each contender: one time per round, all of a round taken one right after the other.
struct Race {
  std::vector<std::vector<double>> ns_per_item;  ///< [contender][round]

  [[nodiscard]] double ns(std::size_t contender) const { return median(ns_per_item[contender]); }

  /// The median over rounds of a / b. The machine's speed drifts by tens of percent within seconds; within a round it
  /// hardly does, so this holds where a quotient of two medians would not.
  [[nodiscard]] double ratio(std::size_t a, std::size_t b) const {
    std::vector<double> ratios;
    for (std::size_t round = 0; round < ns_per_item[a].size(); ++round) {
      ratios.push_back(ns_per_item[a][round] / ns_per_item[b][round]);
    }
    return median(std::move(ratios));
  }
};

struct RaceOptions {
  double items = 1.0;  ///< per call, e.g. vertices
  std::size_t rounds = 61;
  double batch_ns = 500'000;  ///< a batch repeats a call until about this long: far above the clock's grain
};

/// Times the contenders (callables without arguments) in alternating short batches. Each batch begins with a call that is
/// not timed, so that every contender finds its own data in the cache and not the previous one's.
template <class... Contenders>
[[nodiscard]] Race measure(const RaceOptions& options, Contenders... contenders) {
  using Clock = std::chrono::steady_clock;
  const auto time_ns = [](auto& run, std::size_t calls) {
    run();
    const auto start = Clock::now();
    for (std::size_t i = 0; i < calls; ++i) run();
    return std::chrono::duration<double, std::nano>(Clock::now() - start).count() / static_cast<double>(calls);
  };
  const auto calls_for = [&](auto& run) {
    const double ns = std::min(time_ns(run, 1), time_ns(run, 1));
    return static_cast<std::size_t>(std::max(1.0, options.batch_ns / std::max(ns, 1.0)));
  };
  const std::size_t calls[] = {calls_for(contenders)...};
  Race race;
  race.ns_per_item.resize(sizeof...(contenders));
  for (std::size_t round = 0; round < options.rounds; ++round) {
    std::size_t c = 0;
    ((race.ns_per_item[c].push_back(time_ns(contenders, calls[c]) / options.items), ++c), ...);
  }
  return race;
}

/// A ratio that is promised; README and the tests quote these lines.
struct Claim {
  std::string name;
  double value;
  double target;         ///< value <= target
  bool at_least{false};  ///< value >= target instead
};

/// Prints `ratio NAME VALUE <= TARGET` (or >=) for each, and tells whether all hold.
[[nodiscard]] inline bool report(const std::vector<Claim>& claims) {
  bool all_hold = true;
  for (const Claim& claim : claims) {
    const char* bound = claim.at_least ? ">=" : "<=";
    std::printf("ratio %s %.2f %s %g\n", claim.name.c_str(), claim.value, bound, claim.target);
    if (!(claim.at_least ? claim.value >= claim.target : claim.value <= claim.target)) {
      std::fprintf(stderr, "%s misses its target: %.2f is not %s %g\n", claim.name.c_str(), claim.value, bound, claim.target);
      all_hold = false;
    }
  }
  return all_hold;
}

}  // namespace tweend::bench
