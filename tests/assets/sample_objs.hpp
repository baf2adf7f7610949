#pragma once

#include <string>
#include <string_view>
#include <utility>

#include "server/assets/obj_reader.hpp"
#include "tests/assets/must.hpp"

namespace tweend::assets {

inline constexpr std::string_view kTriangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

/// The same triangle with its third vertex elsewhere.
inline std::string triangle_to(std::string_view third) { return "v 0 0 0\nv 1 0 0\nv " + std::string(third) + "\nf 1 2 3\n"; }

/// What a text that must be readable says.
inline ObjFile must_read(std::string_view text, std::string name = "test.obj") {
  return must(read_obj(text, std::move(name), Limits{}));
}

}  // namespace tweend::assets
