#include "server/assets/obj_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>
#include <limits>
#include <optional>
#include <span>
#include <unordered_map>
#include <utility>

#include "server/assets/obj_scanner.hpp"
#include "server/assets/token.hpp"

namespace tweend::assets {
namespace {

// Each is looked for on the disk.
constexpr std::size_t kMaxLibraries = 256;

// Known, and of no concern to a polygon mesh: grouping, display, lines and points, free-form geometry.
constexpr std::string_view kSkipped[] = {
    "o",         "g",    "s",    "mg",   "usemap", "maplib", "lod",  "bevel", "c_interp", "d_interp", "shadow_obj",
    "trace_obj", "l",    "p",    "vp",   "cstype", "deg",    "bmat", "step",  "curv",     "curv2",    "surf",
    "parm",      "trim", "hole", "scrv", "sp",     "end",    "con",  "ctech", "stech",
};

/// What an index points to.
struct IndexKind {
  std::string_view plural;
  std::size_t count;  ///< of them in the file, so far
};

class Reader {
 public:
  Reader(std::string_view text, std::string name, const Limits& limits)
      : scanner_(text), max_vertices_(limits.vertices_per_actor) {
    file_.name = std::move(name);
  }

  Result<ObjFile> read() {
    while (scanner_.next_statement()) TWEEND_TRY(read_statement());
    if (vertices().count == 0) return fail_file("at least one vertex (v x y z)", "none");
    if (file_.faces.empty()) return fail_file("at least one face (f a b c)", "none");
    for (const ObjFace& face : file_.faces) TWEEND_TRY(check_face(face));
    return std::move(file_);
  }

 private:
  [[nodiscard]] IndexKind vertices() const { return {"vertices", file_.positions.size() / 3}; }
  [[nodiscard]] IndexKind texcoords() const { return {"texture coordinates", file_.texcoords.size() / 2}; }
  [[nodiscard]] IndexKind normals() const { return {"normals", file_.normals.size() / 3}; }

  [[nodiscard]] Error fail_at(std::uint32_t line, std::string_view expected, std::string_view found) const {
    return fail(ErrorCode::BadAsset, fmt::format("{}:{}: expected {}, found {}", file_.name, line, expected, found));
  }
  [[nodiscard]] Error fail_here(std::string_view expected, std::string_view found) const {
    return fail_at(scanner_.line(), expected, found);
  }
  [[nodiscard]] Error fail_file(std::string_view expected, std::string_view found) const {
    return fail(ErrorCode::BadAsset, fmt::format("{}: expected {}, found {}", file_.name, expected, found));
  }

  Status read_statement() {
    const std::string_view keyword = scanner_.next_token();
    if (keyword == "v") return read_vertex();
    if (keyword == "vt") return read_texcoord();
    if (keyword == "vn") return read_normal();
    if (keyword == "f") return read_face();
    if (keyword == "usemtl") return read_usemtl();
    if (keyword == "mtllib") return read_mtllib();
    if (std::find(std::begin(kSkipped), std::end(kSkipped), keyword) != std::end(kSkipped)) return {};
    return fail_here("an OBJ statement (v, vt, vn, f, o, g, s, usemtl ...)", quoted_token(keyword));
  }

  /// Reads the statement's numbers: at least `least`, at most as many as `out` holds. @return how many there were
  Result<std::size_t> read_numbers(std::size_t least, std::span<float> out) {
    const auto expected = [&] {
      return least == out.size() ? fmt::format("{} numbers", least) : fmt::format("{} to {} numbers", least, out.size());
    };
    std::size_t count = 0;
    for (std::string_view token = scanner_.next_token(); !token.empty(); token = scanner_.next_token()) {
      const std::optional<float> number = parse_number(token);
      if (!number) return fail_here("a finite number", quoted_token(token));
      if (count == out.size()) return fail_here(expected(), "more");
      out[count++] = *number;
    }
    if (count < least) return fail_here(expected(), fmt::to_string(count));
    return count;
  }

  Status read_vertex() {
    // After x y z some write a weight, a colour, or both; a polygon mesh has no use for them here.
    std::array<float, 7> numbers{};
    TWEEND_TRY(read_numbers(3, numbers));
    if (vertices().count == max_vertices_) {
      return fail(ErrorCode::Limit,
                  fmt::format("{}:{}: expected at most {} vertices, found more", file_.name, scanner_.line(), max_vertices_));
    }
    file_.positions.insert(file_.positions.end(), numbers.begin(), numbers.begin() + 3);
    return {};
  }

  Status read_texcoord() {
    std::array<float, 3> numbers{};  // u [v [w]]
    TWEEND_TRY(read_numbers(1, numbers));
    file_.texcoords.insert(file_.texcoords.end(), numbers.begin(), numbers.begin() + 2);
    return {};
  }

  Status read_normal() {
    std::array<float, 3> numbers{};
    TWEEND_TRY(read_numbers(3, numbers));
    file_.normals.insert(file_.normals.end(), numbers.begin(), numbers.end());
    return {};
  }

