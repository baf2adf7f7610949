#include "protocol/envelope.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/protocol/described.hpp"

namespace tweend::protocol {
namespace {

using std::string_literals::operator""s;

Message parse(const std::string& text, const Limits& limits = {}) { return parse_message(text, limits); }

const Request& request(const Message& message, std::size_t i = 0) { return std::get<Request>(message.items.at(i)); }
const Rejected& rejected(const Message& message, std::size_t i = 0) { return std::get<Rejected>(message.items.at(i)); }

void expect_rejected(const std::string& text, ErrorCode code, const std::string& id = "null") {
  const Message message = parse(text);
  SCOPED_TRACE(text);
  EXPECT_FALSE(message.batch);
  ASSERT_EQ(message.items.size(), 1U);
  ASSERT_TRUE(std::holds_alternative<Rejected>(message.items[0]));
  EXPECT_EQ(rejected(message).error.code, code) << rejected(message).error.message;
  EXPECT_EQ(rejected(message).id, id);
  EXPECT_FALSE(rejected(message).error.message.empty());
}

TEST(Envelope, TakesARequest) {
  const Message message = parse(R"({"jsonrpc":"2.0","id":7,"method":"a.b","params":{"from":1,"to":2}})");
  EXPECT_FALSE(message.batch);
  ASSERT_EQ(message.items.size(), 1U);
  EXPECT_EQ(request(message).id, "7");
  EXPECT_EQ(request(message).method, "a.b");
  EXPECT_EQ(decode<Whole>(request(message).params)->to, 2.0);
}

TEST(Envelope, TakesParamsThatAreLeftOutForNone) {
  const Message message = parse(R"({"jsonrpc":"2.0","id":1,"method":"m"})");
  EXPECT_TRUE(decode<None>(request(message).params));
}

TEST(Envelope, TakesTheMembersInAnyOrderAndOthersBesideThem) {
  const Message message = parse(R"( {"trace":"x","params":{},"method":"m","id":1,"jsonrpc":"2.0"} )");
  EXPECT_EQ(request(message).method, "m");
}

TEST(Envelope, GivesIdsBackAsTheyCame) {
  for (const auto& [id, back] :
       std::vector<std::pair<std::string, std::string>>{{"7", "7"},
                                                        {"-3", "-3"},
                                                        {"0", "0"},
                                                        {"9007199254740993", "9007199254740993"},
                                                        {"18446744073709551615", "18446744073709551615"},
                                                        {"1.5", "1.5"},
                                                        {"\"\"", "\"\""},
                                                        {"\"a\"", "\"a\""},
                                                        {"\"\\\"\\n\\u00e9\"", "\"\\\"\\n\u00e9\""},
                                                        {"null", "null"}}) {
    const Message message = parse(R"({"jsonrpc":"2.0","method":"m","id":)"s + id + "}");
    ASSERT_TRUE(std::holds_alternative<Request>(message.items[0])) << id;
    EXPECT_EQ(request(message).id, back);
  }
}

TEST(Envelope, TellsANotificationFromARequestWithANullId) {
  EXPECT_EQ(request(parse(R"({"jsonrpc":"2.0","method":"m"})")).id, "");
  EXPECT_EQ(request(parse(R"({"jsonrpc":"2.0","method":"m","id":null})")).id, "null");
}

TEST(Envelope, RefusesIdsOfOtherTypes) {
  for (const char* id : {"true", "[]", "{}", "[1]"}) {
    expect_rejected(R"({"jsonrpc":"2.0","method":"m","id":)"s + id + "}", ErrorCode::InvalidRequest);
  }
}

TEST(Envelope, AnswersTheExamplesOfTheSpecification) {
  // JSON-RPC 2.0, section 7; this server takes named parameters only.
  expect_rejected(R"({"jsonrpc": "2.0", "method": "subtract", "params": [42, 23], "id": 1})", ErrorCode::InvalidParams, "1");
  expect_rejected(R"({"jsonrpc": "2.0", "method": "foobar, "params": "bar", "baz])", ErrorCode::Parse);
  expect_rejected(R"({"jsonrpc": "2.0", "method": 1, "params": "bar"})", ErrorCode::InvalidRequest);
  expect_rejected(R"([
  {"jsonrpc": "2.0", "method": "sum", "params": [1,2,4], "id": "1"},
  {"jsonrpc": "2.0", "method"
])",
                  ErrorCode::Parse);
  expect_rejected("[]", ErrorCode::InvalidRequest);
  EXPECT_EQ(request(parse(R"({"jsonrpc": "2.0", "method": "subtract", "params": {"subtrahend": 23}, "id": 3})")).id, "3");
  EXPECT_EQ(request(parse(R"({"jsonrpc": "2.0", "method": "foobar"})")).id, "");
  EXPECT_EQ(request(parse(R"({"jsonrpc": "2.0", "method": "foobar", "id": "1"})")).id, "\"1\"");
}

TEST(Envelope, AnswersEveryItemOfABatchThatIsNoRequest) {
  for (const std::size_t count : {1U, 3U}) {
    const Message message = parse(count == 1 ? "[1]" : "[1,2,3]");
    EXPECT_TRUE(message.batch);
    ASSERT_EQ(message.items.size(), count);
    for (std::size_t i = 0; i < count; ++i) {
      EXPECT_EQ(rejected(message, i).error.code, ErrorCode::InvalidRequest);
      EXPECT_EQ(rejected(message, i).id, "null");
    }
  }
}

TEST(Envelope, TakesTheMixedBatchOfTheSpecification) {
  const Message message = parse(R"([
    {"jsonrpc": "2.0", "method": "sum", "params": {"a": 1}, "id": "1"},
    {"jsonrpc": "2.0", "method": "notify_hello", "params": {"to": 7}},
    {"foo": "boo"},
    {"jsonrpc": "2.0", "method": "foo.get", "params": {"name": "myself"}, "id": "5"},
    {"jsonrpc": "2.0", "method": "get_data", "id": "9"}
  ])");
  EXPECT_TRUE(message.batch);
  ASSERT_EQ(message.items.size(), 5U);
  EXPECT_EQ(request(message, 0).id, "\"1\"");
  EXPECT_EQ(request(message, 1).id, "");
  EXPECT_EQ(request(message, 1).method, "notify_hello");
  EXPECT_EQ(rejected(message, 2).error.code, ErrorCode::InvalidRequest);
  EXPECT_EQ(rejected(message, 2).id, "null");
  EXPECT_EQ(request(message, 3).method, "foo.get");
  EXPECT_EQ(request(message, 4).id, "\"9\"");
}

