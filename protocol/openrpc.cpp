#include "protocol/openrpc.hpp"

#include <nlohmann/json.hpp>

namespace tweend::protocol {
namespace {

using nlohmann::ordered_json;

ordered_json parameters(const TypeInfo& params) {
  ordered_json list = ordered_json::array();
  for (const FieldInfo& field : params.fields) {
    const TypeInfo& inner = field.type->kind == Kind::Optional ? *field.type->element : *field.type;
    list.push_back({{"name", field.name},
                    {"description", field.doc},
                    {"required", field.required},
                    {"schema", ordered_json::parse(json_schema(inner, field.range))}});
  }
  return list;
}

ordered_json error_list() {
  return ordered_json::array({
#define TWEEND_ERROR(name, kind, number, phrase) \
  ordered_json{{"code", number}, {"message", phrase}, {"data", {{"kind", kind}}}},
#include "server/base/error_codes.def"
#undef TWEEND_ERROR
  });
}

}  // namespace

std::string openrpc_json(std::span<const MethodInfo> methods, std::string_view server_version) {
  ordered_json list = ordered_json::array();
  for (const MethodInfo& m : methods) {
    list.push_back({{"name", m.name},
                    {"summary", m.summary},
                    {"x-role", m.role},
                    {"paramStructure", "by-name"},
                    {"params", parameters(*m.params)},
                    {"result", {{"name", m.result->name}, {"schema", ordered_json::parse(json_schema(*m.result))}}}});
  }
  const ordered_json document{
      {"openrpc", "1.3.2"},
      {"info",
       {{"title", "tweend"},
        {"version", server_version},
        {"description", "Headless keyframe-animation playback server; JSON-RPC 2.0 over line JSON, WebSocket and HTTP."},
        {"license", {{"name", "Apache-2.0"}}}}},
      {"methods", std::move(list)},
      {"x-errors", error_list()}};
  return document.dump();
}

}  // namespace tweend::protocol
