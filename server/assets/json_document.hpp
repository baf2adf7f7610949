#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "server/base/limits.hpp"
#include "server/base/result.hpp"

namespace tweend::assets {

enum class JsonKind : std::uint8_t { Null, Boolean, Number, Text, Array, Object };

class JsonNode;

/// The JSON of a file, read strictly: UTF-8, names that are used once in their object, nothing behind the value, nested no
/// deeper than Limits::json_depth. Immutable; its nodes point into it.
class JsonDocument {
 public:
  /// @param name  of the file, as messages call it
  /// @return BadAsset naming the file and where in the text it stops being such JSON; Limit for more than 4 million values
  [[nodiscard]] static Result<JsonDocument> parse(std::string_view text, std::string name, const Limits& limits);

  [[nodiscard]] JsonNode root() const noexcept;
  [[nodiscard]] const std::string& name() const noexcept { return name_; }

 private:
  friend class JsonNode;
  friend class JsonBuilder;

  /// Values of one array or object stand side by side. A value holds no more than it must: a small file may have many.
  struct Value {
    JsonKind kind = JsonKind::Null;
    std::uint32_t parent = 0;  ///< of the root: itself
    std::uint32_t key_at = 0;  ///< in text_; of an object's members
    std::uint32_t key_bytes = 0;
    std::uint32_t first = 0;  ///< the first child; of a text: where it stands in text_
    std::uint32_t count = 0;  ///< children; bytes of a text
    double number = 0.0;      ///< of a boolean: 0 or 1
  };

  JsonDocument() = default;

  std::string name_;
  std::string text_;  ///< all keys and texts
  std::vector<Value> values_;
};

/// A value of a document, which has to outlive it. What is asked of it answers with errors that name the file and the value's
/// JSON pointer (RFC 6901): `"arm.glb" /accessors/0/count: expected …, found …`. Cheap to copy.
class JsonNode {
 public:
  [[nodiscard]] JsonKind kind() const noexcept { return value().kind; }
  /// Items of an array, members of an object; else 0.
  [[nodiscard]] std::size_t size() const noexcept;
  /// Precondition: i < size().
  [[nodiscard]] JsonNode at(std::size_t i) const noexcept {
    return {*document_, value().first + static_cast<std::uint32_t>(i)};
  }
  /// An object's member of that name, if there is one.
  [[nodiscard]] std::optional<JsonNode> find(std::string_view key) const noexcept;
  /// The same, with an error where there is none.
  [[nodiscard]] Result<JsonNode> get(std::string_view key) const;
  /// Which of its parent's items or members it is.
  [[nodiscard]] std::size_t position() const noexcept { return index_ - document_->values_[value().parent].first; }
  /// The name by which an object knows this value; of others "".
  [[nodiscard]] std::string_view key() const noexcept;

  [[nodiscard]] Result<std::string_view> text() const;
  [[nodiscard]] Result<double> number() const;
  [[nodiscard]] Result<bool> boolean() const;
  /// A whole number within [least, most]; most is at most 2^53.
  [[nodiscard]] Result<std::size_t> whole(std::size_t least, std::size_t most) const;
  /// An index into `count` things called `what`, e.g. "nodes".
  [[nodiscard]] Result<std::size_t> index(std::size_t count, std::string_view what) const;
  /// An array of `count` numbers that floats can hold.
  [[nodiscard]] Result<std::vector<float>> floats(std::size_t count) const;
  /// Success for an array of at least `least` items.
  [[nodiscard]] Status expect_array(std::size_t least = 0) const;
  [[nodiscard]] Status expect_object() const;

  // Members that may be left out:
  [[nodiscard]] Result<std::size_t> whole_or(std::string_view key, std::size_t fallback, std::size_t least,
                                             std::size_t most) const;
  [[nodiscard]] Result<double> number_or(std::string_view key, double fallback) const;
  [[nodiscard]] Result<bool> boolean_or(std::string_view key, bool fallback) const;
  /// The text of the member; "" where there is none.
  [[nodiscard]] Result<std::string_view> text_or_empty(std::string_view key) const;

  /// Where it stands, e.g. "/accessors/0/count"; "" is the root.
  [[nodiscard]] std::string pointer() const;
  /// `"arm.glb" /accessors/0/count`, for messages.
  [[nodiscard]] std::string place() const;
  /// BadAsset about this value: its place, then `message`.
  [[nodiscard]] Error error(std::string_view message, ErrorCode code = ErrorCode::BadAsset) const;
  /// BadAsset about this value: "expected {expected}, found {what it is}".
  [[nodiscard]] Error expected(std::string_view expected) const;

 private:
  friend class JsonDocument;
  JsonNode(const JsonDocument& document, std::uint32_t index) noexcept : document_(&document), index_(index) {}
  [[nodiscard]] const JsonDocument::Value& value() const noexcept { return document_->values_[index_]; }
  [[nodiscard]] std::string describe() const;

  const JsonDocument* document_;
  std::uint32_t index_;
};

}  // namespace tweend::assets
