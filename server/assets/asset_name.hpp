#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace tweend::assets {

/// Whether `name` may be looked up under an assets folder: UTF-8, components parted by single '/', none of them
/// empty, "." or "..", no control characters and no backslash (it would part components elsewhere).
/// A first filter that gives clear answers; what keeps a look-up inside is open_beneath.
[[nodiscard]] bool is_clean_name(std::string_view name) noexcept;

/// Whether `name` ends in `extension` (lower case, with its dot), in whatever case.
[[nodiscard]] bool has_extension(std::string_view name, std::string_view extension) noexcept;

/// Whether it is that of a glTF file: .glb or .gltf.
[[nodiscard]] bool is_gltf_name(std::string_view name) noexcept;

/// `folder`/`name`, or `name` where the folder is "" (the root).
[[nodiscard]] std::string join_name(std::string_view folder, std::string_view name);

/// What `reference` names, as a file in `folder` ("": the root) writes it: '\\' parts components like '/', and empty
/// ones, "." and ".." are followed.
/// @return a clean name; nothing where it is absolute (also with a drive's letter), leaves the root, or can't be clean
[[nodiscard]] std::optional<std::string> resolve_name(std::string_view folder, std::string_view reference);

/// `name` in quotation marks for a message, cut at a character's end if it's long.
[[nodiscard]] std::string quoted_name(std::string_view name);

}  // namespace tweend::assets
