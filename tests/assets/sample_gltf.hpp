#pragma once

#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "server/assets/gltf_reader.hpp"
#include "tests/assets/must.hpp"

namespace tweend::assets {

using Json = nlohmann::json;

/// A small glTF writer: one buffer, as a .glb's chunk or a data URI. Tests change `json` and `bin` as they like.
class GltfBuilder {
 public:
  Json json{{"asset", {{"version", "2.0"}}}, {"nodes", Json::array()}};
  std::string bin;

  /// Puts `values` into the buffer and gives back the index of a view on them.
  template <class T>
  std::size_t view(const std::vector<T>& values) {
    bin.resize((bin.size() + 3) / 4 * 4, '\0');
    json["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", bin.size()}, {"byteLength", values.size() * sizeof(T)}});
    bin.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
    return json["bufferViews"].size() - 1;
  }

  /// @return the index of an accessor of `values`
  template <class T>
  std::size_t accessor(std::string_view type, const std::vector<T>& values, bool normalized = false) {
    const std::size_t width = type == "SCALAR" ? 1 : type == "MAT4" ? 16 : static_cast<std::size_t>(type.back() - '0');
    Json a{
        {"bufferView", view(values)}, {"componentType", component_of(T{})}, {"count", values.size() / width}, {"type", type}};
    if (normalized) a["normalized"] = true;
    json["accessors"].push_back(a);
    return json["accessors"].size() - 1;
  }

  /// An animation of one channel.
  template <class T>
  void animation(std::string_view name, std::size_t node, std::string_view path, std::string_view interpolation,
                 const std::vector<float>& times, const std::vector<T>& values, bool normalized = false) {
    const std::string_view type = path == "weights" ? "SCALAR" : path == "rotation" ? "VEC4" : "VEC3";
    const std::size_t input = accessor("SCALAR", times);
    const std::size_t output = accessor(type, values, normalized);
    json["animations"].push_back({{"name", name},
                                  {"samplers", {{{"input", input}, {"output", output}, {"interpolation", interpolation}}}},
                                  {"channels", {{{"sampler", 0}, {"target", {{"node", node}, {"path", path}}}}}}});
  }

  [[nodiscard]] std::string glb() const {
    Json own = json;
    if (!own.contains("buffers") && !bin.empty()) own["buffers"] = {{{"byteLength", bin.size()}}};
    std::string text = own.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    std::string data = bin;
    data.resize((data.size() + 3) / 4 * 4, '\0');
    std::string out = "glTF" + u32(2) + u32(12 + 8 + text.size() + (data.empty() ? 0 : 8 + data.size()));
    out += u32(text.size()) + "JSON" + text;
    if (!data.empty()) out += u32(data.size()) + std::string("BIN\0", 4) + data;
    return out;
  }

  /// The text form, whose buffer is at `uri`.
  [[nodiscard]] std::string gltf(const std::string& uri) const {
    Json own = json;
    own["buffers"] = {{{"byteLength", bin.size()}, {"uri", uri}}};
    return own.dump();
  }
  [[nodiscard]] std::string gltf() const { return gltf("data:application/octet-stream;base64," + base64(bin)); }

  static std::string u32(std::size_t value) {
    const auto narrow = static_cast<std::uint32_t>(value);
    std::string bytes(4, '\0');
    std::memcpy(bytes.data(), &narrow, 4);
    return bytes;
  }

  static std::string base64(std::string_view bytes) {
    constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
      std::uint32_t bits = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        bits = bits << 8U | (i + k < bytes.size() ? static_cast<std::uint8_t>(bytes[i + k]) : 0U);
      }
      for (std::size_t k = 0; k < 4; ++k) text += i + k <= bytes.size() ? kDigits[(bits >> (18 - 6 * k)) & 63U] : '=';
    }
    return text;
  }

 private:
  static int component_of(std::int8_t) { return 5120; }
  static int component_of(std::uint8_t) { return 5121; }
  static int component_of(std::int16_t) { return 5122; }
  static int component_of(std::uint16_t) { return 5123; }
  static int component_of(std::uint32_t) { return 5125; }
  static int component_of(float) { return 5126; }
};

inline Result<std::string> no_side_file(std::string_view name, std::size_t) {
  return fail(ErrorCode::NotFound, "expected a file, found no " + std::string(name));
}

inline Result<model::ImportedModel> try_read(const std::string& bytes, const Limits& limits = {}) {
  return read_gltf(bytes, "test.glb", no_side_file, 0, limits);
}
inline model::ImportedModel must_read(const GltfBuilder& b) { return must(try_read(b.glb())); }

/// A node with a triangle in the plane z = 0, without normals.
inline GltfBuilder triangle_gltf() {
  GltfBuilder b;
  b.json["nodes"] = {{{"name", "tri"}, {"mesh", 0}}};
  const std::size_t position = b.accessor<float>("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0});
  b.json["meshes"] = {{{"primitives", {{{"attributes", {{"POSITION", position}}}}}}}};
  return b;
}

/// A bar of six vertices along +Y on two joints, `shoulder` and `elbow` (1 m above it); the middle ones follow both.
inline GltfBuilder arm_gltf() {
  GltfBuilder b;
  b.json["nodes"] = {{{"name", "bar"}, {"mesh", 0}, {"skin", 0}, {"children", {1}}},
                     {{"name", "shoulder"}, {"children", {2}}},
                     {{"name", "elbow"}, {"translation", {0, 1, 0}}}};
  std::vector<float> positions, normals, weights, binds;
  std::vector<std::uint8_t> joints;
  for (int row = 0; row < 3; ++row) {
    for (const float x : {-0.25F, 0.25F}) {
      positions.insert(positions.end(), {x, static_cast<float>(row), 0.0F});
      normals.insert(normals.end(), {0.0F, 0.0F, 1.0F});
      joints.insert(joints.end(), {0, 1, 0, 0});
      const float w = 0.5F * static_cast<float>(row);
      weights.insert(weights.end(), {1.0F - w, w, 0.0F, 0.0F});
    }
  }
  for (const float y : {0.0F, -1.0F}) binds.insert(binds.end(), {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, y, 0, 1});
  const Json attributes{{"POSITION", b.accessor("VEC3", positions)},
                        {"NORMAL", b.accessor("VEC3", normals)},
                        {"JOINTS_0", b.accessor("VEC4", joints)},
                        {"WEIGHTS_0", b.accessor("VEC4", weights)}};
  const std::size_t indices = b.accessor<std::uint16_t>("SCALAR", {0, 1, 3, 0, 3, 2, 2, 3, 5, 2, 5, 4});
  b.json["meshes"] = {{{"primitives", {{{"attributes", attributes}, {"indices", indices}}}}}};
  b.json["skins"] = {{{"joints", {1, 2}}, {"inverseBindMatrices", b.accessor("MAT4", binds)}}};
  return b;
}

}  // namespace tweend::assets
