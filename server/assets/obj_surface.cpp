#include "server/assets/obj_surface.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace tweend::assets {
namespace {

/// Numbers the materials that faces show in order of first use.
class UsedMaterials {
 public:
  explicit UsedMaterials(std::span<const std::optional<model::Material>> known) : known_(known), number_of_(known.size() + 1) {}

  /// @param material  of an ObjFace
  std::uint32_t number(std::int32_t material) {
    const std::size_t slot = is_known(material) ? static_cast<std::size_t>(material) : known_.size();
    if (!number_of_[slot]) {
      number_of_[slot] = static_cast<std::uint32_t>(used_.size());
      used_.push_back(slot < known_.size() ? *known_[slot] : model::Material{});
    }
    return *number_of_[slot];
  }

  [[nodiscard]] bool is_known(std::int32_t material) const {
    const auto index = static_cast<std::size_t>(material);
    return material != kNoMaterial && index < known_.size() && known_[index].has_value();
  }

  [[nodiscard]] std::vector<model::Material> take() { return std::move(used_); }

 private:
  std::span<const std::optional<model::Material>> known_;
  std::vector<std::optional<std::uint32_t>> number_of_;  ///< the last: of the default material
  std::vector<model::Material> used_;
};

}  // namespace

bool has_texcoords(const ObjFile& file) {
  return std::any_of(file.corners.begin(), file.corners.end(), [](const ObjCorner& corner) { return corner.vt >= 0; });
}

model::Surface make_surface(const ObjFile& file, std::span<const std::optional<model::Material>> materials) {
  UsedMaterials used(materials);
  const auto is_known = [&](const ObjFace& face) { return used.is_known(face.material); };
  if (std::none_of(file.faces.begin(), file.faces.end(), is_known)) return {};
  model::Surface surface;
  std::uint32_t first_index = 0;
  for (const ObjFace& face : file.faces) {
    const std::uint32_t index_count = 3 * (face.corner_count - 2);
    const std::uint32_t material = used.number(face.material);
    if (surface.parts.empty() || surface.parts.back().material != material) {
      surface.parts.push_back({first_index, 0, material});
    }
    surface.parts.back().index_count += index_count;
    first_index += index_count;
  }
  surface.materials = used.take();
  return surface;
}

}  // namespace tweend::assets
