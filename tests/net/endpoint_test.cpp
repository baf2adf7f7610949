#include <gtest/gtest.h>

#include "server/net/network.hpp"

namespace tweend::net {
namespace {

TEST(Endpoint, AddressesAndPortsAreRead) {
  const auto v4 = parse_endpoint("127.0.0.1:8933");
  ASSERT_TRUE(v4);
  EXPECT_EQ(v4->address, "127.0.0.1");
  EXPECT_EQ(v4->port, 8933);
  const auto v6 = parse_endpoint("[::1]:0");
  ASSERT_TRUE(v6);
  EXPECT_EQ(v6->address, "::1");
  EXPECT_EQ(v6->port, 0);
  const auto name = parse_endpoint("localhost:65535");
  ASSERT_TRUE(name);
  EXPECT_EQ(name->address, "127.0.0.1");
}

TEST(Endpoint, AnythingElseIsRefusedWithWhatWasFound) {
  for (const char* bad : {"", "8933", "127.0.0.1", "127.0.0.1:", "127.0.0.1:x", "127.0.0.1:65536", "127.0.0.1:-1",
                          "127.0.0.1:80 ", "example.org:80", ":80", "1.2.3:80"}) {
    const auto result = parse_endpoint(bad);
    ASSERT_FALSE(result) << bad;
    EXPECT_NE(result.error().message.find(std::string("\"") + bad + "\""), std::string::npos) << result.error().message;
  }
}

}  // namespace
}  // namespace tweend::net
