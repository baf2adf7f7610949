#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "protocol/json_value.hpp"
#include "server/base/result.hpp"

// Descriptions of the structs that travel as JSON. One table of fields for each struct gives decoding with paths, unknown
// parameters, encoding and JSON Schema; the code that does it (json_decode, json_encode, json_schema) is compiled once.

namespace tweend::protocol {

enum class Kind : std::uint8_t {
  Bool,
  Integer,        ///< std::int64_t
  Unsigned,       ///< std::uint64_t
  Number,         ///< double, finite
  Float,          ///< float, finite as float
  Text,           ///< std::string, UTF-8
  Name,           ///< a name given by a command
  Vec3,           ///< glm::vec3 as [x, y, z]
  Quat,           ///< glm::quat as [x, y, z, w], normalised on the way in
  Doubles,        ///< std::array<double, N>, finite
  Floats,         ///< std::vector<float>
  Indices,        ///< std::vector<std::uint32_t>
  Base64Floats,   ///< little-endian float32
  Base64Indices,  ///< little-endian uint32
  Enum,
  Object,
  Optional,  ///< a field that may be left out; inside another Optional: a value that may be null
  List,
  Map,      ///< std::map<std::string, double>
  Entries,  ///< protocol::Entries<E> (parameters only)
  Value,    ///< any JSON object, decoded later
  Json,     ///< JSON text made elsewhere (results only)
};

struct FieldInfo;

/// What decode, encode and schema need to know of a C++ type; void* are pointers to a value of it.
struct TypeInfo {
  Kind kind = Kind::Bool;
  std::string_view name;                                  ///< objects: for the schema
  std::vector<FieldInfo> fields;                          ///< objects
  std::vector<std::string_view> enumerators;              ///< enums, in the order of their values from 0
  const TypeInfo* element = nullptr;                      ///< optionals, lists and entries
  std::size_t count = 0;                                  ///< Doubles: how many
  void* (*emplace)(void*) = nullptr;                      ///< optional: engages; list: appends; the new element
  void* (*emplace_named)(void*, std::string) = nullptr;   ///< entries: appends; the new element
  const void* (*at)(const void*, std::size_t) = nullptr;  ///< optional: null when empty; list: null past the end
  void (*set_enum)(void*, std::size_t) = nullptr;
  std::size_t (*get_enum)(const void*) = nullptr;
  Status (*check)(const void*) = nullptr;  ///< rules across fields; error paths are relative ("time")
};

/// Which numbers a field takes.
struct Range {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool min_excluded = false;
};
inline constexpr Range kNotNegative{.min = 0.0};
inline constexpr Range kPositive{.min = 0.0, .min_excluded = true};

struct FieldInfo {
  std::string_view name;
  std::string_view doc;
  const TypeInfo* type = nullptr;
  bool required = false;
  Range range;
  void* (*member)(void*) = nullptr;
};

/// A name given by a command: 1 to 64 of A-Z a-z 0-9 _ . -, not starting with a dot.
struct Name {
  std::string text;
};
struct Base64Floats {
  std::vector<float> values;
};
struct Base64Indices {
  std::vector<std::uint32_t> values;
};
/// JSON text that is already made; goes into the answer as it is.
struct JsonText {
  std::shared_ptr<const std::string> text;
};

/// An object whose names are the client's to choose, in the order of its names.
template <class E>
struct Entries {
  std::vector<std::pair<std::string, E>> list;
};

/// A parameter that may also be null, which takes the value away: left out, null, or a value.
template <class T>
using Nullable = std::optional<std::optional<T>>;

template <class T>
class FieldList;

/// A struct that travels describes itself: a static `kName`, `describe(FieldList<T>&)` naming its fields, and where rules
/// bind several fields, `Status check() const`.
template <class T>
concept Described = requires(FieldList<T>& list) {
  { T::kName } -> std::convertible_to<std::string_view>;
  T::describe(list);
};

/// Specialise for each enum: `static constexpr std::array kNames`, enumerators counting from 0.
template <class T>
struct EnumNames;

template <class T>
[[nodiscard]] const TypeInfo& type_of();

/// Collects the fields of T, in `T::describe`: `list.template add<&T::time>("time", "Media seconds.")`.
template <class T>
class FieldList {
 public:
  /// A field is required unless its type is std::optional.
  template <auto Member>
  FieldList& add(std::string_view name, std::string_view doc, Range range = {}) {
    using M = std::remove_cvref_t<decltype(std::declval<T&>().*Member)>;
    FieldInfo info{name,          doc,
                   &type_of<M>(), type_of<M>().kind != Kind::Optional,
                   range,         [](void* object) -> void* { return &(static_cast<T*>(object)->*Member); }};
    fields_.push_back(info);
    return *this;
  }
  /// A field that keeps its initial value when left out.
  template <auto Member>
  FieldList& add_default(std::string_view name, std::string_view doc, Range range = {}) {
    add<Member>(name, doc, range);
    fields_.back().required = false;
    return *this;
  }
  [[nodiscard]] std::vector<FieldInfo> take() { return std::move(fields_); }

