#include "server/commands/command_table.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <sstream>
#include <string>

namespace tweend::commands {
namespace {

std::string protocol_page() {
  std::ifstream file(TWEEND_PROTOCOL_PAGE);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

TEST(CommandTable, NamesAreUniqueAndFound) {
  std::set<std::string_view> names;
  for (const Command& c : command_table()) {
    EXPECT_TRUE(names.insert(c.name).second) << c.name;
    EXPECT_EQ(find_command(c.name), &c);
  }
  EXPECT_GE(names.size(), 33U);
  EXPECT_EQ(find_command("no.such"), nullptr);
}

TEST(CommandTable, EveryMethodStandsOnTheProtocolPage) {
  const std::string page = protocol_page();
  ASSERT_FALSE(page.empty());
  for (const Command& c : command_table()) {
    // Families are written `keyframe.update` / `keyframe.move` / …, each name whole.
    EXPECT_NE(page.find("`" + std::string(c.name) + "`"), std::string::npos) << c.name;
  }
}

TEST(CommandTable, EveryRowHasTheHandlerOfItsShape) {
  for (const Command& c : command_table()) {
    const bool edit = c.shape == Shape::Edit || c.shape == Shape::HeavyEdit;
    const bool query = c.shape == Shape::Ping || c.shape == Shape::Query || c.shape == Shape::WorkerQuery;
    EXPECT_EQ(c.query != nullptr, query) << c.name;
    EXPECT_EQ(c.async_query != nullptr, c.shape == Shape::AsyncQuery) << c.name;
    EXPECT_EQ(c.edit != nullptr, edit) << c.name;
    EXPECT_EQ(c.scene_edit != nullptr, c.shape == Shape::SceneEdit) << c.name;
    EXPECT_EQ(c.players != nullptr, c.shape == Shape::Players) << c.name;
    EXPECT_EQ(c.connection != nullptr, c.shape == Shape::Connection) << c.name;
    EXPECT_FALSE(c.summary.empty()) << c.name;
    EXPECT_EQ(c.params->kind, protocol::Kind::Object) << c.name;
    EXPECT_NE(c.result, nullptr) << c.name;
  }
}

TEST(CommandTable, SchedulesPlaybackTheCameraAndActors) {
  for (const Command& c : command_table()) {
    const bool playback = c.name.starts_with("playback.") && c.name != "playback.get";
    EXPECT_EQ(c.timed != nullptr, playback || c.name == "camera.set" || c.name == "actor.update") << c.name;
  }
}

TEST(CommandTable, EveryParameterIsExplained) {
  for (const Command& c : command_table()) {
    for (const protocol::FieldInfo& f : c.params->fields) EXPECT_FALSE(f.doc.empty()) << c.name << " " << f.name;
  }
}

TEST(CommandTable, EditsTakeRevisionAndRetryKey) {
  for (const Command& c : command_table()) {
    if (!c.is_edit()) continue;
    std::set<std::string_view> names;
    for (const protocol::FieldInfo& f : c.params->fields) names.insert(f.name);
    EXPECT_TRUE(names.contains("base_revision") && names.contains("retry_key") && names.contains("scene")) << c.name;
  }
}

// Section 8: view describes, samples, streams and listens; admin makes and removes scenes, and exports; the rest is control.
TEST(CommandTable, RolesAreThoseOfTheProtocolPage) {
  for (const Command& c : command_table()) {
    const bool admin =
        c.name == "scene.create" || c.name == "scene.remove" || c.name == "asset.export" || c.name.starts_with("record.");
    const bool changes = c.is_edit() || c.shape == Shape::Players || c.name == "schedule.cancel";
    EXPECT_EQ(c.role, admin ? Role::Admin : changes ? Role::Control : Role::View) << c.name;
  }
}

TEST(CommandTable, UnknownParametersAreRefusedByEveryMethod) {
  const auto odd = protocol::JsonValue::parse(R"({"tiem":1})", Limits{});
  ASSERT_TRUE(odd);
  for (const Command& c : command_table()) {
    const auto decoded = decode_params(c, *odd);
    ASSERT_FALSE(decoded) << c.name;
    EXPECT_EQ(decoded.error().code, ErrorCode::InvalidParams);
    EXPECT_EQ(decoded.error().path, "params.tiem") << c.name;
  }
}

TEST(CommandTable, RetryKeysHaveOneToSixtyFourCharacters) {
  const Command& command = *find_command("edit.undo");
  const auto decode = [&](std::size_t length) {
    const auto json = protocol::JsonValue::parse(R"({"retry_key":")" + std::string(length, 'k') + "\"}", Limits{});
    return decode_params(command, *json);
  };
  EXPECT_FALSE(decode(0));
  EXPECT_TRUE(decode(1));
  EXPECT_TRUE(decode(64));
  ASSERT_FALSE(decode(65));
  EXPECT_EQ(decode(65).error().path, "params.retry_key");
}

TEST(CommandTable, TheOpenRpcDocumentNamesEveryMethodWithItsRole) {
  const std::string& document = *openrpc_document();
  for (const Command& c : command_table()) {
    EXPECT_NE(document.find("\"name\":\"" + std::string(c.name) + "\""), std::string::npos) << c.name;
  }
  EXPECT_NE(document.find("\"x-role\":\"admin\""), std::string::npos);
}

TEST(CommandTable, RetryKeysAreMeasuredInCharactersNotBytes) {
  std::string key;
  for (int i = 0; i < 64; ++i) key += "\u00e9";  // two bytes each
  const auto json = protocol::JsonValue::parse("{\"retry_key\":\"" + key + "\"}", Limits{});
  EXPECT_TRUE(decode_params(*find_command("edit.undo"), *json));
  const auto longer = protocol::JsonValue::parse("{\"retry_key\":\"" + key + "x\"}", Limits{});
  EXPECT_FALSE(decode_params(*find_command("edit.undo"), *longer));
}

using Json = nlohmann::json;

/// Every property at any depth: its path and its schema.
void each_property(const Json& schema, const std::string& path,
                   const std::function<void(const std::string&, const Json&)>& look) {
  for (const char* inside : {"items"}) {
    if (schema.contains(inside)) each_property(schema[inside], path, look);
  }
  if (schema.contains("anyOf")) {
    for (const Json& choice : schema["anyOf"]) each_property(choice, path, look);
  }
  if (!schema.contains("properties")) return;
  for (const auto& [name, property] : schema["properties"].items()) {
    look(path + "." + name, property);
    each_property(property, path + "." + name, look);
  }
}

TEST(CommandTable, EveryParamsSchemaIsValidAndExplainsAllOfItsProperties) {
  for (const Command& c : command_table()) {
    for (const protocol::TypeInfo* type : {c.params, c.result}) {
      const Json schema = Json::parse(protocol::json_schema(*type), nullptr, false);
      ASSERT_TRUE(schema.is_object()) << c.name;
      if (type == c.params) {
        EXPECT_EQ(schema["type"], "object") << c.name;
        EXPECT_EQ(schema["additionalProperties"], false) << c.name;
      }
      each_property(schema, std::string(c.name), [](const std::string& path, const Json& property) {
        EXPECT_TRUE(property.contains("description") && !property["description"].get<std::string>().empty()) << path;
      });
    }
  }
}

TEST(CommandTable, EveryParameterStandsOnTheProtocolPage) {
  const std::string page = protocol_page();
  for (const Command& c : command_table()) {
    each_property(Json::parse(protocol::json_schema(*c.params)), std::string(c.name),
                  [&](const std::string& path, const Json&) {
                    const std::string name = path.substr(path.rfind('.') + 1);
                    EXPECT_TRUE(std::regex_search(page, std::regex("\\b" + name + "\\b"))) << path;
                  });
  }
}

TEST(CommandTable, EachRoleIsThatOfSectionEight) {
  const std::map<std::string_view, Role> exceptions{{"scene.create", Role::Admin}, {"scene.remove", Role::Admin},
                                                    {"asset.export", Role::Admin}, {"store.backup", Role::Admin},
                                                    {"record.start", Role::Admin}, {"record.stop", Role::Admin},
                                                    {"record.list", Role::Admin}};
  const std::set<std::string_view> view_families{"server", "rpc", "stream", "events"};
  const std::set<std::string_view> view_verbs{"list", "describe", "get", "sample", "render"};
  for (const Command& c : command_table()) {
    const std::string_view family = c.name.substr(0, c.name.find('.')), verb = c.name.substr(c.name.find('.') + 1);
    const auto exception = exceptions.find(c.name);
    const Role expected = exception != exceptions.end()                                 ? exception->second
                          : view_families.contains(family) || view_verbs.contains(verb) ? Role::View
                                                                                        : Role::Control;
    EXPECT_EQ(role_name(c.role), role_name(expected)) << c.name;
  }
}

TEST(CommandTable, TheOpenRpcDocumentIsTheTable) {
  const Json document = Json::parse(*openrpc_document());
  ASSERT_EQ(document["methods"].size(), command_table().size());
  for (std::size_t i = 0; i < command_table().size(); ++i) {
    const Command& c = command_table()[i];
    const Json& method = document["methods"][i];
    EXPECT_EQ(method["name"], c.name);
    EXPECT_EQ(method["x-role"], role_name(c.role));
    EXPECT_EQ(method["summary"], c.summary);
    EXPECT_EQ(method["params"].size(), c.params->fields.size());
  }
}

TEST(CommandTable, PositiveFloatsStayPositive) {
  // 1e-50 is no 0 to JSON, but would be one as a float: a camera without a near plane.
  for (const char* name : {"near", "far"}) {
    const auto json = protocol::JsonValue::parse(std::string("{\"") + name + "\":1e-50}", Limits{});
    const auto decoded = decode_params(*find_command("camera.set"), *json);
    ASSERT_FALSE(decoded) << name;
    EXPECT_EQ(decoded.error().path, std::string("params.") + name);
  }
}

}  // namespace
}  // namespace tweend::commands
