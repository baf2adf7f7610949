// Blending keyframes of vertices, positions and renormalised normals, one core: tweend against a plain GLM loop and
// against a memcpy of the output (24 bytes a vertex), the least that anything that makes these bytes could cost.

#include <hwy/targets.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "bench/support/ratio.hpp"
#include "server/animation/blend_vertices.hpp"
#include "server/animation/key_blend.hpp"

namespace {

using namespace tweend;
using namespace tweend::animation;

constexpr double kTimeS = 1.3;  ///< of keys at 0, 1, 2 and 3 s: between the second and third, u = 0.3

/// Four keyframes of `n` vertices, once as tweend keeps them and once as GLM code would.
struct Keys {
  explicit Keys(std::size_t n) : vertex_count(n), block(4, std::vector<float>(6 * n)), positions(4), normals(4) {
    std::mt19937 random(7);
    std::normal_distribution<float> noise;
    for (std::size_t key = 0; key < 4; ++key) {
      for (std::size_t v = 0; v < n; ++v) {
        positions[key].emplace_back(noise(random), noise(random), noise(random));
        normals[key].push_back(glm::normalize(glm::vec3(noise(random), noise(random), noise(random))));
      }
      std::memcpy(block[key].data(), positions[key].data(), 12 * n);
      std::memcpy(block[key].data() + 3 * n, normals[key].data(), 12 * n);
    }
  }
  [[nodiscard]] VertexAttributes attributes(std::size_t key) const {
    const std::span<const float> all = block[key];
    return {all.first(3 * vertex_count), all.last(3 * vertex_count), {}};
  }
  std::size_t vertex_count;
  std::vector<std::vector<float>> block;
  std::vector<std::vector<glm::vec3>> positions;
  std::vector<std::vector<glm::vec3>> normals;
};

struct GlmOutput {
  explicit GlmOutput(std::size_t n) : positions(n), normals(n) {}
  std::vector<glm::vec3> positions;
  std::vector<glm::vec3> normals;
};

void glm_linear(const Keys& keys, float u, GlmOutput& out) {
  for (std::size_t v = 0; v < keys.vertex_count; ++v) {
    out.positions[v] = glm::mix(keys.positions[1][v], keys.positions[2][v], u);
    out.normals[v] = glm::normalize(glm::mix(keys.normals[1][v], keys.normals[2][v], u));
  }
}

glm::vec3 spline(float u, const glm::vec3& x0, const glm::vec3& x1, const glm::vec3& x2, const glm::vec3& x3) {
  const float u2 = u * u;
  const float u3 = u * u2;
  return 0.5F *
         (2.0F * x1 + (-x0 + x2) * u + (2.0F * x0 - 5.0F * x1 + 4.0F * x2 - x3) * u2 + (-x0 + 3.0F * x1 - 3.0F * x2 + x3) * u3);
}

void glm_catmull_rom(const Keys& keys, float u, GlmOutput& out) {
  const auto& p = keys.positions;
  const auto& n = keys.normals;
  for (std::size_t v = 0; v < keys.vertex_count; ++v) {
    out.positions[v] = spline(u, p[0][v], p[1][v], p[2][v], p[3][v]);
    out.normals[v] = glm::normalize(spline(u, n[0][v], n[1][v], n[2][v], n[3][v]));
  }
}

void tweend_blend(const Keys& keys, Interpolation mode, std::vector<float>& out) {
  constexpr std::array kKeyTimesS{0.0, 1.0, 2.0, 3.0};
  const KeyTimeline timeline{kKeyTimesS, 3.0, false};
  const KeyBlend blend = blend_keys(timeline, locate(timeline, kTimeS), mode, nullptr);
  std::array<VertexAttributes, 4> sources;
  for (std::uint32_t i = 0; i < blend.count; ++i) sources[i] = keys.attributes(blend.key[i]);
  const std::span all(out);
  const VertexTarget target{all.first(all.size() / 2), all.last(all.size() / 2), {}};
  if (!blend_vertices(std::span(sources).first(blend.count), std::span(blend.weight).first(blend.count), blend.nearest,
                      target)) {
    std::abort();
  }
}

/// Never time a wrong answer.
bool agree(const std::vector<float>& out, const GlmOutput& reference) {
  const std::size_t n = reference.positions.size();
  float worst = 0.0F;
  for (std::size_t v = 0; v < n; ++v) {
    const auto at = [&](std::size_t i) { return glm::vec3(out[3 * i], out[3 * i + 1], out[3 * i + 2]); };
    worst = std::max({worst, glm::distance(at(v), reference.positions[v]), glm::distance(at(n + v), reference.normals[v])});
  }
  // A normal whose keys nearly cancel out is known as badly as it is short; of a million random ones, some are 1000 times.
  constexpr float kTolerance = 1e-3F;
  if (worst <= kTolerance) return true;
  std::fprintf(stderr, "wrong answer: %g away from GLM's\n", static_cast<double>(worst));
  return false;
}

/// Races one kind of interpolation at one size; prints a row and adds its claims.
bool race(const Keys& keys, const std::string& size, Interpolation mode, std::vector<bench::Claim>& claims) {
  const bool linear = mode == Interpolation::Linear;
  const std::size_t bytes = 24 * keys.vertex_count;
  std::vector<float> out(6 * keys.vertex_count);
  GlmOutput reference(keys.vertex_count);
  const auto run_glm = [&] {
    const float u = static_cast<float>(kTimeS) - 1.0F;
    linear ? glm_linear(keys, u, reference) : glm_catmull_rom(keys, u, reference);
    bench::keep(reference.normals.data());
  };
  const auto run_tweend = [&] {
    tweend_blend(keys, mode, out);
    bench::keep(out.data());
  };
  const auto run_memcpy = [&] {
    std::memcpy(out.data(), keys.block[1].data(), bytes);
    bench::keep(out.data());
  };
  run_glm();
  run_tweend();
  if (!agree(out, reference)) return false;

  const auto items = static_cast<double>(keys.vertex_count);
  const bench::Race race = bench::measure({.items = items}, run_memcpy, run_tweend, run_glm);
  const double vs_memcpy = race.ratio(1, 0);
  std::printf("%8s  %-11s %10.3f %10.3f %10.3f %10.2f %10.2f\n", size.c_str(), linear ? "linear" : "catmull_rom", race.ns(0),
              race.ns(1), race.ns(2), vs_memcpy, race.ratio(2, 1));
  // A thousand vertices fit the first-level cache, where a memcpy costs next to nothing; a million measure the memory.
  if (size == "10k" || size == "100k") {
    const std::string name = std::string("vertex_") + (linear ? "linear_" : "catmull_rom_") + size + "_vs_memcpy";
    claims.push_back({name, vs_memcpy, linear ? 2.5 : 4.0});
  }
  return true;
}

}  // namespace

int main() {
  const std::int64_t usable = hwy::SupportedTargets() & HWY_TARGETS;  // the lowest bit is the best
  std::printf("positions and normals, ns a vertex, one core, %s\n", hwy::TargetName(usable & -usable));
  std::printf("%8s  %-11s %10s %10s %10s %10s %10s\n", "vertices", "", "memcpy", "tweend", "GLM", "tw./memcpy", "GLM/tw.");
  std::vector<bench::Claim> claims;
  const struct {
    const char* name;
    std::size_t vertices;
  } sizes[] = {{"1k", 1'000}, {"10k", 10'000}, {"100k", 100'000}, {"1M", 1'000'000}};
  for (const auto& size : sizes) {
    const Keys keys(size.vertices);
    for (const Interpolation mode : {Interpolation::Linear, Interpolation::CatmullRom}) {
      if (!race(keys, size.name, mode, claims)) return 1;
    }
  }
  return bench::report(claims) ? 0 : 1;
}
