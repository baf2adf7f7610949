#include "server/assets/obj_scanner.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>

namespace tweend::assets {
namespace {

/// Every statement on a line of its own: the line of its first token, then its tokens in brackets.
std::string scan(std::string_view text) {
  ObjScanner scanner(text);
  std::string out;
  while (scanner.next_statement()) {
    bool first = true;
    for (std::string_view token = scanner.next_token(); !token.empty(); token = scanner.next_token()) {
      if (first) out += fmt::format("{}:", scanner.line());
      first = false;
      out += fmt::format("[{}]", token);
    }
    out += "\n";
  }
  return out;
}

TEST(ObjScanner, PartsStatementsAndTokens) {
  EXPECT_EQ(scan("v 1 2\nf a\n"), "1:[v][1][2]\n2:[f][a]\n");
  EXPECT_EQ(scan("\t v \t 1  \n"), "1:[v][1]\n");
}

TEST(ObjScanner, TextsOfNothingHaveNoStatement) {
  for (const char* text : {"", "\n", "\r\n\r\n", "  \t", "# only a comment", "\\\n", "\xEF\xBB\xBF", "#\\\n# b\n"})
    EXPECT_EQ(scan(text), "") << text;
}

TEST(ObjScanner, TheLastLineNeedsNoEnd) { EXPECT_EQ(scan("v 1\nv 2"), "1:[v][1]\n2:[v][2]\n"); }

TEST(ObjScanner, EveryLineEndCountsOnce) {
  const std::string expected = "1:[a]\n3:[b]\n4:[c]\n";
  EXPECT_EQ(scan("a\n\nb\nc"), expected);
  EXPECT_EQ(scan("a\r\n\r\nb\r\nc"), expected);
  EXPECT_EQ(scan("a\r\rb\rc"), expected);
}

TEST(ObjScanner, CommentsEndALine) {
  EXPECT_EQ(scan("# x\na 1 # 2\nb#c d\n"), "2:[a][1]\n3:[b]\n");
  EXPECT_EQ(scan("# C:\\models\\\na\n"), "2:[a]\n");  // a path in a comment swallows no line
}

TEST(ObjScanner, BackslashesContinueAStatement) {
  EXPECT_EQ(scan("f 1 \\\n 2 \\\r\n 3\ng\n"), "1:[f][1][2][3]\n4:[g]\n");
  EXPECT_EQ(scan("f 1\\\n2\n"), "1:[f][1][2]\n");
  EXPECT_EQ(scan("usemtl a\\b\n"), "1:[usemtl][a\\b]\n");
  EXPECT_EQ(scan("a \\"), "1:[a][\\]\n");
}

TEST(ObjScanner, LinesAreThoseOfTheTokenWithinAContinuedStatement) {
  ObjScanner scanner("f 1 \\\n2\n");
  ASSERT_TRUE(scanner.next_statement());
  EXPECT_EQ(scanner.next_token(), "f");
  EXPECT_EQ(scanner.next_token(), "1");
  EXPECT_EQ(scanner.line(), 1U);
  EXPECT_EQ(scanner.next_token(), "2");
  EXPECT_EQ(scanner.line(), 2U);
  EXPECT_EQ(scanner.next_token(), "");
  EXPECT_EQ(scanner.line(), 2U);
  EXPECT_FALSE(scanner.next_statement());
}

TEST(ObjScanner, SkipsTheTokensNobodyTook) {
  ObjScanner scanner("a 1 2 3\nb 4");
  ASSERT_TRUE(scanner.next_statement());
  EXPECT_EQ(scanner.next_token(), "a");
  ASSERT_TRUE(scanner.next_statement());
  EXPECT_EQ(scanner.next_token(), "b");
  EXPECT_FALSE(scanner.next_statement());
  EXPECT_FALSE(scanner.next_statement());
}

TEST(ObjScanner, TheRestOfAStatementIsANameAsItStands) {
  const auto rest_of = [](std::string_view text) {
    ObjScanner scanner(text);
    EXPECT_TRUE(scanner.next_statement());
    EXPECT_EQ(scanner.next_token(), "usemtl");
    const std::string rest = scanner.rest_of_statement();
    EXPECT_EQ(scanner.next_token(), "");
    return fmt::format("[{}]{}", rest, scanner.next_statement() ? fmt::format(" then {}", scanner.line()) : "");
  };
  EXPECT_EQ(rest_of("usemtl  red  wood\t\nf"), "[red  wood] then 2");
  EXPECT_EQ(rest_of("usemtl Material #25\r\nf"), "[Material #25] then 2");
  EXPECT_EQ(rest_of("usemtl #25"), "[#25]");
  EXPECT_EQ(rest_of("usemtl a\\b\rf"), "[a\\b] then 2");
  EXPECT_EQ(rest_of("usemtl a\\\n  b\nf"), "[a   b] then 3");
  EXPECT_EQ(rest_of("usemtl a\\"), "[a\\]");
  for (const char* nothing : {"usemtl", "usemtl  \t ", "usemtl \\\n \\\r\n"}) EXPECT_EQ(rest_of(nothing), "[]");
  EXPECT_EQ(rest_of("usemtl\n\nf"), "[] then 3");
}

TEST(ObjScanner, SkipsAByteOrderMark) { EXPECT_EQ(scan("\xEF\xBB\xBFv 1"), "1:[v][1]\n"); }

}  // namespace
}  // namespace tweend::assets
