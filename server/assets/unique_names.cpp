#include "server/assets/unique_names.hpp"

#include <unordered_map>
#include <unordered_set>

namespace tweend::assets {

std::vector<std::string> make_unique(std::vector<std::string> names, const std::function<std::string(std::size_t)>& stand_in) {
  std::unordered_set<std::string> taken;
  std::vector<bool> settled(names.size(), false);
  // What a file says stays as it is, whatever names are made up for others.
  for (std::size_t i = 0; i < names.size(); ++i) settled[i] = !names[i].empty() && taken.insert(names[i]).second;
  std::unordered_map<std::string, std::size_t> next;  // number to try for a name
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (settled[i]) continue;
    if (names[i].empty()) names[i] = stand_in(i);
    const std::string name = names[i];
    std::size_t& number = next.try_emplace(name, 2).first->second;
    while (!taken.insert(names[i]).second) names[i] = name + "_" + std::to_string(number++);
  }
  return names;
}

}  // namespace tweend::assets
