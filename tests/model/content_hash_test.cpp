#include "server/model/content_hash.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <set>
#include <string>
#include <vector>

namespace tweend::model {
namespace {

std::vector<std::byte> bytes(const std::string& text) {
  const auto* begin = reinterpret_cast<const std::byte*>(text.data());
  return {begin, begin + text.size()};
}

TEST(ContentHash, IsThatOfTheAlgorithmOnEveryMachine) {
  // XXH3, 128 bits, without a seed: the published value for no input, canonical (big-endian) order.
  EXPECT_EQ(to_string(hash_bytes({})), "99aa06d3014798d86001c324468d497f");
}

TEST(ContentHash, TellsApartWhatDiffersInOneBitOrInLength) {
  std::set<std::string> names;
  std::vector<std::byte> content = bytes(std::string(300, 'x'));
  names.insert(to_string(hash_bytes(content)));
  for (std::size_t i = 0; i < content.size(); ++i) {
    for (int bit = 0; bit < 8; ++bit) {
      content[i] ^= static_cast<std::byte>(1 << bit);
      names.insert(to_string(hash_bytes(content)));
      content[i] ^= static_cast<std::byte>(1 << bit);
    }
  }
  while (!content.empty()) {
    content.pop_back();
    names.insert(to_string(hash_bytes(content)));
  }
  EXPECT_EQ(names.size(), 1U + 300U * 8U + 300U);
}

TEST(ContentHash, IsWrittenAsThirtyTwoDigits) {
  EXPECT_EQ(to_string(ContentHash{0, 0}), std::string(32, '0'));
  EXPECT_EQ(to_string(ContentHash{0x0123456789ABCDEFU, 1}), "0123456789abcdef0000000000000001");
}

}  // namespace
}  // namespace tweend::model
