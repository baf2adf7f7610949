#include "protocol/openrpc.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "tests/protocol/described.hpp"

namespace tweend::protocol {
namespace {

using nlohmann::json;

json document() {
  const std::array methods{
      MethodInfo{"a.make", "control", "Make \"it\".", &type_of<Whole>(), &type_of<One<std::int64_t>>()},
      MethodInfo{"a.list", "view", "List.", &type_of<None>(), &type_of<None>()},
  };
  return json::parse(openrpc_json(methods, "1.2.3"));
}

TEST(OpenRpc, HasWhatTheSpecificationRequires) {
  const json d = document();
  EXPECT_TRUE(d["openrpc"].get<std::string>().starts_with("1."));
  EXPECT_EQ(d["info"]["title"], "tweend");
  EXPECT_EQ(d["info"]["version"], "1.2.3");
  ASSERT_EQ(d["methods"].size(), 2U);
  for (const json& method : d["methods"]) {
    EXPECT_TRUE(method["name"].is_string());
    EXPECT_TRUE(method["params"].is_array());
    for (const json& param : method["params"]) {
      EXPECT_TRUE(param["name"].is_string());
      EXPECT_TRUE(param["schema"].is_object());
    }
    EXPECT_TRUE(method["result"]["name"].is_string());
    EXPECT_TRUE(method["result"]["schema"].is_object());
    EXPECT_EQ(method["paramStructure"], "by-name");
  }
}

TEST(OpenRpc, DescribesMethodsAndTheirRoles) {
  const json method = document()["methods"][0];
  EXPECT_EQ(method["name"], "a.make");
  EXPECT_EQ(method["summary"], "Make \"it\".");
  EXPECT_EQ(method["x-role"], "control");
  EXPECT_EQ(method["result"]["schema"]["properties"]["value"]["type"], "integer");
  EXPECT_EQ(document()["methods"][1]["params"], json::array());
}

TEST(OpenRpc, DescribesEachParameterWithItsOwnSchema) {
  const json params = document()["methods"][0]["params"];
  ASSERT_EQ(params.size(), 4U);
  EXPECT_EQ(params[0]["name"], "from");
  EXPECT_EQ(params[0]["required"], true);
  EXPECT_EQ(params[0]["description"], "Where it begins.");
  EXPECT_EQ(params[0]["schema"], json::parse(R"({"type":"number"})"));
  EXPECT_EQ(params[2]["name"], "transform");
  EXPECT_EQ(params[2]["required"], false);
  EXPECT_EQ(params[2]["schema"], json::parse(json_schema(type_of<Part>())));
  EXPECT_EQ(params[3]["schema"]["type"], "array");
}

TEST(OpenRpc, ListsTheErrors) {
  const json d = document();
  bool found = false;
  for (const json& error : d["x-errors"]) {
    EXPECT_TRUE(error["code"].is_number_integer());
    EXPECT_TRUE(error["message"].is_string());
    if (error["data"]["kind"] == "conflict") found = error["code"] == -32002;
  }
  EXPECT_TRUE(found);
}

}  // namespace
}  // namespace tweend::protocol
