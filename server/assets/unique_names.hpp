#pragma once

#include <functional>
#include <string>
#include <vector>

namespace tweend::assets {

/// Names that are used once: a missing one becomes what `stand_in` says of its place; of several that are the same, the first
/// keeps its name and the others get "_2", "_3" … behind it, passing over names that are there already.
/// @param names  shape [n]; "": missing
[[nodiscard]] std::vector<std::string> make_unique(std::vector<std::string> names,
                                                   const std::function<std::string(std::size_t)>& stand_in);

}  // namespace tweend::assets