TEST(Envelope, KeepsTheIdOfWhatElseIsMalformed) {
  for (const char* rest :
       {R"("method":"m")", R"("jsonrpc":"1.0","method":"m")", R"("jsonrpc":2.0,"method":"m")", R"("jsonrpc":null,"method":"m")",
        R"("jsonrpc":"2.0")", R"("jsonrpc":"2.0","method":7)", R"("jsonrpc":"2.0","method":null)",
        R"("jsonrpc":"2.0","method":["m"])", R"("jsonrpc":"2.0","result":1)", R"("jsonrpc":"2.0","method":"m","params":5)",
        R"("jsonrpc":"2.0","method":"m","params":"x")", R"("jsonrpc":"2.0","method":"m","params":null)",
        R"("jsonrpc":"2.0","method":"m","params":true)"}) {
    expect_rejected("{\"id\":\"q\","s + rest + "}", ErrorCode::InvalidRequest, "\"q\"");
    expect_rejected("{"s + rest + "}", ErrorCode::InvalidRequest);
  }
}

TEST(Envelope, RefusesParamsByPositionAsInvalidParams) {
  expect_rejected(R"({"jsonrpc":"2.0","method":"m","params":[],"id":4})", ErrorCode::InvalidParams, "4");
  EXPECT_EQ(rejected(parse(R"({"jsonrpc":"2.0","method":"m","params":[1],"id":4})")).error.path, "params");
}