  Status read_face() {
    ObjFace face{static_cast<std::uint32_t>(file_.corners.size()), 0, scanner_.line(), material_};
    for (std::string_view token = scanner_.next_token(); !token.empty(); token = scanner_.next_token()) {
      TWEEND_ASSIGN(const ObjCorner corner, read_corner(token));
      const ObjCorner& first = face.corner_count == 0 ? corner : file_.corners[face.first_corner];
      if ((corner.vt < 0) != (first.vt < 0) || (corner.vn < 0) != (first.vn < 0)) {
        return fail_here("all corners of the face to have the same parts of v/vt/vn", quoted_token(token));
      }
      file_.corners.push_back(corner);
      ++face.corner_count;
    }
    if (face.corner_count < 3) return fail_here("a face of at least 3 corners", fmt::to_string(face.corner_count));
    file_.faces.push_back(face);
    return {};
  }

  Status read_usemtl() {
    std::string name = scanner_.rest_of_statement();
    if (name.empty()) {
      material_ = kNoMaterial;
      return {};
    }
    const auto next = static_cast<std::int32_t>(file_.material_names.size());
    const auto [known, is_new] = index_of_material_.try_emplace(name, next);
    if (is_new) file_.material_names.push_back(std::move(name));
    material_ = known->second;
    return {};
  }

  Status read_mtllib() {
    std::vector<std::string>& libraries = file_.material_libraries;
    std::string library = scanner_.rest_of_statement();
    if (library.empty() || std::find(libraries.begin(), libraries.end(), library) != libraries.end()) return {};
    if (libraries.size() == kMaxLibraries) {
      return fail(ErrorCode::Limit, fmt::format("{}:{}: expected at most {} material libraries, found more", file_.name,
                                                scanner_.line(), kMaxLibraries));
    }
    libraries.push_back(std::move(library));
    return {};
  }

  /// Reads v, v/vt, v//vn or v/vt/vn.
  Result<ObjCorner> read_corner(std::string_view token) {
    std::array<std::string_view, 3> parts;
    std::size_t count = 0;
    for (std::string_view rest = token;; ++count) {
      const std::size_t slash = rest.find('/');
      if (count < parts.size()) parts[count] = rest.substr(0, slash);
      if (slash == std::string_view::npos) break;
      rest.remove_prefix(slash + 1);
    }
    // `count` is that of the slashes: the part after the last one may not be empty.
    if (count >= parts.size() || parts[0].empty() || parts[count].empty()) {
      return fail_here("a corner v, v/vt, v//vn or v/vt/vn", quoted_token(token));
    }
    TWEEND_ASSIGN(const std::int32_t v, read_index(parts[0], vertices()));
    TWEEND_ASSIGN(const std::int32_t vt, read_index(parts[1], texcoords()));
    TWEEND_ASSIGN(const std::int32_t vn, read_index(parts[2], normals()));
    return ObjCorner{v, vt, vn};
  }

  /// @return from 0, or -1 where `text` is empty. What points forwards is checked once the file has been read.
  [[nodiscard]] Result<std::int32_t> read_index(std::string_view text, const IndexKind& kind) const {
    if (text.empty()) return -1;
    const std::optional<std::int64_t> number = parse_integer(text);
    if (!number || *number == 0) return fail_here("an index from 1, or from -1 down", quoted_token(text));
    const std::int64_t index = *number > 0 ? *number - 1 : static_cast<std::int64_t>(kind.count) + *number;
    if (index < 0) return fail_here(fmt::format("one of the {} {} so far", kind.count, kind.plural), quoted_token(text));
    if (index > std::numeric_limits<std::int32_t>::max()) return fail_here(one_of_all(kind), quoted_token(text));
    return static_cast<std::int32_t>(index);
  }

  [[nodiscard]] static std::string one_of_all(const IndexKind& kind) {
    return fmt::format("the index of one of the file's {} {}", kind.count, kind.plural);
  }

  [[nodiscard]] Status check_face(const ObjFace& face) const {
    for (const ObjCorner& corner : std::span(file_.corners).subspan(face.first_corner, face.corner_count)) {
      TWEEND_TRY(check_index(face, corner.v, vertices()));
      TWEEND_TRY(check_index(face, corner.vt, texcoords()));
      TWEEND_TRY(check_index(face, corner.vn, normals()));
    }
    return {};
  }

  [[nodiscard]] Status check_index(const ObjFace& face, std::int32_t index, const IndexKind& kind) const {
    if (index < static_cast<std::int64_t>(kind.count)) return {};
    return fail_at(face.line, one_of_all(kind), fmt::to_string(std::int64_t{index} + 1));
  }

  ObjScanner scanner_;
  std::size_t max_vertices_;
  std::unordered_map<std::string, std::int32_t> index_of_material_;  ///< by name
  std::int32_t material_ = kNoMaterial;                              ///< of the faces that follow
  ObjFile file_;
};

}  // namespace

Result<ObjFile> read_obj(std::string_view text, std::string name, const Limits& limits) {
  TWEEND_TRY(check_text(text, name));
  return Reader(text, std::move(name), limits).read();
}

}  // namespace tweend::assets
