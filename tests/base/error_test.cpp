#include "server/base/error.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <regex>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace tweend {
namespace {

using CodeAndKind = std::pair<int, std::string>;

constexpr std::array kAll{
#define TWEEND_ERROR(name, kind, code, phrase) ErrorCode::name,
#include "server/base/error_codes.def"
#undef TWEEND_ERROR
};

std::vector<std::string> matches(const std::string& text, const std::regex& pattern) {
  return {std::sregex_token_iterator(text.begin(), text.end(), pattern, 1), std::sregex_token_iterator()};
}

/// The rows of section 2's table: `| codes | meaning | kinds |`, with as many kinds as codes.
std::set<CodeAndKind> documented() {
  std::ifstream page(TWEEND_PROTOCOL_MD);
  std::set<CodeAndKind> rows;
  const std::regex row(R"(\|([^|]*-32\d{3}[^|]*)\|[^|]*\|([^|]*)\|)");
  const std::regex code(R"((-32\d{3}))");
  const std::regex kind("`([a-z_]+)`");
  for (std::string line; std::getline(page, line);) {
    std::smatch cells;
    if (!std::regex_match(line, cells, row)) continue;
    const auto codes = matches(cells[1].str(), code);
    const auto kinds = matches(cells[2].str(), kind);
    EXPECT_EQ(codes.size(), kinds.size()) << line;
    for (std::size_t i = 0; i < std::min(codes.size(), kinds.size()); ++i) rows.emplace(std::stoi(codes[i]), kinds[i]);
  }
  return rows;
}

TEST(ErrorTable, HasTheRowsOfTheProtocolPage) {
  std::set<CodeAndKind> ours;
  for (const ErrorCode code : kAll) ours.emplace(wire_code(code), std::string(wire_kind(code)));
  EXPECT_EQ(ours, documented());
}

TEST(ErrorTable, GivesNoCodeAndNoKindTwice) {
  std::set<int> codes;
  std::set<std::string_view> kinds;
  for (const ErrorCode code : kAll) {
    EXPECT_TRUE(codes.insert(wire_code(code)).second) << wire_code(code);
    EXPECT_TRUE(kinds.insert(wire_kind(code)).second) << wire_kind(code);
  }
}

TEST(ErrorTable, SaysSomethingOfEach) {
  std::set<std::string_view> phrases;
  for (const ErrorCode code : kAll) {
    EXPECT_GT(phrase(code).size(), 10U) << wire_kind(code);
    EXPECT_TRUE(phrases.insert(phrase(code)).second) << phrase(code);
  }
}

TEST(ErrorTable, UsesOnlyCodesThatJsonRpcLeavesToServersBesideItsOwn) {
  const std::set<int> reserved{-32700, -32600, -32601, -32602, -32603};
  for (const ErrorCode code : kAll) {
    const int number = wire_code(code);
    EXPECT_TRUE(reserved.contains(number) || (number >= -32099 && number <= -32000)) << number;
  }
}

TEST(ErrorTable, KeepsJsonRpcsOwnMeanings) {
  EXPECT_EQ(wire_code(ErrorCode::Parse), -32700);
  EXPECT_EQ(wire_code(ErrorCode::InvalidRequest), -32600);
  EXPECT_EQ(wire_code(ErrorCode::UnknownMethod), -32601);
  EXPECT_EQ(wire_code(ErrorCode::InvalidParams), -32602);
  EXPECT_EQ(wire_code(ErrorCode::Internal), -32603);
}

}  // namespace
}  // namespace tweend
