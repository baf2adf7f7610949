// keyframe.add of 100,000 vertices: over loopback as base64, to a clip that is empty and to one that has 100 such keyframes
// already, beside the least such a message needs: base64 decoded, normals computed, contents hashed, in one thread.
// And the edit itself, in memory: a transaction on a clip of 100 x 100,000 vertices, beside a copy of one keyframe's floats.

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "bench/support/ratio.hpp"
#include "bench/support/server_process.hpp"
#include "protocol/base64.hpp"
#include "server/model/scene.hpp"
#include "server/stage/transaction.hpp"

namespace {

using namespace tweend;

constexpr int kSide = 316;  // 99,856 vertices
constexpr std::size_t kVertices = static_cast<std::size_t>(kSide) * kSide;
constexpr int kKeys = 100;

std::vector<float> wave(double phase) {
  std::vector<float> positions;
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      positions.insert(positions.end(), {static_cast<float>(x), static_cast<float>(std::sin(0.1 * x + 0.07 * y + phase)),
                                         static_cast<float>(y)});
    }
  }
  return positions;
}

std::vector<std::uint32_t> grid() {
  std::vector<std::uint32_t> indices;
  for (std::uint32_t y = 0; y + 1 < kSide; ++y) {
    for (std::uint32_t x = 0; x + 1 < kSide; ++x) {
      const std::uint32_t a = y * kSide + x, b = a + 1, c = a + kSide, d = c + 1;
      indices.insert(indices.end(), {a, c, b, b, c, d});
    }
  }
  return indices;
}

std::string base64(const std::vector<float>& values) {
  std::string text;
  protocol::append_base64(std::as_bytes(std::span(values)), text);
  return text;
}

double exchange_ms(bench::LineClient& client, const std::string& request, const char* expected) {
  const auto start = std::chrono::steady_clock::now();
  const std::string_view answer = client.exchange(request);
  const double ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  if (answer.find(expected) == std::string_view::npos) bench::give_up("wrong answer: " + std::string(answer.substr(0, 400)));
  return ms;
}

std::string request(const std::string& method, const std::string& params) {
  return fmt::format(R"({{"jsonrpc":"2.0","id":7,"method":"{}","params":{}}})", method, params) + "\n";
}

model::VertexKeyPtr make_key(const model::Mesh& mesh, const std::vector<float>& positions) {
  auto key = model::VertexKey::make(mesh, positions);
  if (!key) bench::give_up(key.error().message);
  return *key;
}

model::MeshPtr make_mesh() {
  auto mesh = model::Mesh::make(kVertices, grid());
  if (!mesh) bench::give_up(mesh.error().message);
  return *mesh;
}

struct OverLoopback {
  double first_ms, after_100_ms, bare_ms;
};

std::string add_actor(const char* name) {
  return request("actor.add", fmt::format(R"({{"actor":"{}","mesh":{{"positions":[{}],"indices":[{}]}}}})", name,
                                          fmt::join(wave(0), ","), fmt::join(grid(), ",")));
}

std::string add_keyframe(const char* actor, const std::string& packed) {
  return request("keyframe.add", fmt::format(R"({{"actor":"{}","vertices":{{"positions_base64":"{}"}}}})", actor, packed));
}

double decode_ms(const model::Mesh& mesh, const std::string& packed) {
  const auto start = std::chrono::steady_clock::now();
  const auto bytes = protocol::decode_base64(packed);
  std::vector<float> positions(bytes->size() / sizeof(float));
  std::memcpy(positions.data(), bytes->data(), bytes->size());
  bench::keep(make_key(mesh, positions)->positions().data());
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

OverLoopback measure_over_loopback(const model::MeshPtr& mesh) {
  const bench::ServerProcess server;
  bench::LineClient client(server.port());
  for (const char* actor : {"short", "long"}) static_cast<void>(exchange_ms(client, add_actor(actor), "\"vertices\":99856"));
  for (int i = 0; i < kKeys; ++i) {
    static_cast<void>(exchange_ms(client, add_keyframe("long", base64(wave(0.01 * i))), "\"keyframe\":"));
  }
  const std::string packed = base64(wave(0.5));
  const auto add = [&](const char* actor) {
    const double ms = exchange_ms(client, add_keyframe(actor, packed), "\"keyframe\":");
    // Taken back at once: the clip stays as long as it was.
    static_cast<void>(exchange_ms(client, request("edit.undo", "{}"), "keyframe.add"));
    return ms;
  };
  std::vector<double> first, after, bare;
  for (int i = 0; i < 31; ++i) {
    first.push_back(add("short"));
    after.push_back(add("long"));
    bare.push_back(decode_ms(*mesh, packed));
  }
  return {bench::median(first), bench::median(after), bench::median(bare)};
}

/// A clip of 100 keyframes of 100,000 vertices each, and one key more to add.
double transaction_vs_copy(const model::MeshPtr& mesh) {
  model::Clip clip;
  clip.name = "default";
  for (int i = 0; i < kKeys; ++i) {
    clip.times_s.push_back(i);
    clip.keyframes.push_back({i + 1, {}, {}, make_key(*mesh, wave(0.01 * i))});
  }
  const auto model = std::make_shared<const model::Model>(model::Model{mesh, clip.keyframes.front().vertices, {}, {}, {}});
  model::Actor actor{"a", "mesh", model, {}, {std::make_shared<const model::Clip>(clip)}, {}};
  model::Scene scene;
  scene.next_keyframe = kKeys + 1;
  scene.actors.push_back(std::make_shared<const model::Actor>(std::move(actor)));
  const model::VertexKeyPtr added = make_key(*mesh, wave(3));
  std::vector<float> copy(added->positions().size());
  const auto race = bench::measure(
      {},
      [&] {
        stage::Transaction transaction(scene);
        const model::KeyframeId id = transaction.new_keyframe_id();
        transaction.apply(stage::SetKeyframe{"a", "default", id, stage::TimedKeyframe{50.5, {id, {}, {}, added}}});
        if (transaction.scene().actors.front()->clips.front()->keyframes[51].vertices != added) bench::give_up("not added");
        bench::keep(&transaction);
      },
      [&] {
        std::memcpy(copy.data(), added->positions().data(), copy.size() * sizeof(float));
        bench::keep(copy.data());
      });
  std::printf("in memory, clip of 100 x %zu vertices: the edit %.1f us, a copy of one keyframe's positions %.1f us\n",
              kVertices, race.ns(0) / 1e3, race.ns(1) / 1e3);
  return race.ratio(0, 1);
}

}  // namespace

int main() {
  const model::MeshPtr mesh = make_mesh();
  const OverLoopback loopback = measure_over_loopback(mesh);
  std::printf(
      "keyframe.add of %zu vertices as base64, medians: to an empty clip %.1f ms, to one of 100 keyframes %.1f ms; "
      "base64, normals and hash alone %.1f ms\n",
      kVertices, loopback.first_ms, loopback.after_100_ms, loopback.bare_ms);
  const double edit = transaction_vs_copy(mesh);
  return bench::report({{"keyframe_add_to_100_keys_vs_first", loopback.after_100_ms / loopback.first_ms, 1.3},
                        {"keyframe_add_vs_bare_decoding", loopback.after_100_ms / loopback.bare_ms, 4.0},
                        {"keyframe_add_edit_vs_copy_of_one_key", edit, 0.25}})
             ? 0
             : 1;
}
