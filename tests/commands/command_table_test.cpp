#include "server/commands/command_table.hpp"

#include <gtest/gtest.h>

#include <fstream>
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
    EXPECT_EQ(c.edit != nullptr, edit) << c.name;
    EXPECT_EQ(c.scene_edit != nullptr, c.shape == Shape::SceneEdit) << c.name;
    EXPECT_EQ(c.players != nullptr, c.shape == Shape::Players) << c.name;
    EXPECT_EQ(c.connection != nullptr, c.shape == Shape::Connection) << c.name;
    EXPECT_FALSE(c.summary.empty()) << c.name;
    EXPECT_EQ(c.params->kind, protocol::Kind::Object) << c.name;
    EXPECT_NE(c.result, nullptr) << c.name;
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

// Section 8: view describes, samples, streams and listens; admin makes and removes scenes; the rest is control.
TEST(CommandTable, RolesAreThoseOfTheProtocolPage) {
  for (const Command& c : command_table()) {
    const bool admin = c.name == "scene.create" || c.name == "scene.remove";
    const bool changes = c.is_edit() || c.shape == Shape::Players;
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

}  // namespace
}  // namespace tweend::commands
