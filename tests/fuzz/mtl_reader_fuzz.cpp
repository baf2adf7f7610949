#include "server/assets/mtl_reader.hpp"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <set>
#include <string>
#include <string_view>

#include "server/assets/asset_name.hpp"

namespace {

void require(bool holds) {
  if (!holds) std::abort();
}

}  // namespace

/// An MTL text: it is read or refused, and what its materials name lies in the folder or nowhere.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto materials = tweend::assets::read_mtl({reinterpret_cast<const char*>(data), size}, "fuzz.mtl");
  if (!materials) {
    require(materials.error().message.starts_with("fuzz.mtl:"));
    return 0;
  }
  std::set<std::string_view> names;
  for (const auto& material : *materials) {
    require(!material.name.empty() && names.insert(material.name).second);
    require(material.diffuse_map.find('\\') == std::string::npos);
    if (material.diffuse) {
      for (int i = 0; i < 3; ++i) require(std::isfinite((*material.diffuse)[i]));
    }
    const auto file = tweend::assets::resolve_name("folder", material.diffuse_map);
    require(!file || tweend::assets::is_clean_name(*file));
  }
  return 0;
}
