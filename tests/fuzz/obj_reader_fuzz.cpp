#include "server/assets/obj_reader.hpp"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "server/assets/obj_sequence.hpp"

namespace {

/// Parts an input into the files of a sequence; no OBJ text holds this line.
constexpr std::string_view kNextFile = "\n%%\n";

constexpr std::size_t kMaxVertices = 10'000;

void require(bool holds) {
  if (!holds) std::abort();
}

void check(const tweend::assets::ObjFile& file) {
  require(!file.faces.empty());
  std::size_t corners = 0;
  for (const auto& face : file.faces) {
    require(face.first_corner == corners && face.corner_count >= 3 && face.line > 0);
    corners += face.corner_count;
    require(face.material >= tweend::assets::kNoMaterial);
    require(face.material < static_cast<std::ptrdiff_t>(file.material_names.size()));
  }
  require(corners == file.corners.size());
  for (const auto& corner : file.corners) {
    require(corner.v >= 0 && static_cast<std::size_t>(corner.v) < file.positions.size() / 3);
    require(corner.vt >= -1 && corner.vt < static_cast<std::ptrdiff_t>(file.texcoords.size() / 2));
    require(corner.vn >= -1 && corner.vn < static_cast<std::ptrdiff_t>(file.normals.size() / 3));
  }
  for (const auto* numbers : {&file.positions, &file.texcoords, &file.normals}) {
    for (const float number : *numbers) require(std::isfinite(number));
  }
}

void check(const tweend::assets::ObjModel& model, const std::vector<tweend::assets::ObjFile>& files) {
  require(model.keys.size() == files.size());
  for (const auto& part : model.mesh->surface().parts) require(part.material < model.mesh->surface().materials.size());
  require(model.mesh->vertex_count() <= kMaxVertices && model.mesh->vertex_count() <= files.front().corners.size());
  for (const auto& key : model.keys) {
    require(key.vertices->vertex_count() == model.mesh->vertex_count());
    for (const float number : key.vertices->normals()) require(std::isfinite(number));
  }
}

}  // namespace

/// One or more OBJ texts: each is read or refused, and together they make a model or are refused.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  tweend::Limits limits;
  limits.vertices_per_actor = kMaxVertices;
  std::string_view rest(reinterpret_cast<const char*>(data), size);
  std::vector<tweend::assets::ObjFile> files;
  std::vector<std::int64_t> frames;
  for (;;) {
    const std::size_t end = rest.find(kNextFile);
    auto file = tweend::assets::read_obj(rest.substr(0, end), "fuzz.obj", limits);
    if (file) {
      check(*file);
      frames.push_back(static_cast<std::int64_t>(files.size()));
      files.push_back(std::move(*file));
    } else {
      require(!file.error().message.empty());
    }
    if (end == std::string_view::npos) break;
    rest.remove_prefix(end + kNextFile.size());
  }
  if (files.empty()) return 0;
  std::vector<std::optional<tweend::model::Material>> materials(files.front().material_names.size());
  for (std::size_t i = 0; i < materials.size(); i += 2) materials[i].emplace();  // every other one is known
  const auto model = tweend::assets::build_obj_model("fuzz", files, frames, limits, materials);
  if (model) check(*model, files);
  return 0;
}
