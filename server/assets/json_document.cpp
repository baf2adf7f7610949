#include "server/assets/json_document.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "server/assets/asset_name.hpp"
#include "server/assets/json_builder.hpp"
#include "server/assets/token.hpp"

namespace tweend::assets {
namespace {

/// nlohmann's sentence without its bracketed number; what it quotes may be half a character, and messages are UTF-8.
std::string reason(const char* what) {
  const std::string_view whole = what;
  const auto at = whole.find("] ");
  std::string text(at == std::string_view::npos ? whole : whole.substr(at + 2));
  std::replace_if(
      text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) >= 0x80 || c == '\0'; }, '?');
  return text;
}

/// What nlohmann-json's parser calls, which keeps no tree of its own and recurses into nothing.
class Events final : public nlohmann::json_sax<nlohmann::json> {
 public:
  explicit Events(JsonBuilder& builder) : builder_(builder) {}
  bool null() override { return builder_.scalar(JsonKind::Null); }
  bool boolean(bool value) override { return builder_.scalar(JsonKind::Boolean, value ? 1.0 : 0.0); }
  bool number_integer(number_integer_t value) override { return builder_.scalar(JsonKind::Number, static_cast<double>(value)); }
  bool number_unsigned(number_unsigned_t value) override {
    return builder_.scalar(JsonKind::Number, static_cast<double>(value));
  }
  bool number_float(number_float_t value, const string_t&) override { return builder_.scalar(JsonKind::Number, value); }
  bool string(string_t& value) override { return builder_.text(value); }
  bool binary(binary_t&) override { return false; }
  bool start_object(std::size_t) override { return builder_.begin(JsonKind::Object); }
  bool end_object() override { return builder_.end(); }
  bool start_array(std::size_t) override { return builder_.begin(JsonKind::Array); }
  bool end_array() override { return builder_.end(); }
  bool key(string_t& value) override { return builder_.key(value); }
  bool parse_error(std::size_t, const std::string&, const nlohmann::json::exception& e) override {
    return builder_.refuse(ErrorCode::BadAsset, "expected JSON, found: " + reason(e.what()));
  }

 private:
  JsonBuilder& builder_;
};

}  // namespace

Result<JsonDocument> JsonDocument::parse(std::string_view text, std::string name, const Limits& limits) {
  JsonDocument document;
  document.name_ = std::move(name);
  const auto refuse = [&](ErrorCode code, std::string_view message) {
    return fail(code, fmt::format("{}: {}", quoted_name(document.name_), message));
  };
  // nlohmann-json 3.11.2 takes a NUL for the end of the text.
  if (const auto nul = text.find('\0'); nul != std::string_view::npos) {
    return refuse(ErrorCode::BadAsset, fmt::format("expected JSON, found a NUL byte at position {} of it", nul));
  }
  if (text.size() > std::numeric_limits<std::uint32_t>::max()) {
    return refuse(ErrorCode::Limit, fmt::format("expected at most 4 GiB of JSON, found {} bytes", text.size()));
  }
  JsonBuilder builder(document, limits.json_depth);
  Events events(builder);
  if (!nlohmann::json::sax_parse(text, &events)) {
    const Error why = builder.error().value_or(fail(ErrorCode::BadAsset, "expected JSON, found something else"));
    return refuse(why.code, why.message);
  }
  builder.finish();
  return document;
}

JsonNode JsonDocument::root() const noexcept { return {*this, static_cast<std::uint32_t>(values_.size() - 1)}; }

std::size_t JsonNode::size() const noexcept {
  const bool has_children = kind() == JsonKind::Array || kind() == JsonKind::Object;
  return has_children ? value().count : 0;
}

std::string_view JsonNode::key() const noexcept {
  return std::string_view(document_->text_).substr(value().key_at, value().key_bytes);
}

std::optional<JsonNode> JsonNode::find(std::string_view key) const noexcept {
  if (kind() != JsonKind::Object) return std::nullopt;
  for (std::size_t i = 0; i < size(); ++i) {
    if (at(i).key() == key) return at(i);
  }
  return std::nullopt;
}

Result<JsonNode> JsonNode::get(std::string_view key) const {
  TWEEND_TRY(expect_object());
  if (const auto member = find(key)) return *member;
  return error(fmt::format("expected a member \"{}\", found none", key));
}

Result<std::string_view> JsonNode::text() const {
  if (kind() != JsonKind::Text) return expected("a text");
  return std::string_view(document_->text_).substr(value().first, value().count);
}

