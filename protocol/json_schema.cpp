#include <cmath>
#include <nlohmann/json.hpp>

#include "protocol/json_node.hpp"
#include "protocol/type_info.hpp"

namespace tweend::protocol {
namespace {

using nlohmann::ordered_json;

ordered_json schema_of(const TypeInfo& type, const Range& range);

ordered_json number(const char* name, const Range& range) {
  ordered_json s{{"type", name}};
  if (std::isfinite(range.min)) s[range.min_excluded ? "exclusiveMinimum" : "minimum"] = range.min;
  if (std::isfinite(range.max)) s["maximum"] = range.max;
  return s;
}

ordered_json numbers(std::size_t count, const Range& range = {}) {
  ordered_json s{{"type", "array"}, {"items", number("number", range)}};
  if (count != 0) s["minItems"] = s["maxItems"] = count;
  return s;
}

ordered_json object(const TypeInfo& type) {
  ordered_json properties = ordered_json::object();
  ordered_json required = ordered_json::array();
  for (const FieldInfo& field : type.fields) {
    // The outermost optional only says that the field may be left out.
    const TypeInfo& inner = field.type->kind == Kind::Optional ? *field.type->element : *field.type;
    ordered_json s = schema_of(inner, field.range);
    s["description"] = field.doc;
    properties[std::string(field.name)] = std::move(s);
    if (field.required) required.push_back(field.name);
  }
  ordered_json s{{"type", "object"}, {"title", type.name}, {"properties", std::move(properties)}};
  if (!required.empty()) s["required"] = std::move(required);
  s["additionalProperties"] = false;
  return s;
}

ordered_json schema_of(const TypeInfo& type, const Range& range) {
  switch (type.kind) {
    case Kind::Bool:
      return {{"type", "boolean"}};
    case Kind::Integer:
      return number("integer", range);
    case Kind::Unsigned:
      return number("integer", range.min >= 0.0 ? range : Range{0.0, range.max, false});
    case Kind::Number:
    case Kind::Float:
      return number("number", range);
    case Kind::Text:
      return {{"type", "string"}};
    case Kind::Name:
      return {{"type", "string"}, {"pattern", "^[A-Za-z0-9_-][A-Za-z0-9_.-]{0,63}$"}};
    case Kind::Vec3:
      return numbers(3, range);
    case Kind::Quat:
      return numbers(4);
    case Kind::Doubles:
      return numbers(type.count, range);
    case Kind::Floats:
      return numbers(0);
    case Kind::Indices:
      return {{"type", "array"}, {"items", {{"type", "integer"}, {"minimum", 0}, {"maximum", 4294967295U}}}};
    case Kind::Base64Floats:
    case Kind::Base64Indices:
      return {{"type", "string"}, {"contentEncoding", "base64"}};
    case Kind::Enum:
      return {{"type", "string"}, {"enum", type.enumerators}};
    case Kind::Object:
      return object(type);
    case Kind::Optional:  // inside an optional: may be null
      return {{"anyOf", ordered_json::array({schema_of(*type.element, range), {{"type", "null"}}})}};
    case Kind::List:
      return {{"type", "array"}, {"items", schema_of(*type.element, {})}};
    case Kind::Map:
      return {{"type", "object"}, {"additionalProperties", {{"type", "number"}}}};
    case Kind::Entries:
      return {{"type", "object"}, {"additionalProperties", schema_of(*type.element, {})}};
    case Kind::Value:
    case Kind::Json:
      return {{"type", "object"}};
  }
  return {};
}

}  // namespace

std::string json_schema(const TypeInfo& type, Range range) { return schema_of(type, range).dump(); }

}  // namespace tweend::protocol
