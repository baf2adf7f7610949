#include "server/base/metrics.hpp"

namespace tweend {

std::vector<Metrics::Reading> Metrics::read() const {
  return {
#define TWEEND_METRIC(name, type, help) Reading{#name, #type, help, name.load(std::memory_order_relaxed)},
#include "server/base/metrics.def"
#undef TWEEND_METRIC
  };
}

std::string Metrics::prometheus_text() const {
  std::string text;
  for (const Reading& r : read()) {
    const std::string name = "tweend_" + std::string(r.name);
    text += "# HELP " + name + " " + std::string(r.help) + "\n# TYPE " + name + " " + std::string(r.type) + "\n" + name + " " +
            std::to_string(r.value) + "\n";
  }
  return text;
}

}  // namespace tweend
