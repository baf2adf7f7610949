#include "server/commands/command_table.hpp"

namespace tweend::commands {
namespace {

struct AssetListParams {
  static constexpr std::string_view kName = "AssetListParams";
  static void describe(FieldList<AssetListParams>&) {}
};

struct AssetEntry {
  static constexpr std::string_view kName = "Asset";
  std::string name;
  std::string type;
  std::uint64_t bytes = 0;
  static void describe(FieldList<AssetEntry>& f) {
    f.add<&AssetEntry::name>("name", "Its path under the assets folder.");
    f.add<&AssetEntry::type>("type", "glb, gltf, obj or obj_sequence.");
    f.add<&AssetEntry::bytes>("bytes", "Size of the file; of a sequence, its .obj files together.");
  }
};

struct AssetListResult {
  static constexpr std::string_view kName = "AssetList";
  std::vector<AssetEntry> assets;
  static void describe(FieldList<AssetListResult>& f) { f.add<&AssetListResult::assets>("assets", "Sorted by name."); }
};

Result<AssetListResult> list_assets(const AssetListParams&, const QueryContext& context) {
  TWEEND_ASSIGN(const std::vector<assets::AssetInfo> found, context.services.assets.list());
  AssetListResult result;
  for (const assets::AssetInfo& a : found) result.assets.push_back({a.name, a.type, a.bytes});
  return result;
}

}  // namespace

void add_asset_commands(std::vector<Command>& t) {
  t.push_back(query_command<&list_assets>("asset.list", Role::View, "The assets that actor.add can load.", Shape::WorkerQuery));
}

}  // namespace tweend::commands
