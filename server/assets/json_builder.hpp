#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "server/assets/json_document.hpp"

namespace tweend::assets {

/// Puts a document together from what a parser meets, in the order it is met. Each call answers whether to go on.
class JsonBuilder {
 public:
  JsonBuilder(JsonDocument& document, std::size_t most_deep) : document_(document), most_deep_(most_deep) {}

  bool scalar(JsonKind kind, double number = 0.0);
  bool text(std::string_view text);
  bool begin(JsonKind kind);
  bool key(std::string_view key);
  bool end();
  /// The whole document is there.
  void finish();
  bool refuse(ErrorCode code, std::string message);

  /// Why it was not to go on.
  [[nodiscard]] const std::optional<Error>& error() const noexcept { return error_; }

 private:
  bool add(JsonDocument::Value value);
  std::pair<std::uint32_t, std::uint32_t> keep(std::string_view text);
  /// Moves `value` to its place in the document, where its children learn whose they are.
  void settle(const JsonDocument::Value& value);
  [[nodiscard]] std::optional<std::string_view> repeated_key(std::size_t first) const;

  JsonDocument& document_;
  std::size_t most_deep_;
  std::vector<JsonDocument::Value> pending_;                    ///< whose parent isn't complete
  std::vector<std::size_t> open_;                               ///< places in pending_ of what isn't complete itself
  std::optional<std::pair<std::uint32_t, std::uint32_t>> key_;  ///< of the next value
  std::optional<Error> error_;
};

}  // namespace tweend::assets
