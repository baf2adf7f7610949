#include "clients/cli/value_kind.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string_view>
#include <system_error>
#include <vector>

#include "clients/cli/failure.hpp"

namespace tweend::cli {
namespace {

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  for (std::size_t at = 0;;) {
    const std::size_t end = text.find(separator, at);
    parts.push_back(text.substr(at, end - at));
    if (end == std::string_view::npos) return parts;
    at = end + 1;
  }
}

Usage unexpected(std::string_view expected, std::string_view found) {
  return Usage(fmt::format("expected {}, found '{}'", expected, found));
}

template <class T>
T parse(std::string_view text, std::string_view expected) {
  T value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) throw unexpected(expected, text);
  return value;
}

double parse_number(std::string_view text) {
  const double value = parse<double>(text, "a number");
  if (!std::isfinite(value)) throw unexpected("a finite number", text);
  return value;
}

std::vector<double> parse_numbers(std::string_view text, const std::vector<std::size_t>& sizes) {
  const auto parts = split(text, ',');
  if (std::find(sizes.begin(), sizes.end(), parts.size()) == sizes.end()) {
    throw unexpected(fmt::format("{} numbers separated by commas", fmt::join(sizes, " or ")), text);
  }
  std::vector<double> values;
  for (const auto part : parts) {
    values.push_back(parse_number(part));
  }
  return values;
}

/// @param source  what a person gave, for the error
Json parse_json(const std::string& content, std::string_view source) {
  Json value = Json::parse(content, nullptr, false);
  if (value.is_discarded()) throw unexpected("JSON", source);
  return value;
}

}  // namespace

ValueKind text(std::string shape) {
  return {std::move(shape), [](const std::string& found) { return Json(found); }};
}

ValueKind number(std::string shape) {
  return {std::move(shape), [](const std::string& found) { return Json(parse_number(found)); }};
}

ValueKind seconds() {
  return {"SECONDS", [](const std::string& found) {
            const double value = parse_number(found);
            if (value < 0.0) throw unexpected("seconds, not negative", found);
            return Json(value);
          }};
}

ValueKind integer(std::string shape) {
  return {std::move(shape), [](const std::string& found) { return Json(parse<std::int64_t>(found, "an integer")); }};
}

ValueKind count(std::string shape) {
  return {std::move(shape),
          [](const std::string& found) { return Json(parse<std::uint64_t>(found, "an integer that is not negative")); }};
}

ValueKind numbers(std::string shape, std::initializer_list<std::size_t> sizes) {
  return {std::move(shape),
          [sizes = std::vector(sizes)](const std::string& found) { return Json(parse_numbers(found, sizes)); }};
}

ValueKind any_numbers(std::string shape) {
  return {std::move(shape), [](const std::string& found) {
            Json values = Json::array();
            for (const auto part : split(found, ',')) values.push_back(parse_number(part));
            return values;
          }};
}

ValueKind integers(std::string shape) {
  return {std::move(shape), [](const std::string& found) {
            Json values = Json::array();
            for (const auto part : split(found, ',')) {
              values.push_back(parse<std::int64_t>(part, "integers separated by commas"));
            }
            return values;
          }};
}

ValueKind texts(std::string shape) {
  return {std::move(shape), [](const std::string& found) {
            Json values = Json::array();
            for (const auto part : split(found, ',')) values.push_back(part);
            return values;
          }};
}

ValueKind word(const std::string& shape) {
  return {shape, [shape](const std::string& found) {
            const auto words = split(shape, '|');
            if (std::find(words.begin(), words.end(), found) == words.end()) {
              throw unexpected(fmt::format("one of {}", fmt::join(words, ", ")), found);
            }
            return Json(found);
          }};
}

ValueKind or_none(const ValueKind& kind) {
  return {kind.shape + "|none",
          [read = kind.read](const std::string& found) { return found == "none" ? Json() : read(found); }};
}

ValueKind json_file(std::istream& in) {
  return {"FILE", [&in](const std::string& path) { return parse_json(read_file(path, in), path); }};
}

ValueKind json_or_file(std::istream& in) {
  return {"JSON|@FILE", [&in](const std::string& found) {
            return found.starts_with('@') ? parse_json(read_file(found.substr(1), in), found) : parse_json(found, found);
          }};
}

ValueKind scale() {
  return {"X,Y,Z", [](const std::string& found) {
            auto values = parse_numbers(found, {1, 3});
            values.resize(3, values.front());
            return Json(values);
          }};
}

ValueKind turn_y() {
  return {"RADIANS", [](const std::string& found) {
            const double angle = parse_number(found);
            return Json{0.0, std::sin(angle / 2), 0.0, std::cos(angle / 2)};
          }};
}

ValueKind orbit() {
  return {"AZIMUTH,ELEVATION[,DISTANCE]", [](const std::string& found) {
            const auto values = parse_numbers(found, {2, 3});
            Json object{{"azimuth", values[0]}, {"elevation", values[1]}};
            if (values.size() == 3) object["distance"] = values[2];
            return object;
          }};
}

ValueKind size() {
  return {
      "WIDTHxHEIGHT", [](const std::string& found) {
        const std::string expected = "WIDTHxHEIGHT in pixels, as 640x360";
        const auto sides = split(found, 'x');
        if (sides.size() != 2) throw unexpected(expected, found);
        return Json{{"width", parse<std::uint32_t>(sides[0], expected)}, {"height", parse<std::uint32_t>(sides[1], expected)}};
      }};
}

std::string read_file(const std::string& path, std::istream& in) {
  std::ifstream file;
  if (path != "-") file.open(path, std::ios::binary);
  const auto unreadable = [&] { return Usage(fmt::format("can't read {}: {}", path, std::generic_category().message(errno))); };
  if (!file) throw unreadable();
  std::ostringstream content;
  errno = 0;
  content << (path == "-" ? in.rdbuf() : file.rdbuf());
  if (content.view().empty() && errno != 0) throw unreadable();  // a folder opens, and fails at the first read
  return std::move(content).str();
}

}  // namespace tweend::cli
