#pragma once

#include <string>
#include <utility>
#include <vector>

#include "clients/cli/json.hpp"

namespace tweend::cli {

/// A histogram of `server.stats`.
struct Histogram {
  std::string name;
  std::vector<std::pair<double, double>>
      up_to;  ///< upper bounds in ascending order, the last infinite, and how many are not above

  [[nodiscard]] double count() const { return up_to.empty() ? 0.0 : up_to.back().second; }
};

/// Takes the samples of histograms, as Prometheus names them, out of the members of `stats`.
[[nodiscard]] std::vector<Histogram> take_histograms(Json& stats);

/// What so large a share of the observations is not above, were those of each bucket spread evenly over it.
/// @param share  0 to 1
/// @return infinite where it is above the last finite bound, NaN where nothing was observed
[[nodiscard]] double quantile(const Histogram& histogram, double share);

}  // namespace tweend::cli
