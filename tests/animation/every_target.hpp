#pragma once

#include <gtest/gtest.h>
#include <hwy/highway.h>

#include <cstdint>
#include <string>

namespace tweend::animation {

/// Runs a test with each kind of vector unit that this machine has and that the library was compiled for.
class EveryTarget : public testing::TestWithParam<std::int64_t> {
 protected:
  void SetUp() override {
    hwy::SetSupportedTargetsForTest(GetParam());
    hwy::GetChosenTarget().DeInit();  // choose anew at the next call
  }
  void TearDown() override {
    hwy::SetSupportedTargetsForTest(0);
    hwy::GetChosenTarget().DeInit();
  }
};

}  // namespace tweend::animation

// NOLINTNEXTLINE(cppcoreguidelines-macro-usage): GoogleTest's is one, too
#define TWEEND_ON_EVERY_TARGET(suite)                                                              \
  INSTANTIATE_TEST_SUITE_P(Targets, suite, testing::ValuesIn(hwy::SupportedAndGeneratedTargets()), \
                           [](const auto& target) { return std::string(hwy::TargetName(target.param)); })
