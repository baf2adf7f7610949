#include "server/assets/obj_writer.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <iterator>
#include <new>
#include <span>
#include <string>
#include <utility>

#include "server/assets/mtl_writer.hpp"
#include "server/model/evaluate.hpp"

namespace tweend::assets {
namespace {

struct Moment {
  double time_s = 0.0;
  std::int64_t frame = 0;
};

Result<std::vector<Moment>> moments_of(const model::Clip& clip) {
  if (clip.keyframes.empty()) return std::vector<Moment>{{}};
  std::vector<Moment> moments;
  for (const double time_s : clip.times_s) {
    const auto frame = static_cast<std::int64_t>(std::llround(time_s * kObjFramesPerSecond));
    if (!moments.empty() && moments.back().frame == frame) {
      return fail(
          ErrorCode::InvalidParams,
          fmt::format("expected keyframes at least a frame apart ({} a second), found those at {} s and {} s of the clip "
                      "\"{}\" both in frame {}: move one of them, or export glb, which keeps times",
                      kObjFramesPerSecond, moments.back().time_s, time_s, clip.name, frame),
          "params.actor");
    }
    moments.push_back({time_s, frame});
  }
  return moments;
}

void append_rows(std::string_view keyword, std::span<const float> values, std::size_t width, std::string& out) {
  auto to = std::back_inserter(out);
  for (std::size_t i = 0; i < values.size(); i += width) {
    out += keyword;
    for (std::size_t c = 0; c < width; ++c) fmt::format_to(to, " {}", values[i + c]);  // as many digits as it takes
    out += '\n';
  }
}

class ObjText {
 public:
  ObjText(const model::Mesh& mesh, std::string_view prefix, const MtlNames& materials)
      : mesh_(mesh), prefix_(prefix), materials_(materials), faces_(faces()) {}

  [[nodiscard]] std::string of(std::span<const float> positions, std::span<const float> normals) const {
    std::string text = materials_.empty() ? std::string() : fmt::format("mtllib {}.mtl\n", prefix_);
    append_rows("v", positions, 3, text);
    append_rows("vt", mesh_.texcoords(), 2, text);
    append_rows("vn", normals, 3, text);
    return text + faces_;
  }

 private:
  /// The same in each file.
  [[nodiscard]] std::string faces() const {
    std::string text;
    const auto& parts = mesh_.surface().parts;
    if (parts.empty()) append_faces(mesh_.indices(), text);
    for (const model::MeshPart& part : parts) {
      text += fmt::format("usemtl {}\n", materials_[part.material]);
      append_faces(mesh_.indices().subspan(part.first_index, part.index_count), text);
    }
    return text;
  }

  void append_faces(std::span<const std::uint32_t> indices, std::string& out) const {
    auto to = std::back_inserter(out);
    const bool textured = !mesh_.texcoords().empty();
    for (std::size_t i = 0; i < indices.size(); ++i) {
      const std::uint64_t n = std::uint64_t{indices[i]} + 1;
      if (i % 3 == 0) out += 'f';
      if (textured) {
        fmt::format_to(to, " {0}/{0}/{0}", n);
      } else {
        fmt::format_to(to, " {0}//{0}", n);
      }
      if (i % 3 == 2) out += '\n';
    }
  }

  const model::Mesh& mesh_;
  std::string_view prefix_;
  const MtlNames& materials_;
  std::string faces_;
};

Result<std::vector<NewFile>> write(const model::Actor& actor, const model::ClipPtr& clip, std::string_view prefix,
                                   const Limits& limits) {
  const model::MeshPtr& mesh = actor.model->mesh;
  if (!mesh) {
    return fail(ErrorCode::InvalidParams,
                fmt::format("expected an actor with a mesh for obj_sequence, found that \"{}\" is a skeleton alone: export glb",
                            actor.name),
                "params.actor");
  }
  TWEEND_ASSIGN(const std::vector<Moment> moments, moments_of(*clip));
  TWEEND_ASSIGN(MtlFiles look, write_mtl(mesh->surface(), !mesh->texcoords().empty(), prefix));
  const ObjText text(*mesh, prefix, look.names);
  std::vector<NewFile> files = std::move(look.files);
  std::size_t bytes = 0;
  for (const NewFile& file : files) bytes += file.bytes.size();
  model::Evaluator evaluator;
  std::vector<float> positions(3 * mesh->vertex_count()), normals(positions.size());
  for (const Moment& moment : moments) {
    TWEEND_TRY(evaluator.vertices(actor, model::shown_clip(clip, moment.time_s), {positions, normals, {}}));
    files.push_back({fmt::format("{}_{:06}.obj", prefix, moment.frame), text.of(positions, normals)});
    bytes += files.back().bytes.size();
    if (bytes <= limits.asset_bytes) continue;
    return fail(ErrorCode::Limit, fmt::format("expected a sequence of at most {} bytes, found more in {} of its {} keyframes",
                                              limits.asset_bytes, files.size(), moments.size()));
  }
  return files;
}

}  // namespace

Result<std::vector<NewFile>> write_obj_sequence(const model::Actor& actor, const model::ClipPtr& clip, std::string_view prefix,
                                                const Limits& limits) {
  try {
    return write(actor, clip, prefix, limits);
  } catch (const std::bad_alloc&) {
    return fail(ErrorCode::Unavailable, fmt::format("there is not enough memory to export \"{}\"", actor.name));
  }
}

}  // namespace tweend::assets
