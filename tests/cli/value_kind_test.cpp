#include "clients/cli/value_kind.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "clients/cli/failure.hpp"

namespace tweend::cli {
namespace {

std::string why_not(const ValueKind& kind, const std::string& text) {
  try {
    return "it is read as " + kind.read(text).dump();
  } catch (const Usage& wrong) {
    return wrong.what();
  }
}

TEST(ValueKind, NumbersMayBeNegativeAndBare) {
  EXPECT_EQ(number().read("-1"), Json(-1.0));
  EXPECT_EQ(number().read(".5"), Json(0.5));
  EXPECT_EQ(number().read("1e-3"), Json(0.001));
}

TEST(ValueKind, NumbersAreFiniteAndWhole) {
  EXPECT_EQ(why_not(number(), "inf"), "expected a finite number, found 'inf'");
  EXPECT_EQ(why_not(number(), "1x"), "expected a number, found '1x'");
  EXPECT_EQ(why_not(number(), ""), "expected a number, found ''");
  EXPECT_EQ(why_not(integer(), "1.5"), "expected an integer, found '1.5'");
  EXPECT_EQ(why_not(count(), "-1"), "expected an integer that is not negative, found '-1'");
  EXPECT_EQ(why_not(seconds(), "-1"), "expected seconds, not negative, found '-1'");
}

TEST(ValueKind, ListsAreSeparatedByCommas) {
  EXPECT_EQ(numbers("X,Y,Z", {3}).read("-1,2.5,3"), (Json{-1.0, 2.5, 3.0}));
  EXPECT_EQ(integers("ID").read("3,-1"), (Json{3, -1}));
  EXPECT_EQ(integers("ID").read("3"), Json::array({3}));
}

TEST(ValueKind, ListsHaveTheRightLength) {
  EXPECT_EQ(why_not(numbers("X,Y,Z", {3}), "1,2"), "expected 3 numbers separated by commas, found '1,2'");
  EXPECT_EQ(why_not(numbers("", {2, 3}), "1"), "expected 2 or 3 numbers separated by commas, found '1'");
  EXPECT_EQ(why_not(numbers("", {3}), "1,,2"), "expected a number, found ''");
}

TEST(ValueKind, ListsMayHaveAnyLength) {
  EXPECT_EQ(any_numbers("W").read("1"), Json::array({1.0}));
  EXPECT_EQ(any_numbers("W").read("0,.5,-1"), (Json{0.0, 0.5, -1.0}));
  EXPECT_EQ(why_not(any_numbers("W"), "1,"), "expected a number, found ''");
}

TEST(ValueKind, JsonStandsThereOrInAFile) {
  std::istringstream in(R"({"a":2})");
  EXPECT_EQ(json_or_file(in).read(R"({"a":1})"), (Json{{"a", 1}}));
  EXPECT_EQ(json_or_file(in).read("@-"), (Json{{"a", 2}}));
  EXPECT_EQ(why_not(json_or_file(in), "{a"), "expected JSON, found '{a'");
  EXPECT_EQ(why_not(json_or_file(in), "@/no/such/file"), "can't read /no/such/file: No such file or directory");
}

TEST(ValueKind, WordsAreThoseOfTheShape) {
  EXPECT_EQ(word("once|repeat").read("repeat"), Json("repeat"));
  EXPECT_EQ(why_not(word("once|repeat"), "on"), "expected one of once, repeat, found 'on'");
}

TEST(ValueKind, NoneIsNull) {
  EXPECT_EQ(or_none(word("a|b")).read("none"), Json(nullptr));
  EXPECT_EQ(or_none(word("a|b")).read("b"), Json("b"));
  EXPECT_EQ(or_none(word("a|b")).shape, "a|b|none");
}

TEST(ValueKind, OneNumberScalesAllAxes) {
  EXPECT_EQ(scale().read("2"), (Json{2.0, 2.0, 2.0}));
  EXPECT_EQ(scale().read("1,2,3"), (Json{1.0, 2.0, 3.0}));
}

TEST(ValueKind, ATurnIsAQuaternion) {
  const Json half_turn = turn_y().read("3.141592653589793");
  EXPECT_DOUBLE_EQ(half_turn.at(1).get<double>(), 1.0);
  EXPECT_NEAR(half_turn.at(3).get<double>(), 0.0, 1e-15);
}

TEST(ValueKind, AnOrbitMayLeaveTheDistanceOut) {
  EXPECT_EQ(orbit().read("1,-0.5"), (Json{{"azimuth", 1.0}, {"elevation", -0.5}}));
  EXPECT_EQ(orbit().read("1,0,9").at("distance"), Json(9.0));
}

TEST(ValueKind, FilesMayBeStandardInput) {
  std::istringstream in(R"({"positions":[1]})");
  EXPECT_EQ(json_file(in).read("-"), (Json{{"positions", Json::array({1})}}));
}

TEST(ValueKind, UnreadableFilesSayWhy) {
  std::istringstream in("not json");
  EXPECT_EQ(why_not(json_file(in), "/no/such/file"), "can't read /no/such/file: No such file or directory");
  EXPECT_EQ(why_not(json_file(in), "/"), "can't read /: Is a directory");
  EXPECT_EQ(why_not(json_file(in), "-"), "expected JSON, found '-'");
}

}  // namespace
}  // namespace tweend::cli