TEST(Envelope, DoesNotAnswerANotificationWithParamsByPosition) {
  // A notification it is: JSON-RPC allows arrays. Its parameters are invalid, and nobody is told.
  const Message message = parse(R"({"jsonrpc":"2.0","method":"m","params":[1,2]})");
  ASSERT_EQ(message.items.size(), 1U);
  EXPECT_EQ(rejected(message).error.code, ErrorCode::InvalidParams);
  EXPECT_EQ(rejected(message).id, "");
}

TEST(Envelope, RefusesValuesThatAreNoRequest) {
  for (const char* text : {"1", "\"text\"", "null", "true", "{}"}) expect_rejected(text, ErrorCode::InvalidRequest);
  for (const char* text : {"", "{", "nonsense", "{\"id\":1e400}"}) expect_rejected(text, ErrorCode::Parse);
}

TEST(Envelope, TakesBatchesUpToTheLimit) {
  Limits limits;
  limits.batch_requests = 3;
  const Message full = parse("[1,2,3]", limits);
  EXPECT_TRUE(full.batch);
  EXPECT_EQ(full.items.size(), 3U);
  const Message over = parse("[1,2,3,4]", limits);
  EXPECT_FALSE(over.batch);
  ASSERT_EQ(over.items.size(), 1U);
  EXPECT_EQ(rejected(over).error.code, ErrorCode::Limit);
  EXPECT_NE(rejected(over).error.message.find("3"), std::string::npos);
  EXPECT_NE(rejected(over).error.message.find("4"), std::string::npos);
}

TEST(Envelope, RefusesABatchInsideABatch) {
  const Message message = parse(R"([[{"jsonrpc":"2.0","method":"m","id":1}]])");
  EXPECT_TRUE(message.batch);
  EXPECT_EQ(rejected(message).error.code, ErrorCode::InvalidRequest);
}

TEST(Envelope, RefusesDeepMessagesByTheLimit) {
  Limits limits;
  limits.json_depth = 3;
  const std::string text = R"({"jsonrpc":"2.0","id":1,"method":"m","params":{"a":[[1]]}})";
  EXPECT_EQ(rejected(parse(text, limits)).error.code, ErrorCode::Limit);
  limits.json_depth = 4;
  EXPECT_TRUE(std::holds_alternative<Request>(parse(text, limits).items[0]));
}

TEST(Envelope, WritesAnswers) {
  EXPECT_EQ(answer_json("\"a\"", "{\"revision\":3}"), R"({"jsonrpc":"2.0","id":"a","result":{"revision":3}})");
  EXPECT_EQ(notification_json("scene.changed", "{\"scene\":\"main\"}"),
            R"({"jsonrpc":"2.0","method":"scene.changed","params":{"scene":"main"}})");
}

TEST(Envelope, WritesErrorsWithKindPathAndMessage) {
  Error error = fail(ErrorCode::InvalidParams, "expected \"a\"\nfound b", "params.x[\"y\"]");
  auto answer = nlohmann::json::parse(answer_json("7", error));
  EXPECT_EQ(answer["jsonrpc"], "2.0");
  EXPECT_EQ(answer["id"], 7);
  EXPECT_FALSE(answer.contains("result"));
  EXPECT_EQ(answer["error"]["code"], -32602);
  EXPECT_EQ(answer["error"]["message"], phrase(ErrorCode::InvalidParams));
  EXPECT_EQ(answer["error"]["data"],
            (nlohmann::json{{"kind", "invalid_params"}, {"path", "params.x[\"y\"]"}, {"message", "expected \"a\"\nfound b"}}));
}

TEST(Envelope, WritesPathAndRevisionOnlyWhereThereIsOne) {
  Error error = fail(ErrorCode::Conflict, "too old");
  error.revision = 12;
  auto data = nlohmann::json::parse(answer_json("null", error))["error"]["data"];
  EXPECT_EQ(data, (nlohmann::json{{"kind", "conflict"}, {"revision", 12}, {"message", "too old"}}));
  data = nlohmann::json::parse(answer_json("null", fail(ErrorCode::Internal, "")))["error"]["data"];
  EXPECT_EQ(data["message"], phrase(ErrorCode::Internal));
}

}  // namespace
}  // namespace tweend::protocol
