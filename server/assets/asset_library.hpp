#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "server/assets/asset_folder.hpp"
#include "server/assets/asset_root.hpp"
#include "server/assets/gltf_progress.hpp"
#include "server/assets/obj_sequence.hpp"
#include "server/base/limits.hpp"
#include "server/base/result.hpp"
#include "server/model/model.hpp"
#include "server/model/model_blob.hpp"

namespace tweend::assets {

/// What is asked of an import.
struct ImportOptions {
  double fps = 24.0;          ///< of an OBJ sequence: how many frames make a second
  ImportProgress progress{};  ///< may be empty
};

struct AssetInfo {
  std::string name;         ///< the path under its assets folder
  std::string type;         ///< "obj", "obj_sequence", "glb" or "gltf"
  std::uint64_t bytes = 0;  ///< of the file, or of all a sequence's .obj files
};

/// The assets of all assets folders, of which an earlier one hides a later one's asset of the same name.
///
/// An asset is a .glb or .gltf file, a .obj file, or a folder of NAME_000000.obj files: a sequence, in which the number is the
/// frame.
/// A sequence's files are not listed each, but may be imported each. Files named so in an assets folder itself make
/// no sequence, which would have no name. Dot files and what lies under dot folders are not listed.
///
/// Materials and textures that an OBJ file names belong to its asset: see load_obj_materials. So do the buffers and images of a
/// glTF file: see read_gltf.
///
/// Nothing is kept between calls. Const methods are safe from any thread; they block on the disk and, for import,
/// compute for a good while: call them from a worker.
class AssetLibrary {
 public:
  AssetLibrary(std::vector<AssetRoot> roots, Limits limits);

  /// Sorted by name. Symbolic links to folders are listed where they are sequences, never walked. Folders that can't
  /// be read, and those deeper than 16, are passed over.
  /// @return BadAsset if an assets folder itself can't be read
  [[nodiscard]] Result<std::vector<AssetInfo>> list() const;

  /// Reads the asset anew. What its files name that isn't there is told by the model's warnings.
  /// @return NotFound; BadAsset naming file and line, of a glTF file the JSON pointer; Limit (Limits::asset_bytes,
  ///         texture_pixels, vertices_per_actor, keyframes_per_clip …); Unavailable if memory runs out
  [[nodiscard]] Result<model::ImportedModel> import(std::string_view name, const ImportOptions& options = {}) const;

  /// The first half of import, which alone looks at files that anybody may have made: what it comes to is flat and can be
  /// checked in one pass.
  /// @return as import
  [[nodiscard]] Result<model::ModelBlob> import_blob(std::string_view name, const ImportOptions& options = {}) const;

  /// Where new assets are saved: the first assets folder.
  /// @return Unavailable where there is none
  [[nodiscard]] Result<const AssetRoot*> first_folder() const;

 private:
  [[nodiscard]] Result<model::ImportedModel> find_and_import(std::string_view name, const ImportOptions& options = {}) const;
  [[nodiscard]] Result<std::optional<model::ImportedModel>> import_from(const AssetRoot& root, std::string_view name,
                                                                        const ImportOptions& options) const;
  [[nodiscard]] Result<model::ImportedModel> import_gltf(const AssetRoot& root, std::string_view name,
                                                         const ImportOptions& options) const;
  [[nodiscard]] Result<ObjModel> import_file(const AssetRoot& root, std::string_view name) const;
  [[nodiscard]] Result<ObjModel> import_sequence(const AssetRoot& root, std::string_view name,
                                                 std::vector<SequenceFile> members, const ImportProgress& progress) const;
  /// @param bytes_left  for the side files of `files`
  [[nodiscard]] Result<ObjModel> build(const AssetRoot& root, std::string_view name, std::span<const ObjFile> files,
                                       std::span<const std::int64_t> frames, std::size_t bytes_left) const;

  std::vector<AssetRoot> roots_;
  Limits limits_;
};

}  // namespace tweend::assets
