#include "server/net/same_origin.hpp"

#include <gtest/gtest.h>

namespace tweend::net {
namespace {

bool passes(const char* host, const std::optional<std::string>& origin = {}, const std::vector<std::string>& allowed = {}) {
  return refuse_origin(host, origin, allowed).empty();
}

TEST(SameOrigin, AddressesAndLocalhostAreKnownHosts) {
  EXPECT_TRUE(passes("127.0.0.1:8933"));
  EXPECT_TRUE(passes("127.0.0.1"));
  EXPECT_TRUE(passes("[::1]:8933"));
  EXPECT_TRUE(passes("[::1]"));
  EXPECT_TRUE(passes("localhost:1"));
  EXPECT_TRUE(passes("LOCALHOST"));
}

TEST(SameOrigin, OtherNamesMayPointHereToo) {  // DNS rebinding
  EXPECT_FALSE(passes("evil.example"));
  EXPECT_FALSE(passes("evil.example:8933"));
  EXPECT_FALSE(passes("127.0.0.1.evil.example"));
  EXPECT_FALSE(passes("localhost.evil.example:80"));
  EXPECT_FALSE(passes(""));
}

TEST(SameOrigin, ThePageItselfMaySpeak) {
  EXPECT_TRUE(passes("127.0.0.1:8933", "http://127.0.0.1:8933"));
  EXPECT_TRUE(passes("localhost:8933", "http://LOCALHOST:8933"));
  EXPECT_TRUE(passes("[::1]:8933", "http://[::1]:8933"));
}

TEST(SameOrigin, OtherPagesMayNot) {
  EXPECT_FALSE(passes("127.0.0.1:8933", "http://evil.example"));
  EXPECT_FALSE(passes("127.0.0.1:8933", "http://127.0.0.1:80")) << "another port is another origin";
  EXPECT_FALSE(passes("127.0.0.1:8933", "null"));
  EXPECT_FALSE(passes("127.0.0.1:8933", ""));
}

TEST(SameOrigin, AllowedOriginsPassAndNameTheirHost) {
  const std::vector<std::string> allowed{"https://studio.example"};
  EXPECT_TRUE(passes("127.0.0.1:8933", "https://studio.example", allowed));
  EXPECT_TRUE(passes("studio.example", std::nullopt, allowed));
  EXPECT_FALSE(passes("127.0.0.1:8933", "http://studio.example", allowed)) << "another scheme is another origin";
  EXPECT_FALSE(passes("other.example", std::nullopt, allowed));
}

TEST(SameOrigin, RefusalsSayWhatWasExpectedAndFound) {
  EXPECT_NE(refuse_origin("evil.example", {}, {}).find("evil.example"), std::string::npos);
  EXPECT_NE(refuse_origin("127.0.0.1", "null", {}).find("\"null\""), std::string::npos);
}

TEST(SameOrigin, HostsThatOnlyBeginLikeAnAddressAreNone) {
  for (const char* host : {"[::1]evil.example", "[::1].evil.example:80", "127.0.0.1evil.example", "[evil.example]:80", "[::1",
                           "::1]", "0x7f000001", "2130706433", "127.1", "localhost@evil.example", "evil.example:127.0.0.1"}) {
    EXPECT_FALSE(passes(host)) << host;
  }
}

TEST(SameOrigin, AnAllowedHostMayComeWithAPortButNotAsPartOfAnother) {
  const std::vector<std::string> allowed{"https://studio.example:444", "http://[2001:db8::1]"};
  EXPECT_TRUE(passes("studio.example:444", std::nullopt, allowed));
  EXPECT_TRUE(passes("STUDIO.example:8933", std::nullopt, allowed));
  EXPECT_TRUE(passes("studio.example:8933", "HTTPS://studio.example:444", allowed));
  EXPECT_FALSE(passes("studio.example:8933", "https://studio.example", allowed)) << "another port is another origin";
  EXPECT_FALSE(passes("notstudio.example", std::nullopt, allowed));
  EXPECT_FALSE(passes("studio.example.evil", std::nullopt, allowed));
  EXPECT_FALSE(passes("127.0.0.1:8933", "https://studio.example:444.evil", allowed));
  EXPECT_TRUE(passes("127.0.0.1:8933", "http://[2001:db8::1]", allowed));
}

TEST(SameOrigin, ARebindingPageHasItsOwnNameInBothHeaders) {
  EXPECT_FALSE(passes("evil.example:8933", "http://evil.example:8933"));
  EXPECT_FALSE(passes("evil.example:8933", "http://evil.example:8933", {"https://studio.example"}));
}

}  // namespace
}  // namespace tweend::net
