#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>
#include <map>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

namespace tweend::assets {

/// Reads a .glb file and evaluates it by the letter of glTF 2.0 (section 3 and appendix C), in double precision and slowly:
/// what tests hold exported files against. Shares no code with the server. Throws where a file is not what it should be.
class GlbReading {
 public:
  using Json = nlohmann::json;
  using Row = std::vector<double>;

  explicit GlbReading(const std::string& file) {
    if (file.size() < 20 || word(file, 0) != 0x46546C67 || word(file, 4) != 2 || word(file, 8) != file.size()) {
      throw std::runtime_error("no glTF 2.0 header");
    }
    const std::size_t json_bytes = word(file, 12);
    if (word(file, 16) != 0x4E4F534A || json_bytes % 4 != 0) throw std::runtime_error("no JSON chunk");
    json = Json::parse(file.substr(20, json_bytes));
    const std::size_t bin = 20 + json_bytes;
    if (bin == file.size()) return;
    if (word(file, bin + 4) != 0x004E4942 || word(file, bin) % 4 != 0) throw std::runtime_error("no BIN chunk");
    buffer_ = file.substr(bin + 8);
    if (buffer_.size() != word(file, bin)) throw std::runtime_error("a BIN chunk of another length");
  }

  /// The elements of an accessor.
  [[nodiscard]] std::vector<Row> rows(std::size_t index) const {
    const Json& accessor = json.at("accessors").at(index);
    const std::map<std::string, std::size_t> widths{{"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT4", 16}};
    const std::size_t width = widths.at(accessor.at("type"));
    std::vector<Row> all(accessor.at("count").get<std::size_t>(), Row(width, 0.0));
    if (!accessor.contains("bufferView")) return all;
    const Json& view = json.at("bufferViews").at(accessor.at("bufferView").get<std::size_t>());
    std::size_t at = view.at("byteOffset");
    const unsigned type = accessor.at("componentType");
    for (Row& row : all) {
      for (double& v : row) v = number(type, at);
    }
    return all;
  }

  [[nodiscard]] std::size_t node(const std::string& name) const {
    const Json& nodes = json.at("nodes");
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      if (nodes[i].value("name", "") == name) return i;
    }
    throw std::runtime_error("no node " + name);
  }

  [[nodiscard]] const Json* animation(const std::string& name) const {
    if (!json.contains("animations")) return nullptr;
    for (const Json& a : json.at("animations")) {
      if (a.at("name") == name) return &a;
    }
    return nullptr;
  }

  /// translation, rotation, scale or weights of a node while `clip` (may be null) plays.
  [[nodiscard]] Row value(std::size_t node, const std::string& path, const Json* clip, double time_s) const {
    if (clip != nullptr) {
      for (const Json& channel : clip->at("channels")) {
        if (channel.at("target").at("node") == node && channel.at("target").at("path") == path) {
          return sampled(clip->at("samplers").at(channel.at("sampler").get<std::size_t>()), path, time_s);
        }
      }
    }
    const Json& n = json.at("nodes").at(node);
    if (n.contains(path)) return n.at(path);
    if (path == "translation") return {0, 0, 0};
    if (path == "rotation") return {0, 0, 0, 1};
    if (path == "scale") return {1, 1, 1};
    const Json& mesh = json.at("meshes").at(n.at("mesh").get<std::size_t>());
    return mesh.contains("weights") ? mesh.at("weights").get<Row>() : Row();
  }

  [[nodiscard]] double duration(const Json& clip) const {
    double end = 0.0;
    for (const Json& sampler : clip.at("samplers")) end = std::max(end, rows(sampler.at("input")).back()[0]);
    return end;
  }

  /// model_from_node of every node.
  [[nodiscard]] std::vector<glm::dmat4> globals(const Json* clip, double time_s) const {
    std::vector<glm::dmat4> all(json.at("nodes").size(), glm::dmat4(0.0));
    for (const std::size_t root : json.at("scenes").at(0).at("nodes")) descend(root, glm::dmat4(1.0), clip, time_s, all);
    return all;
  }

  struct Vertex {
    glm::dvec3 position;
    glm::dvec3 normal;
  };