Result<double> JsonNode::number() const {
  if (kind() != JsonKind::Number) return expected("a number");
  return value().number;
}

Result<bool> JsonNode::boolean() const {
  if (kind() != JsonKind::Boolean) return expected("true or false");
  return value().number != 0.0;
}

Result<std::size_t> JsonNode::whole(std::size_t least, std::size_t most) const {
  const double n = value().number;
  const bool fits =
      kind() == JsonKind::Number && n == std::floor(n) && n >= static_cast<double>(least) && n <= static_cast<double>(most);
  if (!fits) return expected(fmt::format("a whole number from {} to {}", least, most));
  return static_cast<std::size_t>(n);
}

Result<std::size_t> JsonNode::index(std::size_t count, std::string_view what) const {
  const double n = value().number;
  const bool fits = kind() == JsonKind::Number && n == std::floor(n) && n >= 0.0 && n < static_cast<double>(count);
  if (!fits) return expected(fmt::format("the index of one of {} {}", count, what));
  return static_cast<std::size_t>(n);
}

Result<std::vector<float>> JsonNode::floats(std::size_t count) const {
  if (kind() != JsonKind::Array || size() != count) return expected(fmt::format("an array of {} numbers", count));
  std::vector<float> numbers(count);
  for (std::size_t i = 0; i < count; ++i) {
    TWEEND_ASSIGN(const double number, at(i).number());
    numbers[i] = static_cast<float>(number);
    if (!std::isfinite(numbers[i])) return at(i).expected("a number that a float can hold");
  }
  return numbers;
}

Status JsonNode::expect_array(std::size_t least) const {
  if (kind() == JsonKind::Array && size() >= least) return {};
  return expected(least == 0 ? "an array" : fmt::format("an array of at least {}", least));
}

Status JsonNode::expect_object() const {
  if (kind() == JsonKind::Object) return {};
  return expected("an object");
}

Result<std::size_t> JsonNode::whole_or(std::string_view key, std::size_t fallback, std::size_t least, std::size_t most) const {
  const auto member = find(key);
  if (!member) return fallback;
  return member->whole(least, most);
}

Result<double> JsonNode::number_or(std::string_view key, double fallback) const {
  const auto member = find(key);
  if (!member) return fallback;
  return member->number();
}

Result<bool> JsonNode::boolean_or(std::string_view key, bool fallback) const {
  const auto member = find(key);
  if (!member) return fallback;
  return member->boolean();
}

Result<std::string_view> JsonNode::text_or_empty(std::string_view key) const {
  const auto member = find(key);
  if (!member) return std::string_view();
  return member->text();
}

std::string JsonNode::pointer() const {
  std::vector<std::string> steps;
  for (std::uint32_t at = index_; document_->values_[at].parent != at; at = document_->values_[at].parent) {
    const JsonDocument::Value& above = document_->values_[document_->values_[at].parent];
    if (above.kind == JsonKind::Array) {
      steps.push_back(std::to_string(at - above.first));
      continue;
    }
    std::string step;
    for (const char c : JsonNode(*document_, at).key()) {
      step += c == '~' ? "~0" : c == '/' ? "~1" : std::string(1, c);
    }
    steps.push_back(std::move(step));
  }
  std::string pointer;
  for (auto step = steps.rbegin(); step != steps.rend(); ++step) pointer += '/' + *step;
  return pointer;
}

std::string JsonNode::place() const {
  const std::string at = pointer();
  return quoted_name(document_->name_) + (at.empty() ? "" : " ") + at;
}

Error JsonNode::error(std::string_view message, ErrorCode code) const {
  return fail(code, place() + ": " + std::string(message));
}

Error JsonNode::expected(std::string_view expected) const {
  return error(fmt::format("expected {}, found {}", expected, describe()));
}

std::string JsonNode::describe() const {
  switch (kind()) {
    case JsonKind::Null:
      return "null";
    case JsonKind::Boolean:
      return value().number != 0.0 ? "true" : "false";
    case JsonKind::Number:
      return fmt::format("{}", value().number);
    case JsonKind::Text:
      return quoted_name(std::string_view(document_->text_).substr(value().first, value().count));
    case JsonKind::Array:
      return fmt::format("an array of {}", size());
    case JsonKind::Object:
      return "an object";
  }
  return "something else";
}

}  // namespace tweend::assets
