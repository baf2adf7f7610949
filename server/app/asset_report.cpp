#include "server/app/asset_report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <vector>

namespace tweend::app {
namespace {

constexpr std::size_t kMostLines = 40;  // of one list

using Lines = std::vector<std::string>;

std::string counted(std::size_t count, std::string_view one) {
  if (count == 1) return fmt::format("1 {}", one);
  if (one == "vertex") return fmt::format("{} vertices", count);
  if (one == "matrix") return fmt::format("{} matrices", count);
  return fmt::format("{} {}{}", count, one, one == "mesh" ? "es" : "s");
}

std::string joined(const Lines& lines) {
  std::string text;
  for (std::size_t i = 0; i < lines.size() && i < kMostLines; ++i) text += "  " + lines[i] + "\n";
  if (lines.size() > kMostLines) text += fmt::format("  … and {} more\n", lines.size() - kMostLines);
  return text;
}

std::string name_or_dash(const std::string& name) { return name.empty() ? "-" : printable(name); }

std::string report_skeleton(const model::Skeleton& skeleton) {
  std::vector<std::vector<std::uint32_t>> children(skeleton.size());
  std::vector<std::pair<std::uint32_t, std::size_t>> waiting;  // with how deep they are
  for (std::uint32_t i = static_cast<std::uint32_t>(skeleton.size()); i-- > 0;) {
    const std::int32_t parent = skeleton.joints()[i].parent;
    if (parent < 0) {
      waiting.emplace_back(i, 0);
    } else {
      children[static_cast<std::size_t>(parent)].push_back(i);
    }
  }
  Lines lines;
  std::size_t deepest = 0;
  while (!waiting.empty()) {
    const auto [joint, depth] = waiting.back();
    waiting.pop_back();
    deepest = std::max(deepest, depth + 1);
    lines.push_back(std::string(2 * std::min<std::size_t>(depth, 20), ' ') + printable(skeleton.joints()[joint].name));
    for (const std::uint32_t child : children[joint]) waiting.emplace_back(child, depth + 1);
  }
  return fmt::format("Skeleton: {}, {} deep\n", counted(skeleton.size(), "joint"), deepest) + joined(lines);
}

std::string describe(const model::Material& m) {
  const auto byte = [](float c) { return static_cast<int>(std::lround(std::clamp(c, 0.0F, 1.0F) * 255.0F)); };
  std::string text = fmt::format("#{:02x}{:02x}{:02x}", byte(m.base_color.x), byte(m.base_color.y), byte(m.base_color.z));
  if (m.base_color_texture) {
    text += fmt::format(", texture {} x {}", m.base_color_texture->width(), m.base_color_texture->height());
  }
  if (m.alpha_cutoff) text += fmt::format(", nothing drawn below alpha {:.3g}", *m.alpha_cutoff);
  if (m.unlit) text += ", unlit";
  return text;
}

std::string report_mesh(const model::Mesh& mesh, const model::VertexKey& rest) {
  const model::Bounds& b = rest.bounds();
  std::string text =
      fmt::format("Mesh: {}, {}\n  within ({:.4g} {:.4g} {:.4g}) and ({:.4g} {:.4g} {:.4g}), at rest{}{}\n",
                  counted(mesh.vertex_count(), "vertex"), counted(mesh.triangle_count(), "triangle"), b.min.x, b.min.y, b.min.z,
                  b.max.x, b.max.y, b.max.z, mesh.texcoords().empty() ? "" : ", with texture coordinates",
                  mesh.colors().empty() ? "" : ", with vertex colours");
  const model::Surface& surface = mesh.surface();
  std::vector<std::size_t> triangles(surface.materials.size(), 0);
  for (const model::MeshPart& part : surface.parts) triangles[part.material] += part.index_count / 3;
  Lines lines;
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    lines.push_back(fmt::format("{}: {}, {}", name_or_dash(surface.materials[i].name), counted(triangles[i], "triangle"),
                                describe(surface.materials[i])));
  }
  return text + fmt::format("Materials: {}\n", lines.size()) + joined(lines);
}

std::string report_morphs(const model::MorphTargets& morphs) {
  Lines lines;
  for (const model::MorphTarget& t : morphs.targets()) {
    lines.push_back(
        fmt::format("{}: at first {:.3g}, {}", printable(t.name), t.default_weight, counted(t.positions.size() / 3, "vertex")));
  }
  return fmt::format("Morph targets: {}\n", lines.size()) + joined(lines);
}

/// "12 rotations, 1 translation (linear, step)"
std::string describe_tracks(const model::Clip& clip) {
  constexpr std::array<std::string_view, 4> kProperties{"translation", "rotation", "scale", "weight"};
  constexpr std::array<std::string_view, 4> kModes{"step", "linear", "catmull_rom", "cubic"};
  std::array<std::size_t, 4> tracks{};
  std::set<std::string_view> modes;
  if (clip.channel_modes) {
    for (const model::ChannelMode& mode : *clip.channel_modes) {
      ++tracks[static_cast<std::size_t>(mode.channel.property)];
      modes.insert(kModes[static_cast<std::size_t>(mode.interpolation)]);
    }
  }
  Lines parts;
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    if (tracks[i] > 0) parts.push_back(counted(tracks[i], kProperties[i]));
  }
  return parts.empty() ? "" : fmt::format("; {} ({})", fmt::join(parts, ", "), fmt::join(modes, ", "));
}

