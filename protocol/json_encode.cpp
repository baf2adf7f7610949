#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <span>

#include "protocol/base64.hpp"
#include "protocol/type_info.hpp"

namespace tweend::protocol {
namespace {

// The shortest digits that read back as the same value; JSON has no infinities, and results hold none.
template <class T>
void append_number(T value, std::string& out) {
  if constexpr (std::is_floating_point_v<T>) {
    if (!std::isfinite(value)) {
      out += "null";
      return;
    }
  }
  std::array<char, 32> digits;
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
  out.append(digits.data(), end);
}

template <class T>
void append_numbers(std::span<const T> values, std::string& out) {
  out.reserve(out.size() + 12 * values.size());
  char before = '[';
  for (const T v : values) {
    out += before;
    append_number(v, out);
    before = ',';
  }
  out += values.empty() ? "[]" : "]";
}

template <class T>
void append_base64_text(const std::vector<T>& values, std::string& out) {
  out += '"';
  append_base64(std::as_bytes(std::span(values)), out);
  out += '"';
}

void append_object(const TypeInfo& type, const void* value, std::string& out) {
  char before = '{';
  for (const FieldInfo& field : type.fields) {
    // Reading through the writing accessor: the value itself is not touched.
    const void* member = field.member(const_cast<void*>(value));
    const bool left_out = field.type->kind == Kind::Optional && field.type->at(member, 0) == nullptr;
    if (left_out) continue;
    out += before;
    append_json_string(field.name, out);
    out += ':';
    encode(*field.type, member, out);
    before = ',';
  }
  out += before == '{' ? "{}" : "}";
}

void append_list(const TypeInfo& type, const void* value, std::string& out) {
  char before = '[';
  for (std::size_t i = 0; const void* element = type.at(value, i); ++i) {
    out += before;
    encode(*type.element, element, out);
    before = ',';
  }
  out += before == '[' ? "[]" : "]";
}

void append_map(const std::map<std::string, double>& map, std::string& out) {
  char before = '{';
  for (const auto& [key, number] : map) {
    out += before;
    append_json_string(key, out);
    out += ':';
    append_number(number, out);
    before = ',';
  }
  out += map.empty() ? "{}" : "}";
}

}  // namespace

void append_json_string(std::string_view text, std::string& out) {
  constexpr std::string_view kHex = "0123456789abcdef";
  out += '"';
  for (const char c : text) {
    switch (c) {
      case '"':
        out += "\\\"";
        break;
      case '\\':
        out += "\\\\";
        break;
      case '\n':
        out += "\\n";
        break;
      case '\r':
        out += "\\r";
        break;
      case '\t':
        out += "\\t";
        break;
      default:
        if (const auto u = static_cast<unsigned char>(c); u < 0x20) {
          out += "\\u00";
          out += kHex[u >> 4U];
          out += kHex[u & 15U];
        } else {
          out += c;
        }
    }
  }
  out += '"';
}

void encode(const TypeInfo& type, const void* value, std::string& out) {
  switch (type.kind) {
    case Kind::Bool:
      out += *static_cast<const bool*>(value) ? "true" : "false";
      return;
    case Kind::Integer:
      return append_number(*static_cast<const std::int64_t*>(value), out);
    case Kind::Unsigned:
      return append_number(*static_cast<const std::uint64_t*>(value), out);
    case Kind::Number:
      return append_number(*static_cast<const double*>(value), out);
    case Kind::Float:
      return append_number(*static_cast<const float*>(value), out);
    case Kind::Text:
      return append_json_string(*static_cast<const std::string*>(value), out);
    case Kind::Name:
      return append_json_string(static_cast<const Name*>(value)->text, out);
    case Kind::Vec3: {
      const auto& v = *static_cast<const glm::vec3*>(value);
      return append_numbers<float>(std::array{v.x, v.y, v.z}, out);
    }
    case Kind::Quat: {
      const auto& q = *static_cast<const glm::quat*>(value);
      return append_numbers<float>(std::array{q.x, q.y, q.z, q.w}, out);
    }
    case Kind::Doubles:
      return append_numbers<double>(std::span(static_cast<const double*>(value), type.count), out);
    case Kind::Floats:
      return append_numbers<float>(*static_cast<const std::vector<float>*>(value), out);
    case Kind::Indices:
      return append_numbers<std::uint32_t>(*static_cast<const std::vector<std::uint32_t>*>(value), out);
    case Kind::Base64Floats:
      return append_base64_text(static_cast<const Base64Floats*>(value)->values, out);
    case Kind::Base64Indices:
      return append_base64_text(static_cast<const Base64Indices*>(value)->values, out);
    case Kind::Enum:
      return append_json_string(type.enumerators[type.get_enum(value)], out);
    case Kind::Object:
      return append_object(type, value, out);
    case Kind::Optional:
      if (const void* inner = type.at(value, 0)) return encode(*type.element, inner, out);
      out += "null";
      return;
    case Kind::List:
      return append_list(type, value, out);
    case Kind::Map:
      return append_map(*static_cast<const std::map<std::string, double>*>(value), out);
    case Kind::Json:
      out += *static_cast<const JsonText*>(value)->text;
      return;
    case Kind::Entries:
    case Kind::Value:
      out += "{}";  // parameters only
      return;
  }
}

}  // namespace tweend::protocol