  /// The corners of all triangles, as they are shown.
  [[nodiscard]] std::vector<Vertex> corners(const Json* clip, double time_s) const {
    const std::vector<glm::dmat4> matrices = globals(clip, time_s);
    std::vector<Vertex> out;
    for (std::size_t n = 0; n < matrices.size(); ++n) {
      const Json& node = json.at("nodes").at(n);
      if (!node.contains("mesh")) continue;
      const Row weights = value(n, "weights", clip, time_s);
      for (const Json& p : json.at("meshes").at(node.at("mesh").get<std::size_t>()).at("primitives")) {
        const std::vector<Vertex> vertices = shown(p, node, weights, matrices, n);
        for (const Row& i : rows(p.at("indices"))) out.push_back(vertices.at(static_cast<std::size_t>(i[0])));
      }
    }
    return out;
  }

  Json json;

 private:
  static std::uint32_t word(const std::string& bytes, std::size_t at) {
    std::uint32_t value = 0;
    std::memcpy(&value, bytes.data() + at, 4);
    return value;
  }

  template <class T>
  double take(std::size_t& at) const {
    T value{};
    if (at % sizeof(T) != 0 || at + sizeof(T) > buffer_.size()) throw std::runtime_error("an accessor out of the buffer");
    std::memcpy(&value, buffer_.data() + at, sizeof(T));
    at += sizeof(T);
    return static_cast<double>(value);
  }

  double number(unsigned type, std::size_t& at) const {
    if (type == 5121) return take<std::uint8_t>(at);
    if (type == 5123) return take<std::uint16_t>(at);
    if (type == 5125) return take<std::uint32_t>(at);
    return take<float>(at);
  }

  static Row unit(Row q) {
    double sum = 0.0;
    for (const double v : q) sum += v * v;
    for (double& v : q) v /= std::sqrt(sum);
    return q;
  }

  static Row slerp(const Row& a, Row b, double u) {
    double cosine = 0.0;
    for (std::size_t i = 0; i < 4; ++i) cosine += a[i] * b[i];
    if (cosine < 0.0) {
      cosine = -cosine;
      for (double& v : b) v = -v;
    }
    const double angle = std::acos(std::min(1.0, cosine));
    // Nearer than this the floats of the file tell no angle, and sin(x) / sin(angle) is as good as x / angle.
    const bool near = angle < 1e-3;
    Row out(4);
    for (std::size_t i = 0; i < 4; ++i) {
      const double from = near ? 1 - u : std::sin((1 - u) * angle) / std::sin(angle);
      out[i] = from * a[i] + (near ? u : std::sin(u * angle) / std::sin(angle)) * b[i];
    }
    return out;
  }

  [[nodiscard]] Row sampled(const Json& sampler, const std::string& path, double time_s) const {
    const std::vector<Row> times = rows(sampler.at("input"));
    Row flat;
    for (const Row& r : rows(sampler.at("output"))) flat.insert(flat.end(), r.begin(), r.end());
    const std::string mode = sampler.at("interpolation");
    const std::size_t parts = mode == "CUBICSPLINE" ? 3 : 1;
    const std::size_t width = flat.size() / times.size() / parts;
    if (width * times.size() * parts != flat.size()) throw std::runtime_error("outputs that do not fit the inputs");
    // part: 0 in-tangent, 1 value, 2 out-tangent
    const auto key = [&](std::size_t k, std::size_t part) {
      const auto at = flat.begin() + static_cast<std::ptrdiff_t>((k * parts + (parts == 1 ? 0 : part)) * width);
      return Row(at, at + static_cast<std::ptrdiff_t>(width));
    };
    for (std::size_t k = 1; k < times.size(); ++k) {
      if (!(times[k][0] > times[k - 1][0])) throw std::runtime_error("times that do not ascend");
    }
    if (time_s <= times.front()[0]) return key(0, 1);
    if (time_s >= times.back()[0]) return key(times.size() - 1, 1);
    std::size_t k = 0;
    while (times[k + 1][0] <= time_s) ++k;
    const double length = times[k + 1][0] - times[k][0];
    const double u = (time_s - times[k][0]) / length;
    if (mode == "STEP") return key(k, 1);
    if (mode == "LINEAR" && path == "rotation") return slerp(key(k, 1), key(k + 1, 1), u);
    Row out(width);
    for (std::size_t i = 0; i < width; ++i) {
      const double a = key(k, 1)[i];
      const double b = key(k + 1, 1)[i];
      out[i] = a + u * (b - a);
      if (mode != "CUBICSPLINE") continue;
      const double u2 = u * u, u3 = u2 * u;
      out[i] = (2 * u3 - 3 * u2 + 1) * a + length * (u3 - 2 * u2 + u) * key(k, 2)[i] + (3 * u2 - 2 * u3) * b +
               length * (u3 - u2) * key(k + 1, 0)[i];
    }
    return path == "rotation" ? unit(out) : out;
  }

