#pragma once

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <string_view>

#include "protocol/type_info.hpp"

// Structs for tests: one parameter of any type, and a nest of all of them.

namespace tweend::protocol {

enum class Colour : std::uint8_t { Red, Green, Blue };
template <>
struct EnumNames<Colour> {
  static constexpr std::array<std::string_view, 3> kNames{"red", "green", "blue"};
};

struct None {
  static constexpr std::string_view kName = "None";
  static void describe(FieldList<None>&) {}
};

/// `{"value": T}`, with numbers inside `kRange`.
template <class T, Range kRange = Range{}>
struct One {
  static constexpr std::string_view kName = "One";
  T value{};
  static void describe(FieldList<One>& f) { f.template add<&One::value>("value", "The value.", kRange); }
};

/// `{"value": T}` or `{}`.
template <class T>
struct Default {
  static constexpr std::string_view kName = "Default";
  T value{};
  static void describe(FieldList<Default>& f) { f.template add_default<&Default::value>("value", "The value."); }
};

struct Part {
  static constexpr std::string_view kName = "Part";
  std::optional<glm::vec3> scale;
  std::optional<std::vector<float>> positions;
  std::optional<Colour> colour;
  static void describe(FieldList<Part>& f) {
    f.add<&Part::scale>("scale", "Factors along x, y and z.");
    f.add<&Part::positions>("positions", "x, y, z of each.");
    f.add<&Part::colour>("colour", "Its colour.");
  }
};

/// Rules across fields: from < to, and neither without a part.
struct Whole {
  static constexpr std::string_view kName = "Whole";
  double from = 0.0;
  double to = 0.0;
  std::optional<Part> transform;
  std::optional<std::vector<Part>> parts;
  static void describe(FieldList<Whole>& f) {
    f.add<&Whole::from>("from", "Where it begins.");
    f.add<&Whole::to>("to", "Where it ends.");
    f.add<&Whole::transform>("transform", "Where it stands.");
    f.add<&Whole::parts>("parts", "What it is made of.");
  }
  [[nodiscard]] Status check() const {
    if (!(from < to)) return fail(ErrorCode::InvalidParams, "expected from before to", "to");
    if (parts && parts->empty()) return fail(ErrorCode::InvalidParams, "expected a part");
    return {};
  }
};

[[nodiscard]] inline JsonValue parsed(std::string_view text) {
  auto value = JsonValue::parse(text, Limits());
  if (!value) throw std::runtime_error(value.error().message + ": " + std::string(text));
  return *value;
}

/// What `{"value": text}` decodes to.
template <class T, Range kRange = Range{}>
[[nodiscard]] Result<T> read(std::string_view text) {
  auto one = decode<One<T, kRange>>(parsed("{\"value\":" + std::string(text) + "}"));
  if (!one) return one.error();
  return std::move(one->value);
}

inline void expect_invalid(const Error& error, std::string_view path, std::string_view in_message = {}) {
  EXPECT_EQ(error.code, ErrorCode::InvalidParams) << error.message;
  EXPECT_EQ(error.path, path) << error.message;
  EXPECT_NE(error.message.find(in_message), std::string::npos) << "\"" << in_message << "\" in: " << error.message;
}

}  // namespace tweend::protocol
