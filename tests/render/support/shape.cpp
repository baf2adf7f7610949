#include "tests/render/support/shape.hpp"

#include <atomic>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <random>

namespace tweend::render::test {

void Shape::rename() {
  static std::atomic<std::uint64_t> names{0};
  name = ++names;
}

void Shape::add_key(const std::vector<glm::vec3>& positions, const std::vector<glm::vec3>& normals) {
  std::vector<float> block;
  for (const auto* stream : {&positions, &normals}) {
    for (const glm::vec3& v : *stream) block.insert(block.end(), {v.x, v.y, v.z});
  }
  if (!texcoords.empty()) {
    for (std::size_t i = 0; i < vertex_count; ++i) block.insert(block.end(), {1.0F, 0.0F, 0.0F});
  }
  blocks.push_back(std::move(block));
}

MeshSourcePtr Shape::source() const {
  MeshSource mesh;
  mesh.id = {name, 0};
  mesh.vertex_count = vertex_count;
  mesh.indices = indices;
  mesh.texcoords = texcoords;
  mesh.colors = colors;
  mesh.skin = {influences, entries, entry_weights};
  mesh.morphs = morphs;
  mesh.materials = materials;
  mesh.parts = parts;
  if (parts.empty()) mesh.parts.push_back({0, static_cast<std::uint32_t>(indices.size()), 0});
  return std::make_shared<const MeshSource>(std::move(mesh));
}

KeySource Shape::key(std::size_t index) const { return {{name, index + 1}, blocks[index]}; }

DrawItem Shape::item(const std::vector<std::size_t>& keys, const std::vector<float>& weights) const& {
  DrawItem item;
  item.mesh = source();
  item.key_count = static_cast<std::uint32_t>(keys.size());
  item.keys_expected = blocks.size();
  item.weight = {};
  for (std::size_t i = 0; i < keys.size(); ++i) {
    item.key[i] = key(keys[i]);
    item.weight[i] = weights[i];
  }
  return item;
}

Shape square(float half, float z, glm::vec3 normal) {
  Shape shape;
  shape.vertex_count = 4;
  shape.indices = {0, 1, 2, 0, 2, 3};
  shape.texcoords = {0, 0, 1, 0, 1, 1, 0, 1};
  shape.add_key({{-half, -half, z}, {half, -half, z}, {half, half, z}, {-half, half, z}}, {4, normal});
  return shape;
}

Shape ball(std::uint32_t rings, std::uint32_t segments) {
  Shape shape;
  std::vector<glm::vec3> places;
  for (std::uint32_t ring = 0; ring <= rings; ++ring) {
    const float v = static_cast<float>(ring) / static_cast<float>(rings);
    for (std::uint32_t segment = 0; segment <= segments; ++segment) {
      const float u = static_cast<float>(segment) / static_cast<float>(segments);
      const float up = glm::pi<float>() * v;
      const float round = 2.0F * glm::pi<float>() * u;
      places.emplace_back(std::sin(up) * std::sin(round), -std::cos(up), std::sin(up) * std::cos(round));
      shape.texcoords.insert(shape.texcoords.end(), {u, v});
      if (ring == rings || segment == segments) continue;
      const std::uint32_t at = ring * (segments + 1) + segment;
      const std::uint32_t above = at + segments + 1;
      shape.indices.insert(shape.indices.end(), {at, at + 1, above + 1, at, above + 1, above});
    }
  }
  shape.vertex_count = places.size();
  shape.add_key(places, places);
  return shape;
}

std::vector<float> random_block(std::size_t vertex_count, bool textured, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<float> noise;
  std::vector<float> block;
  for (std::size_t stream = 0; stream < (textured ? 3U : 2U); ++stream) {
    for (std::size_t v = 0; v < vertex_count; ++v) {
      glm::vec3 value(noise(random), noise(random), noise(random));
      if (stream != 0) value = glm::normalize(value);
      block.insert(block.end(), {value.x, value.y, value.z});
    }
  }
  return block;
}

}  // namespace tweend::render::test
