// How long a glTF file takes to become a model against three.js's GLTFLoader. That one looks at buffers where they lie and
// trusts them; an import here checks every number, hashes it, and hands it over as a model blob, for which it may take four
// times as long. Both read the demo's walker (21 joints, three clips, two morph targets) from a warm cache.

#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "bench/support/ratio.hpp"
#include "bench/support/server_process.hpp"
#include "bench/support/three_process.hpp"
#include "server/assets/asset_library.hpp"

namespace {

using namespace tweend;

constexpr const char* kAsset = "walker.glb";
constexpr int kRounds = 21;

assets::AssetLibrary demo_assets() {
  auto root = assets::AssetRoot::open(TWEEND_DEMO_ASSETS);
  if (!root) bench::give_up(root.error().message);
  std::vector<assets::AssetRoot> roots;
  roots.push_back(std::move(*root));
  return {std::move(roots), Limits{}};
}

model::ImportedModel import_once(const assets::AssetLibrary& library) {
  auto imported = library.import(kAsset);
  if (!imported) bench::give_up(imported.error().message);
  return std::move(*imported);
}

double import_ms(const assets::AssetLibrary& library) {
  const auto start = std::chrono::steady_clock::now();
  bench::keep(import_once(library).model.get());
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

int main() {
  const assets::AssetLibrary library = demo_assets();
  const model::ImportedModel ours = import_once(library);
  std::printf("%s: %zu vertices, %zu triangles, %zu joints, %zu clips\n", kAsset, ours.model->vertex_count(),
              ours.model->mesh->triangle_count(), ours.model->joint_count(), ours.clips.size());
  if (!bench::ThreeProcess::is_installed()) {
    std::printf("three.js is not measured: expected Node, and three.js in bench/three; `./dev bench` installs it\n");
    return 0;
  }
  bench::ThreeProcess three("loader.mjs", std::string(TWEEND_DEMO_ASSETS) + "/" + kAsset);
  const std::vector<double> theirs = three.ask("show 0");
  if (theirs.at(0) != static_cast<double>(ours.model->vertex_count()) ||
      theirs.at(1) != static_cast<double>(ours.model->mesh->triangle_count()) ||
      theirs.at(3) != static_cast<double>(ours.clips.size())) {
    bench::give_up("three.js found another model in the file");
  }
  std::vector<double> own_ms, three_ms, ratios;
  static_cast<void>(three.ask("load 20"));  // until its compiler has seen it
  for (int round = 0; round < kRounds; ++round) {
    own_ms.push_back(import_ms(library));
    three_ms.push_back(three.ask("load 3").at(0));
    ratios.push_back(own_ms.back() / three_ms.back());
  }
  std::printf("tweend %.2f ms, checked, hashed and packed; three.js %.2f ms; medians\n", bench::median(own_ms),
              bench::median(three_ms));
  return bench::report({{"gltf_import_vs_three", bench::median(ratios), 4.0}}) ? 0 : 1;
}
