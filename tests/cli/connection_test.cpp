#include "clients/cli/connection.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "clients/cli/failure.hpp"
#include "tests/cli/fake_server.hpp"

namespace tweend::cli {
namespace {

using test::answer;
using test::answers;
using test::FakeServer;

constexpr double kPatience = 20.0;  // seconds; only a broken test waits for it

Connection connect(const FakeServer& server) { return {parse_endpoint(server.address()), deadline_in(kPatience)}; }

std::string why_not(FakeServer& server) {
  Connection connection = connect(server);
  try {
    return connection.call("a", Json::object(), deadline_in(kPatience)).dump();
  } catch (const Failure& failure) {
    return failure.what();
  }
}

TEST(Connection, KeepsEventsAndPacketsThatComeBeforeTheAnswer) {
  protocol::PacketHeader header;
  header.sequence = 7;
  FakeServer server({{"a", Json::object(), test::event("one", {{"n", 1}}) + test::packet(header, {1.0F}) + answer({{"x", 2}})},
                     {"b", {{"y", 3}}, answer(4) + test::event("two", Json::object())}});
  Connection connection = connect(server);
  EXPECT_EQ(connection.call("a", Json::object(), deadline_in(kPatience)), (Json{{"x", 2}}));
  EXPECT_EQ(connection.call("b", {{"y", 3}}, deadline_in(kPatience)), Json(4));
  EXPECT_NE(connection.next({}).line.find("\"one\""), std::string::npos);
  const Message message = connection.next({});
  ASSERT_TRUE(message.packet);
  EXPECT_EQ(message.packet->header.sequence, 7U);
  EXPECT_EQ(message.packet->payload.size(), sizeof(float));
  EXPECT_NE(connection.next({}).line.find("\"two\""), std::string::npos);
}

TEST(Connection, FindsAServerByItsName) {
  FakeServer server({answers("a", Json::object(), 1)});
  Endpoint by_name = parse_endpoint(server.address());
  by_name.host = "localhost";
  Connection connection(by_name, deadline_in(kPatience));
  EXPECT_EQ(connection.call("a", Json::object(), deadline_in(kPatience)), Json(1));
}

TEST(Connection, ReadsLinesWithCarriageReturnsAndMegabytes) {
  const std::string large(3'000'000, 'x');
  FakeServer server({{"a", Json::object(),
                      R"({"jsonrpc":"2.0","id":$ID,"result":1})"
                      "\r\n"},
                     answers("b", Json::object(), large)});
  Connection connection = connect(server);
  EXPECT_EQ(connection.call("a", Json::object(), deadline_in(kPatience)), Json(1));
  EXPECT_EQ(connection.call("b", Json::object(), deadline_in(kPatience)), Json(large));
}

TEST(Connection, GoesOnReadingAfterATimeoutAmidAPacket) {
  const std::string whole = test::packet({}, {1.0F, 2.0F});
  const std::size_t half = whole.size() - 5;
  FakeServer server(
      {{"a", Json::object(), answer(1) + whole.substr(0, half)}, {"b", Json::object(), whole.substr(half) + answer(2)}});
  Connection connection = connect(server);
  EXPECT_EQ(connection.call("a", Json::object(), deadline_in(kPatience)), Json(1));
  EXPECT_THROW((void)connection.next(deadline_in(0.01)), TimedOut);
  EXPECT_EQ(connection.call("b", Json::object(), deadline_in(kPatience)), Json(2));
  const Message message = connection.next({});
  ASSERT_TRUE(message.packet);
  EXPECT_EQ(message.packet->payload.size(), 2 * sizeof(float));
}

TEST(Connection, TakesAnErrorWithoutIdForItsOwn) {
  FakeServer server({{"a", Json::object(),
                      R"({"jsonrpc":"2.0","id":null,"error":{"code":-32004,"message":"too long"}})"
                      "\n",
                      true}});
  EXPECT_EQ(why_not(server), "a refused (-32004): too long");
}

TEST(Connection, SaysThatTheConnectionWasLost) {
  FakeServer at_once({{"a", Json::object(), "", true}});
  EXPECT_EQ(why_not(at_once), "no answer to a: the connection was closed");
  FakeServer amid_line({{"a", Json::object(), R"({"jsonrpc":"2.)", true}});
  EXPECT_EQ(why_not(amid_line), "no answer to a: the connection was closed");
  FakeServer amid_packet({{"a", Json::object(), test::packet({}, {1.0F}).substr(0, 90), true}});
  EXPECT_EQ(why_not(amid_packet), "no answer to a: the connection was closed");
}

TEST(Connection, KnowsAnotherKindOfServer) {
  FakeServer server({{"a", Json::object(), "HTTP/1.1 400 Bad Request\r\n\r\n", true}});
  EXPECT_EQ(why_not(server), "no answer to a: what answers is no tweend server: it says 'HTTP/1.1 400 Bad Request'");
}

TEST(Connection, RefusesBrokenPackets) {
  FakeServer tiny({{"a", Json::object(), test::event("stream.packet", {{"stream", 1}, {"bytes", 3}})}});
  EXPECT_EQ(why_not(tiny), "no answer to a: the server announced a packet of 3 bytes");
  std::string bytes = test::packet({}, {1.0F});
  bytes[bytes.size() - 44] = 'x';
  FakeServer magic({{"a", Json::object(), bytes}});
  EXPECT_EQ(why_not(magic).rfind("no answer to a: a broken packet: expected a packet that starts with", 0), 0U);
}

TEST(Connection, GivesUpAtTheDeadline) {
  FakeServer server({{"a", Json::object(), ""}});
  Connection connection = connect(server);
  EXPECT_THROW((void)connection.call("a", Json::object(), deadline_in(0.01)), NoServer);
}

}  // namespace
}  // namespace tweend::cli
