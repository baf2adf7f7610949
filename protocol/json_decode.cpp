#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <string>

#include "protocol/base64.hpp"
#include "protocol/json_node.hpp"
#include "protocol/type_info.hpp"

namespace tweend::protocol {
namespace {

using nlohmann::json;

Error wrong(const std::string& path, std::string_view expected, const json& found) {
  return fail(ErrorCode::InvalidParams, fmt::format("expected {}, found {}", expected, describe_found(found)), path);
}

bool inside(double v, const Range& r) noexcept { return (r.min_excluded ? v > r.min : v >= r.min) && v <= r.max; }

std::string expected_number(std::string_view what, const Range& r) {
  const bool below = std::isfinite(r.min), above = std::isfinite(r.max);
  if (below && above && r.min_excluded) return fmt::format("{} above {} and up to {}", what, r.min, r.max);
  if (below && above) return fmt::format("{} from {} to {}", what, r.min, r.max);
  if (below) return fmt::format("{} {} {}", what, r.min_excluded ? "above" : "of at least", r.min);
  if (above) return fmt::format("{} of at most {}", what, r.max);
  return std::string(what);
}

template <class T>
Status number_into(const json& j, T& out, const Range& range, const std::string& path) {
  const auto expected = [&] { return expected_number("a finite number", range); };
  if (!j.is_number()) return wrong(path, expected(), j);
  const double v = j.get<double>();
  const T narrow = static_cast<T>(v);
  const bool vanished = range.min_excluded && !(static_cast<double>(narrow) > range.min);  // 1e-50 as a float
  if (!std::isfinite(narrow) || !inside(v, range) || vanished) return wrong(path, expected(), j);
  out = narrow;
  return {};
}

template <class T>
Status integer_into(const json& j, T& out, const Range& range, const std::string& path) {
  const auto expected = [&] { return expected_number("an integer", range); };
  // 3.0 is an integer to JSON, and some languages print it so.
  if (j.is_number_float() && std::floor(j.get<double>()) == j.get<double>() && std::abs(j.get<double>()) < 9e15) {
    return integer_into(json(static_cast<std::int64_t>(j.get<double>())), out, range, path);
  }
  const bool fits = std::is_signed_v<T>
                        ? j.is_number_integer() && !(j.is_number_unsigned() && j.get<std::uint64_t>() > INT64_MAX)
                        : j.is_number_unsigned() || (j.is_number_integer() && j.get<std::int64_t>() >= 0);
  if (!fits) return wrong(path, expected(), j);
  out = j.get<T>();
  if (!inside(static_cast<double>(out), range)) return wrong(path, expected(), j);
  return {};
}

Status floats_into(const json& j, float* out, std::size_t count, const std::string& path) {
  for (std::size_t i = 0; i < count; ++i) {
    const json& v = j[i];
    const auto narrow = v.is_number() ? static_cast<float>(v.get<double>()) : std::nanf("");
    if (!std::isfinite(narrow)) return wrong(fmt::format("{}[{}]", path, i), "a finite number", v);
    out[i] = narrow;
  }
  return {};
}

Status vec3_into(const json& j, glm::vec3& out, const Range& range, const std::string& path) {
  if (!j.is_array() || j.size() != 3) return wrong(path, "three numbers [x, y, z]", j);
  for (int i = 0; i < 3; ++i)
    TWEEND_TRY(number_into(j[static_cast<std::size_t>(i)], out[i], range, fmt::format("{}[{}]", path, i)));
  return {};
}

Status quat_into(const json& j, glm::quat& out, const std::string& path) {
  if (!j.is_array() || j.size() != 4) return wrong(path, "a quaternion [x, y, z, w]", j);
  float xyzw[4];
  TWEEND_TRY(floats_into(j, xyzw, 4, path));
  double length = 0.0;
  for (const float v : xyzw) length += static_cast<double>(v) * v;
  length = std::sqrt(length);
  if (!(length > 1e-12)) return wrong(path, "a quaternion [x, y, z, w] that is not zero", j);
  const auto unit = [&](int i) { return static_cast<float>(xyzw[i] / length); };
  out = glm::quat(unit(3), unit(0), unit(1), unit(2));
  return {};
}

Status indices_into(const json& j, std::vector<std::uint32_t>& out, const std::string& path) {
  if (!j.is_array()) return wrong(path, "an array of indices", j);
  out.resize(j.size());
  for (std::size_t i = 0; i < j.size(); ++i) {
    std::uint64_t index = 0;
    if (j[i].is_number_unsigned()) {
      index = j[i].get<std::uint64_t>();  // nearly always: no path is printed for it
    } else if (!integer_into(j[i], index, {}, path)) {
      index = UINT64_MAX;
    }
    if (index > UINT32_MAX) return wrong(fmt::format("{}[{}]", path, i), "an index, a whole number from 0", j[i]);
    out[i] = static_cast<std::uint32_t>(index);
  }
  return {};
}

template <class T>
Status base64_into(const json& j, std::vector<T>& out, const std::string& path) {
  static_assert(std::endian::native == std::endian::little, "the wire is little-endian: swap here on other machines");
  if (!j.is_string()) return wrong(path, "base64 text of little-endian 32-bit values", j);
  auto bytes = decode_base64(j.get_ref<const std::string&>());
  if (!bytes) return fail(bytes.error().code, bytes.error().message, path);
  if (bytes->size() % sizeof(T) != 0) {
    return fail(ErrorCode::InvalidParams, fmt::format("expected a multiple of {} bytes, found {}", sizeof(T), bytes->size()),
                path);
  }
  out.resize(bytes->size() / sizeof(T));
  if (!out.empty()) std::memcpy(out.data(), bytes->data(), bytes->size());
  return {};
}

Status name_into(const json& j, std::string& out, const std::string& path) {
  constexpr std::string_view kExpected = "a name: 1 to 64 of A-Z a-z 0-9 _ . -, not starting with a dot";
  if (!j.is_string()) return wrong(path, kExpected, j);
  const auto& text = j.get_ref<const std::string&>();
  const auto good = [](char c) {
    return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '.' || c == '-';
  };
  if (text.empty() || text.size() > 64 || text[0] == '.' || !std::all_of(text.begin(), text.end(), good))
    return wrong(path, kExpected, j);
  out = text;
  return {};
}

Status enum_into(const json& j, const TypeInfo& type, void* out, const std::string& path) {
  if (j.is_string()) {
    const auto& text = j.get_ref<const std::string&>();
    const auto at = std::find(type.enumerators.begin(), type.enumerators.end(), text);
    if (at != type.enumerators.end()) {
      type.set_enum(out, static_cast<std::size_t>(at - type.enumerators.begin()));
      return {};
    }
  }
  return wrong(path, fmt::format("one of {}", fmt::join(type.enumerators, ", ")), j);
}

class Decoder {
 public:
  explicit Decoder(const JsonValue& whole) : whole_(whole) {}

