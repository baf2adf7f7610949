#include "server/commands/export_commands.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <utility>
#include <vector>

#include "server/assets/asset_name.hpp"
#include "server/assets/glb_writer.hpp"
#include "server/assets/obj_writer.hpp"
#include "server/commands/command_table.hpp"

namespace tweend::commands {

enum class ExportFormat : std::uint8_t { Glb, ObjSequence };

}  // namespace tweend::commands

template <>
struct tweend::protocol::EnumNames<tweend::commands::ExportFormat> {
  static constexpr std::array<std::string_view, 2> kNames{"glb", "obj_sequence"};
};

namespace tweend::commands {
namespace {

constexpr const char* kNamePath = "params.name";
constexpr std::size_t kLongestPart = 64;

struct ExportParams {
  static constexpr std::string_view kName = "AssetExportParams";
  std::optional<std::string> scene;
  std::optional<std::string> actor;
  ExportFormat format = ExportFormat::Glb;
  std::string name;
  static void describe(FieldList<ExportParams>& f) {
    using T = ExportParams;
    add_scene_field(f);
    add_actor_field(f);
    f.add<&T::format>("format", "glb: model and all clips; obj_sequence: the player's clip, a file for each keyframe.");
    f.add<&T::name>("name", "Of the new asset under the first assets folder: a file NAME.glb, or the sequence's folder.");
  }
};

struct ExportResult {
  static constexpr std::string_view kName = "AssetExport";
  std::string name;
  std::uint64_t bytes = 0;
  static void describe(FieldList<ExportResult>& f) {
    f.add<&ExportResult::name>("name", "Of the new asset.");
    f.add<&ExportResult::bytes>("bytes", "Of all its files.");
  }
};

bool is_plain(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '.' || c == '-';
}

std::vector<std::string_view> parts_of(std::string_view name) {
  std::vector<std::string_view> parts;
  for (;;) {
    const std::size_t slash = name.find('/');
    parts.push_back(name.substr(0, slash));
    if (slash == std::string_view::npos) return parts;
    name.remove_prefix(slash + 1);
  }
}

Error bad_name(const std::string& name, std::string_view expected) {
  return fail(ErrorCode::InvalidParams, fmt::format("expected {}, found {}", expected, assets::quoted_name(name)), kNamePath);
}

/// An error of a name or a place: it is `name` that is to be changed.
Error about_name(Error error) {
  if (error.path.empty() && error.code != ErrorCode::Unavailable) error.path = kNamePath;
  return error;
}

/// Cheap refusals first: nothing is made for a name that is taken.
Result<const assets::AssetRoot*> check_place(const ExportParams& p, const Services& services) {
  TWEEND_TRY(check_export_name(p.name, p.format == ExportFormat::Glb));
  TWEEND_ASSIGN(const assets::AssetRoot* const folder, services.assets.first_folder());
  const auto there = folder->find(p.name);
  if (there || there.error().code != ErrorCode::NotFound) {
    return fail(ErrorCode::Conflict,
                fmt::format("expected a new name under the assets folder, found that there is a {} already: choose another, or "
                            "remove that one",
                            assets::quoted_name(p.name)),
                kNamePath);
  }
  return folder;
}

Result<std::uint64_t> save_glb(const model::Actor& actor, const ExportParams& p, const assets::AssetRoot& folder,
                               const Limits& limits) {
  TWEEND_ASSIGN(const std::string file, assets::write_glb(actor, limits));
  if (const Status saved = folder.save_file(p.name, file); !saved) return about_name(saved.error());
  return file.size();
}

Result<std::uint64_t> save_sequence(const model::Actor& actor, const model::ClipPtr& clip, const ExportParams& p,
                                    const assets::AssetRoot& folder, const Limits& limits) {
  const std::string_view prefix = parts_of(p.name).back();
  TWEEND_ASSIGN(const std::vector<assets::NewFile> files, assets::write_obj_sequence(actor, clip, prefix, limits));
  if (const Status saved = folder.save_folder(p.name, files); !saved) return about_name(saved.error());
  std::uint64_t bytes = 0;
  for (const assets::NewFile& file : files) bytes += file.bytes.size();
  return bytes;
}

Result<ExportResult> export_asset(const ExportParams& p, const QueryContext& context) {
  const std::string scene = scene_or_main(p.scene);
  const stage::SceneViewPtr view = context.view->find(scene);
  if (!view) return no_such_scene(scene);
  TWEEND_ASSIGN(const model::ActorPtr actor, find_actor(*view->scene, p.actor));
  TWEEND_ASSIGN(const assets::AssetRoot* const folder, check_place(p, context.services));
  const Limits& limits = context.services.limits;
  if (p.format == ExportFormat::Glb) {
    TWEEND_ASSIGN(const std::uint64_t bytes, save_glb(*actor, p, *folder, limits));
    return ExportResult{p.name, bytes};
  }
  TWEEND_ASSIGN(const model::ClipPtr clip, find_clip(*actor, std::nullopt, view));
  TWEEND_ASSIGN(const std::uint64_t bytes, save_sequence(*actor, clip, p, *folder, limits));
  return ExportResult{p.name, bytes};
}

}  // namespace

Status check_new_name(const std::string& name) {
  if (!assets::is_clean_name(name)) {
    return fail(ErrorCode::NotFound,
                fmt::format("expected a name under the assets folder, found {}", assets::quoted_name(name)), kNamePath);
  }
  for (const std::string_view part : parts_of(name)) {
    if (part.front() == '.' || part.size() > kLongestPart || !std::ranges::all_of(part, is_plain)) {
      return bad_name(name, "1 to 64 of A-Z a-z 0-9 _ . - between each '/', not starting with a dot");
    }
  }
  return {};
}

Status check_export_name(const std::string& name, bool is_glb) {
  TWEEND_TRY(check_new_name(name));
  if (is_glb && !name.ends_with(".glb")) return bad_name(name, "a name that ends with .glb");
  const auto ends = [&](std::string_view extension) { return assets::has_extension(name, extension); };
  if (!is_glb && (ends(".obj") || ends(".glb") || ends(".gltf"))) {
    return bad_name(name, "the name of a folder, without a file's ending");
  }
  return {};
}

Result<std::string> exported_glb(const std::string& scene, const std::string& actor, const QueryContext& context) {
  const stage::SceneViewPtr view = context.view->find(scene);
  if (!view) return no_such_scene(scene);
  TWEEND_ASSIGN(const model::ActorPtr found, find_actor(*view->scene, actor));
  return assets::write_glb(*found, context.services.limits);
}

void add_export_commands(std::vector<Command>& t) {
  t.push_back(query_command<&export_asset>("asset.export", Role::Admin, "Save an actor as a new asset.", Shape::WorkerQuery));
}

}  // namespace tweend::commands
