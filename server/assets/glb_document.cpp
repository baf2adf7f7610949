#include "server/assets/glb_document.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <string_view>

namespace tweend::assets {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view kUnlit = "KHR_materials_unlit";

std::string_view shape_name(GlbShape shape) {
  constexpr std::array<std::string_view, 5> kNames{"SCALAR", "VEC2", "VEC3", "VEC4", "MAT4"};
  return kNames[static_cast<std::size_t>(shape)];
}

void add_name(const std::string& name, Json& json) {
  if (!name.empty()) json["name"] = name;
}

/// A list of the document: empty ones are not allowed, and left out.
template <class T, class Make>
void add_list(const char* name, const std::vector<T>& list, const Make& make, Json& json) {
  if (list.empty()) return;
  Json& array = json[name] = Json::array();
  for (const T& item : list) array.push_back(make(item));
}

Json node_json(const GlbNode& node) {
  static const GlbNode rest;
  Json json = Json::object();
  add_name(node.name, json);
  if (!node.children.empty()) json["children"] = node.children;
  if (node.translation != rest.translation) json["translation"] = node.translation;
  if (node.rotation != rest.rotation) json["rotation"] = node.rotation;
  if (node.scale != rest.scale) json["scale"] = node.scale;
  if (node.mesh) json["mesh"] = *node.mesh;
  if (node.skin) json["skin"] = *node.skin;
  return json;
}

Json primitive_json(const GlbPrimitive& primitive) {
  Json json;
  for (const auto& [name, accessor] : primitive.attributes) json["attributes"][name] = accessor;
  json["indices"] = primitive.indices;
  if (primitive.material) json["material"] = *primitive.material;
  add_list(
      "targets", primitive.targets,
      [](const GlbMorph& morph) {
        Json target{{"POSITION", morph.position}};
        if (morph.normal) target["NORMAL"] = *morph.normal;
        return target;
      },
      json);
  return json;
}

Json mesh_json(const GlbMesh& mesh) {
  Json json = Json::object();
  add_name(mesh.name, json);
  add_list("primitives", mesh.primitives, primitive_json, json);
  if (!mesh.weights.empty()) {
    json["weights"] = mesh.weights;
    json["extras"]["targetNames"] = mesh.target_names;
  }
  return json;
}

Json skin_json(const GlbSkin& skin) { return {{"inverseBindMatrices", skin.inverse_bind_matrices}, {"joints", skin.joints}}; }

Json animation_json(const GlbAnimation& animation) {
  Json json = Json::object();
  add_name(animation.name, json);
  add_list(
      "channels", animation.channels,
      [](const GlbChannel& c) {
        return Json{{"sampler", c.sampler}, {"target", {{"node", c.node}, {"path", c.path}}}};
      },
      json);
  add_list(
      "samplers", animation.samplers,
      [](const GlbSampler& s) {
        return Json{{"input", s.input}, {"interpolation", s.interpolation}, {"output", s.output}};
      },
      json);
  return json;
}

/// Light is reflected as by a surface neither metallic nor quite smooth, from both sides: what is drawn here comes nearest.
Json material_json(const GlbMaterial& material) {
  constexpr double kRoughness = 0.5;
  Json json = Json::object();
  add_name(material.name, json);
  Json& surface = json["pbrMetallicRoughness"];
  surface["baseColorFactor"] = material.base_color;
  if (material.texture) surface["baseColorTexture"]["index"] = *material.texture;
  surface["metallicFactor"] = 0.0;
  surface["roughnessFactor"] = kRoughness;
  if (material.alpha_cutoff) {
    json["alphaMode"] = "MASK";
    json["alphaCutoff"] = *material.alpha_cutoff;
  }
  json["doubleSided"] = true;
  if (material.unlit) json["extensions"][kUnlit] = Json::object();
  return json;
}

Json accessor_json(const GlbAccessor& accessor) {
  Json json = Json::object();
  if (accessor.view) json["bufferView"] = *accessor.view;
  json["componentType"] = static_cast<unsigned>(accessor.component);
  json["count"] = accessor.count;
  json["type"] = shape_name(accessor.shape);
  if (!accessor.min.empty()) {
    json["min"] = accessor.min;
    json["max"] = accessor.max;
  }
  return json;
}

Json view_json(const GlbBufferView& view) {
  Json json{{"buffer", 0}, {"byteOffset", view.offset}, {"byteLength", view.bytes}};
  if (view.use != GlbUse::None) json["target"] = static_cast<unsigned>(view.use);
  return json;
}

/// A sampler for each texture: there are few.
void add_textures(const GlbDocument& document, Json& json) {
  add_list(
      "samplers", document.textures,
      [](const GlbTexture& t) {
        return Json{{"wrapS", t.wrap_s}, {"wrapT", t.wrap_t}};
      },
      json);
  std::size_t sampler = 0;
  add_list(
      "textures", document.textures,
      [&](const GlbTexture& t) {
        return Json{{"sampler", sampler++}, {"source", t.image}};
      },
      json);
  add_list(
      "images", document.png_images,
      [](std::size_t view) {
        return Json{{"bufferView", view}, {"mimeType", "image/png"}};
      },
      json);
}

std::string document_json(const GlbDocument& document, std::size_t buffer_bytes) {
  Json json;
  json["asset"] = {{"version", "2.0"}, {"generator", "tweend " TWEEND_VERSION}};
  for (const GlbMaterial& material : document.materials) {
    if (material.unlit) json["extensionsUsed"] = Json::array({kUnlit});
  }
  json["scene"] = 0;
  json["scenes"] = Json::array({Json{{"nodes", document.roots}}});
  add_list("nodes", document.nodes, node_json, json);
  add_list("meshes", document.meshes, mesh_json, json);
  add_list("skins", document.skins, skin_json, json);
  add_list("animations", document.animations, animation_json, json);
  add_list("materials", document.materials, material_json, json);
  add_textures(document, json);
  add_list("accessors", document.accessors, accessor_json, json);
  add_list("bufferViews", document.views, view_json, json);
  if (buffer_bytes > 0) json["buffers"] = Json::array({Json{{"byteLength", buffer_bytes}}});
  // Names come from files and commands, which were found to be UTF-8; what is not must not keep the rest from being saved.
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

void append_u32(std::uint64_t value, std::string& out) {
  for (unsigned byte = 0; byte < 4; ++byte) out += static_cast<char>((value >> (8U * byte)) & 0xFFU);
}

std::size_t padded(std::size_t bytes) { return (bytes + 3) / 4 * 4; }

}  // namespace

Result<std::string> write_document(const GlbDocument& document, std::size_t most_bytes) {
  constexpr std::size_t kHeaderBytes = 12, kChunkHeaderBytes = 8;
  constexpr std::uint32_t kMagic = 0x46546C67, kVersion = 2, kJsonChunk = 0x4E4F534A, kBinChunk = 0x004E4942;
  const std::string json = document_json(document, document.buffer.size());
  const std::size_t bin = padded(document.buffer.size());
  const std::size_t total = kHeaderBytes + kChunkHeaderBytes + padded(json.size()) + (bin > 0 ? kChunkHeaderBytes + bin : 0);
  if (total > std::min<std::size_t>(most_bytes, std::numeric_limits<std::uint32_t>::max())) {
    return fail(ErrorCode::Limit,
                fmt::format("expected a file of at most {} bytes, found that it takes {}", most_bytes, total));
  }
  std::string file;
  file.reserve(total);
  for (const std::uint64_t word : {std::uint64_t{kMagic}, std::uint64_t{kVersion}, std::uint64_t{total},
                                   std::uint64_t{padded(json.size())}, std::uint64_t{kJsonChunk}}) {
    append_u32(word, file);
  }
  file += json;
  file.resize(kHeaderBytes + kChunkHeaderBytes + padded(json.size()), ' ');
  if (bin > 0) {
    append_u32(bin, file);
    append_u32(kBinChunk, file);
    file += document.buffer;
    file.resize(total, '\0');
  }
  return file;
}

}  // namespace tweend::assets
