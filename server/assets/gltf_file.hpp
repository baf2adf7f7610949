#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "server/assets/json_document.hpp"
#include "server/base/limits.hpp"
#include "server/base/result.hpp"

namespace tweend::assets {

/// A glTF 2.0 file whose JSON has been read, and nothing that the JSON refers to. Borrows the file's bytes.
class GltfFile {
 public:
  /// @param bytes  of the whole file, .glb or .gltf; must outlive this
  /// @return BadAsset where the container or the JSON is damaged, for another version than 2, or naming a required extension
  ///         that this reader doesn't know
  [[nodiscard]] static Result<GltfFile> open(std::string_view bytes, std::string name, const Limits& limits);

  [[nodiscard]] const std::string& name() const noexcept { return json_.name(); }
  [[nodiscard]] JsonNode root() const noexcept { return json_.root(); }
  /// The binary chunk of a .glb.
  [[nodiscard]] const std::optional<std::string_view>& bin() const noexcept { return bin_; }

  /// How many `nodes`, `accessors` … there are.
  [[nodiscard]] std::size_t count(std::string_view array) const noexcept;
  /// The object in the root's `array` that `reference` is the index of.
  [[nodiscard]] Result<JsonNode> refer(const JsonNode& reference, std::string_view array) const;
  /// Whether `extensionsUsed` or `extensionsRequired` name it.
  [[nodiscard]] bool uses(std::string_view extension) const;

 private:
  explicit GltfFile(JsonDocument json) : json_(std::move(json)) {}
  [[nodiscard]] Status check_arrays() const;
  [[nodiscard]] Status check_version() const;
  [[nodiscard]] Status check_extensions() const;

  JsonDocument json_;
  std::optional<std::string_view> bin_;
};

/// `node`'s extension of that name, if it has it.
[[nodiscard]] std::optional<JsonNode> find_extension(const JsonNode& node, std::string_view extension);

}  // namespace tweend::assets
