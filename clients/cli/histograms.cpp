#include "clients/cli/histograms.hpp"

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <nlohmann/json.hpp>
#include <string_view>

namespace tweend::cli {
namespace {

constexpr std::string_view kBucket = "_bucket{le=\"";

/// @param sample  `NAME_bucket{le="0.005"}`
void add_bucket(std::vector<Histogram>& histograms, const std::string& sample, double up_to) {
  const std::size_t mark = sample.find(kBucket);
  const std::string name = sample.substr(0, mark);
  auto at = std::find_if(histograms.begin(), histograms.end(), [&](const Histogram& h) { return h.name == name; });
  if (at == histograms.end()) at = histograms.insert(at, {name, {}});
  at->up_to.emplace_back(std::strtod(sample.c_str() + mark + kBucket.size(), nullptr), up_to);
}

}  // namespace

std::vector<Histogram> take_histograms(Json& stats) {
  std::vector<Histogram> histograms;
  Json others = Json::object();
  for (const auto& [name, value] : stats.items()) {
    if (name.find(kBucket) != std::string::npos && value.is_number()) {
      add_bucket(histograms, name, value.get<double>());
    } else {
      others[name] = value;
    }
  }
  for (Histogram& histogram : histograms) {
    std::sort(histogram.up_to.begin(), histogram.up_to.end());  // JSON has no order of members; theirs may be the names'
    for (const char* of_all : {"_sum", "_count"}) others.erase(histogram.name + of_all);
  }
  stats = std::move(others);
  return histograms;
}

double quantile(const Histogram& histogram, double share) {
  if (histogram.count() <= 0.0) return std::numeric_limits<double>::quiet_NaN();
  const double rank = share * histogram.count();
  double low = 0.0;
  double before = 0.0;
  for (const auto& [bound, up_to] : histogram.up_to) {
    if (up_to >= rank && up_to > before) return low + (bound - low) * std::max(rank - before, 0.0) / (up_to - before);
    low = bound;
    before = up_to;
  }
  return low;
}

}  // namespace tweend::cli
