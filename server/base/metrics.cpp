#include "server/base/metrics.hpp"

#include <fmt/format.h>

#include <string_view>

namespace tweend {
namespace {

constexpr double kSecond_us = 1e6;

struct Family {
  std::string_view name;
  std::string_view type;
  std::string_view help;
  std::vector<Metrics::Reading> samples;
};

std::vector<Metrics::Reading> samples_of(const std::string& name, const Histogram& histogram) {
  const Histogram::Reading reading = histogram.read();
  std::vector<Metrics::Reading> samples;
  for (std::size_t i = 0; i < reading.up_to.size(); ++i) {
    samples.push_back({fmt::format("{}_bucket{{le=\"{}\"}}", name, static_cast<double>(Histogram::kBoundsUs[i]) / kSecond_us),
                       static_cast<double>(reading.up_to[i])});
  }
  samples.push_back({name + "_bucket{le=\"+Inf\"}", static_cast<double>(reading.count)});
  samples.push_back({name + "_sum", static_cast<double>(reading.sum_us) / kSecond_us});
  samples.push_back({name + "_count", static_cast<double>(reading.count)});
  return samples;
}

std::vector<Family> families_of(const Metrics& m) {
  return {
#define TWEEND_METRIC(name, type, help) \
  Family{"tweend_" #name, #type, help, {{"tweend_" #name, static_cast<double>(m.name.load(std::memory_order_relaxed))}}},
#define TWEEND_HISTOGRAM(name, help) Family{"tweend_" #name, "histogram", help, samples_of("tweend_" #name, m.name)},
#include "server/base/metrics.def"
#undef TWEEND_HISTOGRAM
#undef TWEEND_METRIC
  };
}

}  // namespace

std::vector<Metrics::Reading> Metrics::read() const {
  std::vector<Reading> readings;
  for (const Family& family : families_of(*this)) {
    readings.insert(readings.end(), family.samples.begin(), family.samples.end());
  }
  return readings;
}

std::string Metrics::prometheus_text() const {
  std::string text;
  for (const Family& family : families_of(*this)) {
    text += fmt::format("# HELP {0} {1}\n# TYPE {0} {2}\n", family.name, family.help, family.type);
    for (const Reading& r : family.samples) text += fmt::format("{} {}\n", r.name, r.value);
  }
  return text;
}

}  // namespace tweend
