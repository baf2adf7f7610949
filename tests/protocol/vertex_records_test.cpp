#include "protocol/vertex_records.hpp"

#include <gtest/gtest.h>
#include <hwy/highway.h>
#include <hwy/targets.h>

#include <algorithm>
#include <random>
#include <vector>

namespace tweend::protocol {
namespace {

constexpr std::size_t kPlanes = VertexPlanes::kCount;

std::vector<BlockSteps> random_blocks(std::size_t count) {
  std::mt19937 random(5);
  std::vector<BlockSteps> blocks(count);
  for (BlockSteps& block : blocks) {
    for (auto& plane : block) std::generate(plane.begin(), plane.end(), [&] { return static_cast<std::uint16_t>(random()); });
  }
  return blocks;
}

/// Byte by byte, as the header says it.
std::vector<std::byte> sums_of(const std::vector<BlockSteps>& blocks, std::size_t vertices) {
  std::vector<std::byte> out(vertices * kResidualStride, std::byte{0});
  unsigned low[kPlanes]{}, high[kPlanes]{};
  for (std::size_t v = 0; v < vertices; ++v) {
    for (std::size_t k = 0; k < kPlanes; ++k) {
      const unsigned step = blocks[v / kBlockVertices][k][v % kBlockVertices];
      low[k] += step % 256;
      high[k] += step / 256;
      out[v * kResidualStride + k] = static_cast<std::byte>(low[k] % 256);
      out[v * kResidualStride + kPlanes + k] = static_cast<std::byte>(high[k] % 256);
    }
  }
  return out;
}

TEST(VertexRecords, AreSumsOfAllStepsBeforeOnEveryVectorUnitAndNothingBehindThem) {
  const std::vector<BlockSteps> blocks = random_blocks(3);
  constexpr std::byte kUntouched{0xA5};
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().DeInit();
    for (const std::size_t vertices : {1U, 2U, 7U, 8U, 9U, 15U, 16U, 17U, 255U, 256U, 257U, 511U, 512U, 600U, 768U}) {
      std::vector<std::byte> out(vertices * kResidualStride + 8, kUntouched);
      RecordSums sums{};
      for (std::size_t first = 0; first < vertices; first += kBlockVertices) {
        const std::size_t count = std::min(kBlockVertices, vertices - first);
        write_sums(blocks[first / kBlockVertices], sums,
                   std::span(out).subspan(first * kResidualStride, count * kResidualStride));
      }
      const std::vector<std::byte> expected = sums_of(blocks, vertices);
      EXPECT_TRUE(std::equal(expected.begin(), expected.end(), out.begin())) << vertices << " on " << hwy::TargetName(target);
      EXPECT_TRUE(std::all_of(out.end() - 8, out.end(), [](std::byte b) { return b == kUntouched; })) << vertices;
    }
  }
  hwy::SetSupportedTargetsForTest(0);
  hwy::GetChosenTarget().DeInit();
}

}  // namespace
}  // namespace tweend::protocol
