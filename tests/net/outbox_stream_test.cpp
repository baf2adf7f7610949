#include "server/net/outbox_stream.hpp"

#include <gtest/gtest.h>

#include <array>
#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/read.hpp>
#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>

namespace tweend::net {
namespace {

namespace asio = boost::asio;

/// A connection to a client that reads when a test does.
class OutboxStreamTest : public ::testing::Test {
 protected:
  OutboxStreamTest() {
    Tcp::acceptor acceptor(io, {asio::ip::address_v4::loopback(), 0});
    client.connect(acceptor.local_endpoint());
    connection = std::make_shared<Connection>(acceptor.accept(), Framing::WebSocket, metrics);
  }

  void write(const std::string& unit) {
    outcome.reset();
    stream().async_write_some(asio::buffer(unit), [this](boost::system::error_code error, std::size_t) { outcome = error; });
  }
  OutboxStream stream() { return OutboxStream(connection); }
  /// Writes until one is not done though there is nothing else to do. @return bytes
  std::size_t write_until_held() {
    std::size_t bytes = 0;
    do {
      write(pong);
      bytes += pong.size();
      io.poll();
    } while (outcome && bytes < kFarTooMuch);
    return bytes;
  }
  /// Reads what comes until a condition holds. @return bytes
  std::size_t read_until(const std::function<bool(std::size_t)>& enough) {
    std::size_t bytes = 0;
    const auto more = [&](boost::system::error_code, std::size_t some) { bytes += some; };
    while (!enough(bytes)) {
      client.async_read_some(asio::buffer(room), more);
      if (io.run_one_for(std::chrono::seconds(30)) == 0) {
        ADD_FAILURE() << "nothing comes behind " << bytes << " bytes";
        break;
      }
      client.cancel();
      io.poll();
    }
    return bytes;
  }

  static constexpr std::size_t kFarTooMuch = std::size_t{64} << 20U;
  const std::string pong = "\x8A" + std::string(1, '\x7D') + std::string(125, 'x');
  asio::io_context io{1};
  asio::executor_work_guard<asio::io_context::executor_type> work{io.get_executor()};  // a poll that runs dry stops nothing
  Tcp::socket client{io};
  Metrics metrics;
  std::shared_ptr<Connection> connection;
  std::optional<boost::system::error_code> outcome;
  std::array<char, 65536> room;
};

TEST_F(OutboxStreamTest, AWriteIsDoneOnlyWhereTheClientReads) {
  const std::size_t sent = write_until_held();
  ASSERT_FALSE(outcome) << "64 MiB are held for a client that does not read";
  EXPECT_TRUE(connection->congested());
  const std::size_t got = read_until([this](std::size_t) { return outcome.has_value(); });
  ASSERT_TRUE(outcome);
  EXPECT_FALSE(*outcome);
  EXPECT_FALSE(connection->congested());
  const std::size_t rest = read_until([&](std::size_t bytes) { return got + bytes >= sent; });
  EXPECT_EQ(got + rest, sent) << "nothing is lost";
  connection->close();
}

TEST_F(OutboxStreamTest, AConnectionThatEndsLetsGoOfAWriteThatWaits) {
  static_cast<void>(write_until_held());
  ASSERT_FALSE(outcome);
  connection->close();
  io.poll();
  ASSERT_TRUE(outcome);
  EXPECT_EQ(*outcome, asio::error::operation_aborted);
}

TEST_F(OutboxStreamTest, NothingFollowsACloseFrame) {
  connection->send("before");
  write(close_frame(1000, "so long"));
  connection->send("after");
  write(pong);
  write(close_frame(1001, {}));
  io.poll();
  std::string wire(1000, '\0');
  boost::system::error_code error;
  wire.resize(asio::read(client, asio::buffer(wire), error));
  EXPECT_EQ(error, asio::error::eof) << "whoever reads to the end finds one";
  EXPECT_EQ(wire,
            "\x81\x06"
            "before\x88\x09\x03\xE8so long");
  connection->close();
}

}  // namespace
}  // namespace tweend::net