  void descend(std::size_t node, const glm::dmat4& parent, const Json* clip, double time_s,
               std::vector<glm::dmat4>& all) const {
    const Row t = value(node, "translation", clip, time_s);
    const Row r = value(node, "rotation", clip, time_s);
    const Row s = value(node, "scale", clip, time_s);
    glm::dmat4 local(glm::mat3_cast(glm::dquat(r[3], r[0], r[1], r[2])));
    for (int c = 0; c < 3; ++c) local[c] *= s[static_cast<std::size_t>(c)];
    local[3] = glm::dvec4(t[0], t[1], t[2], 1.0);
    all[node] = parent * local;
    const Json& n = json.at("nodes").at(node);
    if (!n.contains("children")) return;
    for (const std::size_t child : n.at("children")) descend(child, all[node], clip, time_s, all);
  }

  static glm::dvec3 vec3(const Row& r) { return {r[0], r[1], r[2]}; }

  [[nodiscard]] glm::dmat4 joint_matrix(const Json& primitive, const Json& skin, std::size_t vertex,
                                        const std::vector<glm::dmat4>& matrices) const {
    const std::vector<Row> inverse_binds = rows(skin.at("inverseBindMatrices"));
    glm::dmat4 sum(0.0);
    for (int set = 0; primitive.at("attributes").contains("JOINTS_" + std::to_string(set)); ++set) {
      const Row joints = rows(primitive.at("attributes").at("JOINTS_" + std::to_string(set))).at(vertex);
      const Row weights = rows(primitive.at("attributes").at("WEIGHTS_" + std::to_string(set))).at(vertex);
      for (std::size_t i = 0; i < 4; ++i) {
        const auto joint = static_cast<std::size_t>(joints[i]);
        glm::dmat4 inverse_bind;
        for (int c = 0; c < 16; ++c) inverse_bind[c / 4][c % 4] = inverse_binds.at(joint)[static_cast<std::size_t>(c)];
        sum += weights[i] * matrices.at(skin.at("joints").at(joint).get<std::size_t>()) * inverse_bind;
      }
    }
    return sum;
  }

  [[nodiscard]] std::vector<Vertex> shown(const Json& primitive, const Json& node, const Row& weights,
                                          const std::vector<glm::dmat4>& matrices, std::size_t node_index) const {
    std::vector<Row> positions = rows(primitive.at("attributes").at("POSITION"));
    std::vector<Row> normals = rows(primitive.at("attributes").at("NORMAL"));
    for (std::size_t t = 0; primitive.contains("targets") && t < primitive.at("targets").size(); ++t) {
      const Json& target = primitive.at("targets")[t];
      add(rows(target.at("POSITION")), weights.at(t), positions);
      if (target.contains("NORMAL")) add(rows(target.at("NORMAL")), weights.at(t), normals);
    }
    std::vector<Vertex> out;
    for (std::size_t v = 0; v < positions.size(); ++v) {
      const glm::dmat4 m = node.contains("skin")
                               ? joint_matrix(primitive, json.at("skins").at(node.at("skin").get<std::size_t>()), v, matrices)
                               : matrices[node_index];
      const glm::dmat3 turn = glm::transpose(glm::inverse(glm::dmat3(m)));
      out.push_back({glm::dvec3(m * glm::dvec4(vec3(positions[v]), 1.0)), glm::normalize(turn * vec3(normals[v]))});
    }
    return out;
  }

  static void add(const std::vector<Row>& displacements, double weight, std::vector<Row>& rows) {
    for (std::size_t v = 0; v < rows.size(); ++v) {
      for (std::size_t c = 0; c < 3; ++c) rows[v][c] += weight * displacements.at(v)[c];
    }
  }

  std::string buffer_;
};

}  // namespace tweend::assets
