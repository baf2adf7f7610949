#include "server/assets/export_names.hpp"

#include <fmt/format.h>

namespace tweend::assets {

std::string ExportNames::unique(const std::string& wanted) {
  if (taken_.insert(wanted).second) return wanted;
  std::size_t& number = next_.try_emplace(wanted, 2).first->second;
  for (;;) {
    std::string name = fmt::format("{}_{}", wanted, number++);
    if (taken_.insert(name).second) return name;
  }
}

}  // namespace tweend::assets
