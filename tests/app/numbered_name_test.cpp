#include "server/app/numbered_name.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <limits>
#include <string>

namespace tweend::app {
namespace {

std::string named(const std::string& pattern, std::size_t number, bool several = true) {
  const auto name = numbered_name(pattern, number, several);
  EXPECT_TRUE(name) << pattern;
  return name ? *name : "";
}

/// What the refusal says was found.
std::string refusal(const std::string& pattern, bool several = true) {
  const auto name = numbered_name(pattern, 7, several);
  EXPECT_FALSE(name) << pattern;
  if (name) return {};
  EXPECT_EQ(name.error().code, ErrorCode::InvalidParams);
  EXPECT_NE(name.error().message.find("\"" + pattern + "\""), std::string::npos) << name.error().message;
  return name.error().message.substr(name.error().message.rfind("found "));
}

TEST(NumberedName, RefusesWhatIsNoNumberBehindAPercentSign) {
  EXPECT_EQ(refusal("a%x.png"), "found \"%x\"");
  EXPECT_EQ(refusal("a%s.png"), "found \"%s\"");
  EXPECT_EQ(refusal("a%4x.png"), "found \"%4x\"");
  EXPECT_EQ(refusal("a%04.png"), "found \"%04.\"");
  EXPECT_EQ(refusal("a%-4d.png"), "found \"%-\"");
  EXPECT_EQ(refusal("a% d.png"), "found \"% \"");
  EXPECT_EQ(refusal("a%4%.png"), "found \"%4%\"");
  EXPECT_EQ(refusal("a%x.png", false), "found \"%x\"") << "one picture is no excuse";
}

TEST(NumberedName, RefusesAPatternThatBreaksOff) {
  EXPECT_EQ(refusal("a%"), "found \"%\"");
  EXPECT_EQ(refusal("a%0"), "found \"%0\"");
  EXPECT_EQ(refusal("a%4"), "found \"%4\"");
  EXPECT_EQ(refusal("a%04"), "found \"%04\"");
  EXPECT_EQ(refusal("a%%%"), "found \"%\"");
}

TEST(NumberedName, RefusesWidthsOfTwoDigits) {
  EXPECT_EQ(refusal("%10d"), "found \"%10\"");
  EXPECT_EQ(refusal("%0004d"), "found \"%00\"");
}

TEST(NumberedName, RefusesSeveralNumbers) {
  EXPECT_EQ(refusal("%d-%d.png"), "found several");
  EXPECT_EQ(refusal("%04d/%4d.png", false), "found several");
}

TEST(NumberedName, RefusesSeveralPicturesOfOneName) {
  EXPECT_EQ(refusal("a.png"), "found none");
  EXPECT_EQ(refusal("100%%.png"), "found none");
  EXPECT_EQ(refusal(""), "found none");
}

TEST(NumberedName, LetsOnePictureHaveANameWithoutANumber) {
  EXPECT_EQ(named("a.png", 7, false), "a.png");
  EXPECT_EQ(named("a-%d.png", 7, false), "a-7.png");
}

TEST(NumberedName, PutsTheNumberWhereItIsAskedFor) {
  EXPECT_EQ(named("%d", 0), "0");
  EXPECT_EQ(named("frame-%d.png", 12), "frame-12.png");
  EXPECT_EQ(named("%d/of/a folder.jpg", 3), "3/of/a folder.jpg");
}

TEST(NumberedName, PadsAsPrintfDoes) {
  EXPECT_EQ(named("a%4d.png", 12), "a  12.png");
  EXPECT_EQ(named("a%04d.png", 12), "a0012.png");
  EXPECT_EQ(named("a%0d.png", 12), "a12.png");
  for (int width = 1; width <= 9; ++width) {
    const std::string digits = std::to_string(width);
    const std::string padding(static_cast<std::size_t>(width - 1), '0');
    EXPECT_EQ(named("%0" + digits + "d", 5), padding + "5");
    EXPECT_EQ(named("%" + digits + "d", 5), std::string(padding.size(), ' ') + "5");
  }
}

TEST(NumberedName, NeverCutsALargeNumber) {
  EXPECT_EQ(named("%04d", 123456), "123456");
  EXPECT_EQ(named("%2d", 123456), "123456");
  EXPECT_EQ(named("%d", std::numeric_limits<std::size_t>::max()), std::to_string(std::numeric_limits<std::size_t>::max()));
}

TEST(NumberedName, WritesAPercentSignForTwo) {
  EXPECT_EQ(named("100%%-%d.png", 1), "100%-1.png");
  EXPECT_EQ(named("%%d%d", 1), "%d1") << "the first two are a percent sign, and the d is a letter";
  EXPECT_EQ(named("%d%%", 1), "1%");
}

TEST(NumberedName, KeepsWhatIsNoAscii) { EXPECT_EQ(named("Bild_ä_%02d.png", 1), "Bild_ä_01.png"); }

}  // namespace
}  // namespace tweend::app
