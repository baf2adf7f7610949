#include "server/assets/obj_topology.hpp"

#include <fmt/format.h>

#include <cstddef>
#include <utility>

namespace tweend::assets {
namespace {

Error mismatch(std::string message) { return fail(ErrorCode::BadAsset, std::move(message)); }

Status check_face(const ObjFile& first, const ObjFile& file, std::size_t index) {
  const ObjFace& expected = first.faces[index];
  const ObjFace& found = file.faces[index];
  if (found.corner_count != expected.corner_count) {
    return mismatch(fmt::format("{}:{}: expected a face of {} corners as in {}:{}, found {}", file.name, found.line,
                                expected.corner_count, first.name, expected.line, found.corner_count));
  }
  for (std::uint32_t i = 0; i < found.corner_count; ++i) {
    const std::int32_t expected_v = first.corners[expected.first_corner + i].v;
    const std::int32_t found_v = file.corners[found.first_corner + i].v;
    if (found_v != expected_v) {
      return mismatch(fmt::format("{}:{}: expected vertex {} at corner {} of the face as in {}:{}, found vertex {}", file.name,
                                  found.line, expected_v + 1, i + 1, first.name, expected.line, found_v + 1));
    }
  }
  return {};
}

}  // namespace

Status check_same_topology(const ObjFile& first, const ObjFile& file) {
  if (file.positions.size() != first.positions.size()) {
    return mismatch(fmt::format("{}: expected {} vertices as in {}, found {}", file.name, first.positions.size() / 3,
                                first.name, file.positions.size() / 3));
  }
  if (file.faces.size() != first.faces.size()) {
    return mismatch(fmt::format("{}: expected {} faces as in {}, found {} (last face at line {})", file.name,
                                first.faces.size(), first.name, file.faces.size(),
                                file.faces.empty() ? 0 : file.faces.back().line));
  }
  for (std::size_t i = 0; i < file.faces.size(); ++i) TWEEND_TRY(check_face(first, file, i));
  return {};
}

}  // namespace tweend::assets
