#include "clients/cli/format.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "clients/cli/bounds.hpp"

namespace tweend::cli {
namespace {

TEST(Format, NumbersAreShort) {
  EXPECT_EQ(number_text(1.0), "1");
  EXPECT_EQ(number_text(-0.0), "0");
  EXPECT_EQ(number_text(1.0 / 3.0), "0.333333");
}

TEST(Format, BytesHaveAUnitThatFits) {
  EXPECT_EQ(bytes_text(0), "0 B");
  EXPECT_EQ(bytes_text(999), "999 B");
  EXPECT_EQ(bytes_text(23'400), "23.4 kB");
  EXPECT_EQ(bytes_text(999'949), "999.9 kB");
  EXPECT_EQ(bytes_text(999'950), "1.0 MB");
  EXPECT_EQ(bytes_text(123'456'789'012'345'678U), "123456.8 TB");
}

TEST(Format, ControlCharactersNeverReachATerminal) { EXPECT_EQ(printable("a\x1b[2Jb\nc\x7f"), "a [2Jb c "); }

TEST(Format, BriefSaysAnyValueInFewWords) {
  EXPECT_EQ(brief({1.0, 2, "x"}), "1, 2, x");
  EXPECT_EQ(brief({{"eye", {0.0, 1.0}}, {"on", true}}), "eye (0, 1), on yes");
  EXPECT_EQ(brief(nullptr), "-");
  EXPECT_EQ(brief(Json::array()), "-");
  EXPECT_EQ(brief_member({{"a", 1}}, "b"), "-");
}

TEST(Format, SentencesTakeWordsFromResultThenParams) {
  EXPECT_EQ(sentence("{actor} has {vertices}", {{"actor", "box"}, {"vertices", 0}}, {{"vertices", 8}}), "box has 8");
  EXPECT_EQ(sentence("done", Json::object(), {{"revision", 4}}), "done (revision 4)");
}

TEST(Format, TablesAlignNumbersRightAndTextLeft) {
  Table table({"name", "n"});
  table.row({"bücher", "1"});
  table.row({"a", "-20"});
  std::ostringstream out;
  table.print(out);
  EXPECT_EQ(out.str(), "name      n\nbücher    1\na       -20\n");
}

TEST(Format, RowsHaveAColumnForEveryMember) {
  std::ostringstream out;
  print_rows(out, {{{"name", "a"}}, {{"name", "b"}, {"bytes", 12}}}, "nothing");
  EXPECT_EQ(out.str(), "name  bytes\na         -\nb        12\n");
}

TEST(Format, NoRowsAreASentence) {
  std::ostringstream out;
  print_rows(out, Json::array(), "no assets");
  EXPECT_EQ(out.str(), "no assets\n");
}

TEST(Format, BytesThatAreNoUtf8AreReplaced) { EXPECT_EQ(to_line("\xff"), "\"\xEF\xBF\xBD\""); }

TEST(Bounds, SpanAllPoints) {
  const std::array<float, 6> xyz{1.0F, -2.0F, 3.0F, 0.5F, 2.0F, 3.0F};
  EXPECT_EQ(bounds_text(xyz), "(0.5, -2, 3) to (1, 2, 3)");
  EXPECT_EQ(bounds_text({}), "-");
}

}  // namespace
}  // namespace tweend::cli
