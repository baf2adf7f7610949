#include "server/assets/asset_library.hpp"

#include <fmt/format.h>

#include <cstddef>
#include <map>
#include <new>
#include <utility>

#include "server/assets/asset_name.hpp"
#include "server/assets/gltf_reader.hpp"
#include "server/assets/obj_materials.hpp"
#include "server/assets/obj_reader.hpp"

namespace tweend::assets {
namespace {

constexpr int kMaxDepth = 16;
constexpr std::string_view kExpected = "expected a .glb, .gltf or .obj file, or a folder of NAME_000000.obj files";

using Found = std::map<std::string, AssetInfo, std::less<>>;

void add(Found& found, std::string name, std::string type, std::uint64_t bytes) {
  AssetInfo info{name, std::move(type), bytes};
  found.try_emplace(std::move(name), std::move(info));  // an earlier folder's asset stays
}

/// Adds what is in the folder `name` and, unless it's reached by a link (which may lead back up), below it.
Status collect(const AssetRoot& root, const std::string& name, bool link, int depth, Found& found) {
  TWEEND_ASSIGN(std::vector<AssetEntry> entries, root.list_folder(name));
  const AssetFolder folder = sort_entries(name, std::move(entries));
  if (name.empty()) {
    for (const SequenceFile& file : folder.members) add(found, file.name, "obj", file.bytes);
  } else if (!folder.members.empty()) {
    add(found, name, "obj_sequence", total_bytes(folder.members));
  }
  if (link) return {};
  for (const AssetEntry& file : folder.objs) add(found, join_name(name, file.name), "obj", file.bytes);
  for (const AssetEntry& file : folder.gltfs) {
    add(found, join_name(name, file.name), has_extension(file.name, ".glb") ? "glb" : "gltf", file.bytes);
  }
  if (depth == kMaxDepth) return {};
  for (const AssetEntry& subfolder : folder.subfolders) {
    // What can't be read, or went away meanwhile, must not hide everything else.
    static_cast<void>(collect(root, join_name(name, subfolder.name), subfolder.link, depth + 1, found));
  }
  return {};
}

Error too_many_bytes(std::string_view name, std::size_t max_bytes) {
  return fail(ErrorCode::Limit,
              fmt::format("{}: expected at most {} bytes of files, found more", quoted_name(name), max_bytes));
}

Error no_memory(std::string_view name) {
  return fail(ErrorCode::Unavailable, fmt::format("there is not enough memory to import {}", quoted_name(name)));
}

/// The one clip of an OBJ file or sequence, a keyframe for each file.
model::ImportedModel imported(ObjModel obj, const ImportOptions& options) {
  model::Clip clip;
  clip.name = "default";
  for (const ObjKey& key : obj.keys) {
    clip.times_s.push_back(key.frame / options.fps);
    clip.keyframes.push_back({0, {}, {}, key.vertices, nullptr});
  }
  auto model = std::make_shared<const model::Model>(model::Model{std::move(obj.mesh), obj.keys.front().vertices, {}, {}, {}});
  return {std::move(obj.source), std::move(model), {std::move(clip)}, std::move(obj.warnings)};
}

}  // namespace

AssetLibrary::AssetLibrary(std::vector<AssetRoot> roots, Limits limits) : roots_(std::move(roots)), limits_(limits) {}

Result<std::vector<AssetInfo>> AssetLibrary::list() const {
  Found found;
  for (const AssetRoot& root : roots_) TWEEND_TRY(collect(root, "", false, 0, found));
  std::vector<AssetInfo> assets;
  assets.reserve(found.size());
  for (auto& [name, info] : found) assets.push_back(std::move(info));
  return assets;
}

Result<const AssetRoot*> AssetLibrary::first_folder() const {
  if (!roots_.empty()) return &roots_.front();
  return fail(ErrorCode::Unavailable, "there is no assets folder to save in: start the server with --assets DIR");
}

Result<model::ImportedModel> AssetLibrary::import(std::string_view name, const ImportOptions& options) const {
  TWEEND_ASSIGN(const model::ModelBlob blob, import_blob(name, options));
  try {
    auto imported = model::read_model_blob(blob.bytes);
    if (!imported) return fail(imported.error().code, fmt::format("{}: {}", quoted_name(name), imported.error().message));
    if (options.progress) options.progress(1.0);
    return imported;
  } catch (const std::bad_alloc&) {
    return no_memory(name);
  }
}

Result<model::ModelBlob> AssetLibrary::import_blob(std::string_view name, const ImportOptions& options) const {
  try {
    if (options.progress) options.progress(0.0);
    TWEEND_ASSIGN(const model::ImportedModel imported, find_and_import(name, options));
    return model::write_model_blob(imported);
  } catch (const std::bad_alloc&) {
    return no_memory(name);
  }
}

Result<model::ImportedModel> AssetLibrary::find_and_import(std::string_view name, const ImportOptions& options) const {
  bool other_folder = false;  // a folder of that name that is no sequence: a later root may hold one that is
  for (const AssetRoot& root : roots_) {
    auto imported = import_from(root, name, options);
    if (!imported && imported.error().code == ErrorCode::NotFound) continue;
    if (!imported) return imported.error();
    if (imported->has_value()) return std::move(**imported);
    other_folder = true;
  }
  if (other_folder)
    return fail(ErrorCode::BadAsset, fmt::format("{}, found {} to be a folder without any", kExpected, quoted_name(name)));
  return fail(ErrorCode::NotFound, fmt::format("there is no asset {}: asset.list tells those there are", quoted_name(name)));
}

/// Nothing where `name` is a folder, but not a sequence.
Result<std::optional<model::ImportedModel>> AssetLibrary::import_from(const AssetRoot& root, std::string_view name,
                                                                      const ImportOptions& options) const {
  TWEEND_ASSIGN(const AssetEntry entry, root.find(name));
  if (entry.directory) {
    TWEEND_ASSIGN(std::vector<AssetEntry> entries, root.list_folder(name));
    AssetFolder folder = sort_entries(name, std::move(entries));
    if (folder.members.empty()) return std::optional<model::ImportedModel>();
    TWEEND_ASSIGN(ObjModel sequence, import_sequence(root, name, std::move(folder.members), options.progress));
    return std::optional(imported(std::move(sequence), options));
  }
  if (is_gltf_name(name)) {
    TWEEND_ASSIGN(model::ImportedModel model, import_gltf(root, name, options));
    return std::optional(std::move(model));
  }
  if (!has_extension(name, ".obj")) return fail(ErrorCode::BadAsset, fmt::format("{}, found {}", kExpected, quoted_name(name)));
  TWEEND_ASSIGN(ObjModel model, import_file(root, name));
  return std::optional(imported(std::move(model), options));
}

Result<model::ImportedModel> AssetLibrary::import_gltf(const AssetRoot& root, std::string_view name,
                                                       const ImportOptions& options) const {
  TWEEND_ASSIGN(const std::string bytes, root.read_file(name, limits_.asset_bytes));
  const auto read_side_file = [&root](std::string_view side, std::size_t most) { return root.read_file(side, most); };
  return read_gltf(bytes, std::string(name), read_side_file, limits_.asset_bytes - bytes.size(), limits_, options.progress);
}

Result<ObjModel> AssetLibrary::import_file(const AssetRoot& root, std::string_view name) const {
  TWEEND_ASSIGN(const std::string text, root.read_file(name, limits_.asset_bytes));
  TWEEND_ASSIGN(const ObjFile file, read_obj(text, std::string(name), limits_));
  constexpr std::int64_t kFrame = 0;
  return build(root, name, {&file, 1}, {&kFrame, 1}, limits_.asset_bytes - text.size());
}

Result<ObjModel> AssetLibrary::import_sequence(const AssetRoot& root, std::string_view name, std::vector<SequenceFile> members,
                                               const ImportProgress& progress) const {
  TWEEND_ASSIGN(members, order_sequence(std::move(members)));
  if (total_bytes(members) > limits_.asset_bytes) return too_many_bytes(name, limits_.asset_bytes);
  if (members.size() > limits_.keyframes_per_clip) {
    return fail(ErrorCode::Limit, fmt::format("{}: expected at most {} files, found {}", quoted_name(name),
                                              limits_.keyframes_per_clip, members.size()));
  }
  std::vector<ObjFile> files;
  std::vector<std::int64_t> frames;
  std::size_t bytes_left = limits_.asset_bytes;
  for (const SequenceFile& member : members) {
    // The listing's lengths may be old by now.
    TWEEND_ASSIGN(const std::string text, root.read_file(member.name, bytes_left));
    bytes_left -= text.size();
    TWEEND_ASSIGN(ObjFile file, read_obj(text, member.name, limits_));
    files.push_back(std::move(file));
    frames.push_back(member.frame);
    if (progress) progress(static_cast<double>(files.size()) / static_cast<double>(members.size() + 1));
  }
  return build(root, name, files, frames, bytes_left);
}

Result<ObjModel> AssetLibrary::build(const AssetRoot& root, std::string_view name, std::span<const ObjFile> files,
                                     std::span<const std::int64_t> frames, std::size_t bytes_left) const {
  TWEEND_ASSIGN(ObjMaterials found, load_obj_materials(root, files.front(), bytes_left, limits_));
  TWEEND_ASSIGN(ObjModel model, build_obj_model(std::string(name), files, frames, limits_, found.materials));
  model.warnings = std::move(found.warnings);
  return model;
}

}  // namespace tweend::assets
