#include "clients/cli/endpoint.hpp"

#include <gtest/gtest.h>

#include "clients/cli/failure.hpp"

namespace tweend::cli {
namespace {

TEST(Endpoint, ReadsAddressAndPort) {
  EXPECT_EQ(parse_endpoint("10.0.0.1:99"), (Endpoint{"10.0.0.1", 99}));
  EXPECT_EQ(parse_endpoint("localhost:65535"), (Endpoint{"localhost", 65535}));
  EXPECT_EQ(parse_endpoint("[::1]:8080"), (Endpoint{"::1", 8080}));
}

TEST(Endpoint, TakesTheUsualPortWhereNoneIsGiven) {
  EXPECT_EQ(parse_endpoint("render-box"), (Endpoint{"render-box", kDefaultPort}));
  EXPECT_EQ(parse_endpoint("[fe80::1]"), (Endpoint{"fe80::1", kDefaultPort}));
}

TEST(Endpoint, RefusesWhatIsNoAddress) {
  for (const char* text : {"", ":", ":8933", "host:", "host:0", "host:65536", "host:-1", "host:1x", "host:x", "::1", "::1:8933",
                           "[::1", "[]:1", "[::1]8933", "[::1]:"}) {
    EXPECT_THROW((void)parse_endpoint(text), Usage) << text;
  }
}

TEST(Endpoint, IsWrittenTheWayItIsRead) {
  for (const char* text : {"127.0.0.1:8933", "[::1]:1"}) EXPECT_EQ(to_string(parse_endpoint(text)), text);
}

}  // namespace
}  // namespace tweend::cli
