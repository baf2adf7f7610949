#include "server/assets/json_builder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "server/assets/token.hpp"

namespace tweend::assets {
namespace {

constexpr std::size_t kMostValues = 4'000'000;
constexpr std::size_t kFewMembers = 8;

}  // namespace

bool JsonBuilder::refuse(ErrorCode code, std::string message) {
  if (!error_) error_ = fail(code, std::move(message));
  return false;
}

std::pair<std::uint32_t, std::uint32_t> JsonBuilder::keep(std::string_view text) {
  const std::pair<std::uint32_t, std::uint32_t> at{static_cast<std::uint32_t>(document_.text_.size()),
                                                   static_cast<std::uint32_t>(text.size())};
  document_.text_ += text;
  return at;
}

bool JsonBuilder::add(JsonDocument::Value value) {
  if (pending_.size() + document_.values_.size() >= kMostValues) {
    return refuse(ErrorCode::Limit, fmt::format("expected at most {} JSON values, found more", kMostValues));
  }
  if (key_) std::tie(value.key_at, value.key_bytes) = *std::exchange(key_, {});
  pending_.push_back(value);
  return true;
}

bool JsonBuilder::scalar(JsonKind kind, double number) {
  JsonDocument::Value value;
  value.kind = kind;
  value.number = number;
  return add(value);
}

bool JsonBuilder::text(std::string_view text) {
  JsonDocument::Value value;
  value.kind = JsonKind::Text;
  const auto [at, bytes] = keep(text);
  value.first = at;
  value.count = bytes;
  return add(value);
}

bool JsonBuilder::key(std::string_view key) {
  key_ = keep(key);
  return true;
}

bool JsonBuilder::begin(JsonKind kind) {
  if (open_.size() >= most_deep_) {
    return refuse(ErrorCode::BadAsset, fmt::format("expected JSON nested at most {} deep, found more", most_deep_));
  }
  JsonDocument::Value value;
  value.kind = kind;
  if (!add(value)) return false;
  open_.push_back(pending_.size() - 1);
  return true;
}

bool JsonBuilder::end() {
  const std::size_t at = open_.back();
  open_.pop_back();
  JsonDocument::Value& value = pending_[at];
  if (value.kind == JsonKind::Object) {
    if (const auto key = repeated_key(at + 1)) {
      return refuse(ErrorCode::BadAsset,
                    fmt::format("expected each name once in a JSON object, found {} twice", quoted_token(*key)));
    }
  }
  value.first = static_cast<std::uint32_t>(document_.values_.size());
  value.count = static_cast<std::uint32_t>(pending_.size() - at - 1);
  for (std::size_t i = at + 1; i < pending_.size(); ++i) settle(pending_[i]);
  pending_.resize(at + 1);
  return true;
}

void JsonBuilder::settle(const JsonDocument::Value& value) {
  const auto index = static_cast<std::uint32_t>(document_.values_.size());
  document_.values_.push_back(value);
  if (value.kind != JsonKind::Array && value.kind != JsonKind::Object) return;
  for (std::uint32_t i = 0; i < value.count; ++i) document_.values_[value.first + i].parent = index;
}

void JsonBuilder::finish() {
  settle(pending_.front());
  document_.values_.back().parent = static_cast<std::uint32_t>(document_.values_.size() - 1);
}

/// A key that two of the pending values from `first` on have.
std::optional<std::string_view> JsonBuilder::repeated_key(std::size_t first) const {
  const auto key_of = [&](const JsonDocument::Value& v) {
    return std::string_view(document_.text_).substr(v.key_at, v.key_bytes);
  };
  const std::size_t count = pending_.size() - first;
  if (count <= kFewMembers) {  // nearly all are so small: no memory is taken for them
    for (std::size_t i = first; i < pending_.size(); ++i) {
      for (std::size_t j = first; j < i; ++j) {
        if (key_of(pending_[i]) == key_of(pending_[j])) return key_of(pending_[i]);
      }
    }
    return std::nullopt;
  }
  std::vector<std::string_view> keys;
  keys.reserve(count);
  for (std::size_t i = first; i < pending_.size(); ++i) keys.push_back(key_of(pending_[i]));
  std::sort(keys.begin(), keys.end());
  const auto twice = std::adjacent_find(keys.begin(), keys.end());
  if (twice == keys.end()) return std::nullopt;
  return *twice;
}

}  // namespace tweend::assets