  Status into(const json& j, const TypeInfo& type, const Range& range, void* out, const std::string& path) const {
    switch (type.kind) {
      case Kind::Bool:
        if (!j.is_boolean()) return wrong(path, "true or false", j);
        *static_cast<bool*>(out) = j.get<bool>();
        return {};
      case Kind::Integer:
        return integer_into(j, *static_cast<std::int64_t*>(out), range, path);
      case Kind::Unsigned:
        return integer_into(j, *static_cast<std::uint64_t*>(out), range, path);
      case Kind::Number:
        return number_into(j, *static_cast<double*>(out), range, path);
      case Kind::Float:
        return number_into(j, *static_cast<float*>(out), range, path);
      case Kind::Text:
        if (!j.is_string()) return wrong(path, "a text", j);
        *static_cast<std::string*>(out) = j.get_ref<const std::string&>();
        return {};
      case Kind::Name:
        return name_into(j, static_cast<Name*>(out)->text, path);
      case Kind::Vec3:
        return vec3_into(j, *static_cast<glm::vec3*>(out), range, path);
      case Kind::Quat:
        return quat_into(j, *static_cast<glm::quat*>(out), path);
      case Kind::Doubles:
        if (!j.is_array() || j.size() != type.count) return wrong(path, fmt::format("an array of {} numbers", type.count), j);
        for (std::size_t i = 0; i < type.count; ++i) {
          TWEEND_TRY(number_into(j[i], static_cast<double*>(out)[i], range, fmt::format("{}[{}]", path, i)));
        }
        return {};
      case Kind::Floats: {
        if (!j.is_array()) return wrong(path, "an array of numbers", j);
        auto& values = *static_cast<std::vector<float>*>(out);
        values.resize(j.size());
        return floats_into(j, values.data(), j.size(), path);
      }
      case Kind::Indices:
        return indices_into(j, *static_cast<std::vector<std::uint32_t>*>(out), path);
      case Kind::Base64Floats:
        return base64_into(j, static_cast<Base64Floats*>(out)->values, path);
      case Kind::Base64Indices:
        return base64_into(j, static_cast<Base64Indices*>(out)->values, path);
      case Kind::Enum:
        return enum_into(j, type, out, path);
      case Kind::Object:
        return object_into(j, type, out, path);
      case Kind::Optional: {
        // Reached for a field that is there; what may be null is an optional inside an optional.
        void* inner = type.emplace(out);
        if (type.element->kind == Kind::Optional && j.is_null()) return {};
        return into(j, *type.element, range, inner, path);
      }
      case Kind::List:
        return list_into(j, type, out, path);
      case Kind::Entries:
        return entries_into(j, type, out, path);
      case Kind::Value:
        if (!j.is_object()) return wrong(path, "an object", j);
        *static_cast<JsonValue*>(out) = part_of(whole_, j);
        return {};
      case Kind::Map:
      case Kind::Json:
        break;  // results only
    }
    return fail(ErrorCode::Internal, "this type can't be a parameter", path);
  }