 private:
  std::vector<FieldInfo> fields_;
};

namespace detail {

template <class T>
concept Checked = requires(const T& t) {
  { t.check() } -> std::same_as<Status>;
};

template <class T>
constexpr Kind scalar_kind() {
  if constexpr (std::is_same_v<T, bool>)
    return Kind::Bool;
  else if constexpr (std::is_same_v<T, std::int64_t>)
    return Kind::Integer;
  else if constexpr (std::is_same_v<T, std::uint64_t>)
    return Kind::Unsigned;
  else if constexpr (std::is_same_v<T, double>)
    return Kind::Number;
  else if constexpr (std::is_same_v<T, float>)
    return Kind::Float;
  else if constexpr (std::is_same_v<T, std::string>)
    return Kind::Text;
  else if constexpr (std::is_same_v<T, Name>)
    return Kind::Name;
  else if constexpr (std::is_same_v<T, glm::vec3>)
    return Kind::Vec3;
  else if constexpr (std::is_same_v<T, glm::quat>)
    return Kind::Quat;
  else if constexpr (std::is_same_v<T, std::vector<float>>)
    return Kind::Floats;
  else if constexpr (std::is_same_v<T, std::vector<std::uint32_t>>)
    return Kind::Indices;
  else if constexpr (std::is_same_v<T, Base64Floats>)
    return Kind::Base64Floats;
  else if constexpr (std::is_same_v<T, Base64Indices>)
    return Kind::Base64Indices;
  else if constexpr (std::is_same_v<T, std::map<std::string, double>>)
    return Kind::Map;
  else if constexpr (std::is_same_v<T, JsonValue>)
    return Kind::Value;
  else
    return Kind::Json;
}

template <class T>
struct Maker {
  static TypeInfo make() {
    TypeInfo info;
    if constexpr (std::is_enum_v<T>) {
      info.kind = Kind::Enum;
      info.enumerators.assign(EnumNames<T>::kNames.begin(), EnumNames<T>::kNames.end());
      info.set_enum = [](void* v, std::size_t i) { *static_cast<T*>(v) = static_cast<T>(i); };
      info.get_enum = [](const void* v) { return static_cast<std::size_t>(*static_cast<const T*>(v)); };
    } else if constexpr (Described<T>) {
      info.kind = Kind::Object;
      info.name = T::kName;
      FieldList<T> list;
      T::describe(list);
      info.fields = list.take();
      if constexpr (Checked<T>) info.check = [](const void* v) { return static_cast<const T*>(v)->check(); };
    } else {
      info.kind = scalar_kind<T>();
      static_assert(scalar_kind<T>() != Kind::Json || std::is_same_v<T, JsonText>,
                    "describe this type: kName and describe(), or EnumNames");
    }
    return info;
  }
};

template <std::size_t N>
struct Maker<std::array<double, N>> {
  static TypeInfo make() {
    TypeInfo info;
    info.kind = Kind::Doubles;
    info.count = N;
    return info;
  }
};

template <class E>
struct Maker<std::optional<E>> {
  static TypeInfo make() {
    TypeInfo info;
    info.kind = Kind::Optional;
    info.element = &type_of<E>();
    info.emplace = [](void* v) -> void* { return &static_cast<std::optional<E>*>(v)->emplace(); };
    info.at = [](const void* v, std::size_t) -> const void* {
      const auto& o = *static_cast<const std::optional<E>*>(v);
      return o ? &*o : nullptr;
    };
    return info;
  }
};

template <class E>
requires(Described<E> || std::is_enum_v<E> || std::is_same_v<E, std::string> || std::is_same_v<E, std::int64_t> ||
         std::is_same_v<E, JsonText>) struct Maker<std::vector<E>> {
  static TypeInfo make() {
    TypeInfo info;
    info.kind = Kind::List;
    info.element = &type_of<E>();
    info.emplace = [](void* v) -> void* { return &static_cast<std::vector<E>*>(v)->emplace_back(); };
    info.at = [](const void* v, std::size_t i) -> const void* {
      const auto& list = *static_cast<const std::vector<E>*>(v);
      return i < list.size() ? &list[i] : nullptr;
    };
    return info;
  }
};

template <Described E>
struct Maker<Entries<E>> {
  static TypeInfo make() {
    TypeInfo info;
    info.kind = Kind::Entries;
    info.element = &type_of<E>();
    info.emplace_named = [](void* v, std::string name) -> void* {
      return &static_cast<Entries<E>*>(v)->list.emplace_back(std::move(name), E{}).second;
    };
    return info;
  }
};

}  // namespace detail

template <class T>
const TypeInfo& type_of() {
  static const TypeInfo info = detail::Maker<T>::make();
  return info;
}

/// Decodes JSON into a described struct. Every error names the path: unknown and missing parameters, wrong types,
/// numbers that are not finite or out of range, names and enumerators.
/// @param path  what stands before the first dot in error paths, e.g. "params"
[[nodiscard]] Status decode(const JsonValue& value, const TypeInfo& type, void* out, const std::string& path);

template <class T>
[[nodiscard]] Result<T> decode(const JsonValue& value, const std::string& path = "params") {
  T out;
  TWEEND_TRY(decode(value, type_of<T>(), &out, path));
  return out;
}

/// Appends the value as JSON. Floats are printed so that they read back as the same float.
void encode(const TypeInfo& type, const void* value, std::string& out);

template <class T>
[[nodiscard]] std::string encode(const T& value) {
  std::string out;
  encode(type_of<T>(), &value, out);
  return out;
}

/// Appends a JSON string literal.
void append_json_string(std::string_view text, std::string& out);

/// The JSON Schema (draft 7) of a type, as JSON text.
[[nodiscard]] std::string json_schema(const TypeInfo& type, Range range = {});

}  // namespace tweend::protocol
