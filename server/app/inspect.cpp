#include "server/app/inspect.hpp"

#include <fmt/format.h>

#include <iostream>
#include <utility>
#include <vector>

#include "server/app/asset_path.hpp"
#include "server/app/asset_report.hpp"
#include "server/assets/asset_library.hpp"
#include "server/assets/asset_name.hpp"

namespace tweend::app {

Result<std::string> inspect_asset(const InspectOptions& options) {
  TWEEND_ASSIGN(const AssetPath path, locate_asset(options.path));
  TWEEND_ASSIGN(assets::AssetRoot root, assets::AssetRoot::open(path.folder));
  std::string text = printable(path.name) + "\n";
  TWEEND_ASSIGN(const assets::AssetEntry entry, root.find(path.name));
  if (!entry.directory && assets::is_gltf_name(path.name)) {
    TWEEND_ASSIGN(const std::string bytes, root.read_file(path.name, options.limits.asset_bytes));
    TWEEND_ASSIGN(const assets::GltfFacts facts, assets::read_gltf_facts(bytes, path.name, options.limits));
    text += report_facts(facts);
  }
  std::vector<assets::AssetRoot> roots;
  roots.push_back(std::move(root));
  const assets::AssetLibrary library(std::move(roots), options.limits);
  TWEEND_ASSIGN(const model::ImportedModel imported, library.import(path.name));
  return text + report_model(imported);
}

int inspect(const InspectOptions& options) {
  const Result<std::string> text = inspect_asset(options);
  if (text) {
    std::cout << *text;
    return 0;
  }
  std::cerr << "tweend: " << printable(text.error().message) << '\n';
  return 1;
}

}  // namespace tweend::app