std::string report_clips(const std::vector<model::Clip>& clips) {
  Lines lines;
  for (const model::Clip& clip : clips) {
    std::size_t keys = 0;
    for (const model::Keyframe& keyframe : clip.keyframes) keys += keyframe.pose ? keyframe.pose->values().size() : 1;
    const bool vertices = clip.type() == model::ClipType::Vertex;
    lines.push_back(fmt::format("{}: {:.3f} s, {}{}{}", printable(clip.name), clip.duration_s(),
                                counted(clip.keyframes.size(), "keyframe"),
                                vertices ? " of vertices" : ", " + counted(keys, "key"), describe_tracks(clip)));
  }
  return fmt::format("Clips: {}\n", lines.size()) + joined(lines);
}

}  // namespace

std::string printable(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    const bool c1 = byte == 0xC2 && i + 1 < text.size() && static_cast<unsigned char>(text[i + 1]) < 0xA0;  // U+0080 to U+009F
    out += byte < 0x20 || byte == 0x7F || c1 ? '?' : text[i];
    if (c1) ++i;
  }
  return out;
}

std::string report_facts(const assets::GltfFacts& f) {
  std::string text = fmt::format("glTF {}", printable(f.version));
  if (!f.generator.empty()) text += fmt::format(", written by {}", printable(f.generator));
  text += fmt::format("\n  {}, {}, {}, {}, {}, {}, {}, {}, {}\n", counted(f.scenes, "scene"), counted(f.nodes, "node"),
                      counted(f.meshes, "mesh"), counted(f.skins, "skin"), counted(f.animations, "animation"),
                      counted(f.materials, "material"), counted(f.textures, "texture"), counted(f.images, "image"),
                      counted(f.cameras, "camera"));
  for (const std::string& extension : f.extensions_used) {
    const bool required =
        std::find(f.extensions_required.begin(), f.extensions_required.end(), extension) != f.extensions_required.end();
    text += fmt::format("  extension {}{}\n", printable(extension), required ? ", required" : "");
  }
  return text;
}

std::string report_model(const model::ImportedModel& imported) {
  const model::Model& model = *imported.model;
  std::string text;
  if (model.skeleton) text += report_skeleton(*model.skeleton);
  if (model.mesh) text += report_mesh(*model.mesh, *model.rest);
  if (model.skin) {
    text += fmt::format("Skin: {}, {} a vertex\n", counted(model.skin->entries().size(), "matrix"),
                        counted(model.skin->per_vertex(), "influence"));
  }
  if (model.morphs) text += report_morphs(*model.morphs);
  text += report_clips(imported.clips);
  if (!imported.warnings.empty()) {
    Lines lines;
    for (const std::string& warning : imported.warnings) lines.push_back(printable(warning));
    text += fmt::format("Warnings: {}\n", lines.size()) + joined(lines);
  }
  return text;
}

}  // namespace tweend::app
