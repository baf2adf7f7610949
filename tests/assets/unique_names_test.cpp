#include "server/assets/unique_names.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tweend::assets {
namespace {

using ::testing::ElementsAre;

std::vector<std::string> unique(std::vector<std::string> names) {
  return make_unique(std::move(names), [](std::size_t i) { return "node_" + std::to_string(i); });
}

TEST(UniqueNames, KeepWhatIsUniqueVerbatim) { EXPECT_THAT(unique({"a", "Ä b/c", "a_2"}), ElementsAre("a", "Ä b/c", "a_2")); }

TEST(UniqueNames, NumberRepetitions) {
  EXPECT_THAT(unique({"a", "a", "b", "a"}), ElementsAre("a", "a_2", "b", "a_3"));
  EXPECT_THAT(unique({"a", "a", "a_2", "a"}), ElementsAre("a", "a_3", "a_2", "a_4"));
}

TEST(UniqueNames, StandInForMissingOnes) {
  EXPECT_THAT(unique({"", "a", ""}), ElementsAre("node_0", "a", "node_2"));
  EXPECT_THAT(unique({"", "node_0"}), ElementsAre("node_0_2", "node_0"));
}

}  // namespace
}  // namespace tweend::assets