 private:
  Status list_into(const json& j, const TypeInfo& type, void* out, const std::string& path) const {
    if (!j.is_array()) return wrong(path, "an array", j);
    for (std::size_t i = 0; i < j.size(); ++i) {
      TWEEND_TRY(into(j[i], *type.element, {}, type.emplace(out), fmt::format("{}[{}]", path, i)));
    }
    return {};
  }

  Status entries_into(const json& j, const TypeInfo& type, void* out, const std::string& path) const {
    if (!j.is_object()) return wrong(path, "an object", j);
    for (const auto& [name, value] : j.items()) {
      TWEEND_TRY(into(value, *type.element, {}, type.emplace_named(out, name), fmt::format("{}.{}", path, name)));
    }
    return {};
  }

  Status object_into(const json& j, const TypeInfo& type, void* out, const std::string& path) const {
    if (!j.is_object()) return wrong(path, "an object", j);
    for (const auto& [key, value] : j.items()) {
      const auto known = [&key = key](const FieldInfo& f) { return f.name == key; };
      if (std::none_of(type.fields.begin(), type.fields.end(), known)) return unknown(type, path + "." + key);
    }
    for (const FieldInfo& field : type.fields) {
      const auto at = j.find(field.name);
      const std::string here = path + "." + std::string(field.name);
      if (at != j.end()) {
        TWEEND_TRY(into(*at, *field.type, field.range, field.member(out), here));
      } else if (field.required) {
        return fail(ErrorCode::InvalidParams, fmt::format("expected this parameter, found none: {}", field.doc), here);
      }
    }
    if (type.check == nullptr) return {};
    if (Status status = type.check(out); !status) {
      Error error = status.error();
      error.path = error.path.empty() ? path : path + "." + error.path;
      return error;
    }
    return {};
  }

  static Error unknown(const TypeInfo& type, const std::string& path) {
    std::string names;
    for (const FieldInfo& f : type.fields) names += (names.empty() ? "" : ", ") + std::string(f.name);
    return fail(ErrorCode::InvalidParams,
                names.empty() ? "expected no parameters, found this one"
                              : fmt::format("expected one of {}, found another parameter", names),
                path);
  }

  const JsonValue& whole_;
};

}  // namespace

Status decode(const JsonValue& value, const TypeInfo& type, void* out, const std::string& path) {
  return Decoder(value).into(json_of(value), type, {}, out, path);
}

}  // namespace tweend::protocol
