#pragma once

#include <cstddef>
#include <functional>
#include <initializer_list>
#include <iosfwd>
#include <string>

#include "clients/cli/json.hpp"

namespace tweend::cli {

/// What may be written for an argument, and the JSON that it means.
struct ValueKind {
  /// For the help and the completion: `a|b` lists the words, ACTOR, ASSET, CLIP, SCENE and METHOD name things of the server,
  /// FILE is completed as one or as a folder, anything else is only shown.
  std::string shape;
  std::function<Json(const std::string& text)> read;  ///< throws Usage, saying what was expected
};

[[nodiscard]] ValueKind text(std::string shape);
/// A finite number.
[[nodiscard]] ValueKind number(std::string shape = "NUMBER");
/// A finite number that is not negative.
[[nodiscard]] ValueKind seconds();
[[nodiscard]] ValueKind integer(std::string shape = "N");
/// An integer that is not negative.
[[nodiscard]] ValueKind count(std::string shape = "N");
/// Numbers separated by commas, as many as one of `sizes` says.
[[nodiscard]] ValueKind numbers(std::string shape, std::initializer_list<std::size_t> sizes);
/// Any count of numbers separated by commas.
[[nodiscard]] ValueKind any_numbers(std::string shape);
/// Integers separated by commas.
[[nodiscard]] ValueKind integers(std::string shape);
/// Texts separated by commas.
[[nodiscard]] ValueKind texts(std::string shape);
/// One of the words of `shape`, `a|b|c`.
[[nodiscard]] ValueKind word(const std::string& shape);
/// The same, and the word `none` for null, which clears a setting.
[[nodiscard]] ValueKind or_none(const ValueKind& kind);
/// The JSON in a file; `-` is `in`.
[[nodiscard]] ValueKind json_file(std::istream& in);
/// JSON as it stands, or with `@` before it the JSON in a file; `@-` is `in`.
[[nodiscard]] ValueKind json_or_file(std::istream& in);
/// Three numbers, or one for all three axes.
[[nodiscard]] ValueKind scale();
/// An angle in radians about +Y, as a quaternion.
[[nodiscard]] ValueKind turn_y();
/// `AZIMUTH,ELEVATION[,DISTANCE]` as the object of camera.set.
[[nodiscard]] ValueKind orbit();

/// `WIDTHxHEIGHT` as {width, height}.
[[nodiscard]] ValueKind size();

/// Reads the whole of a file, or of `in` for `-`. Throws Usage.
[[nodiscard]] std::string read_file(const std::string& path, std::istream& in);

}  // namespace tweend::cli
