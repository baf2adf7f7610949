#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/cli/run_cli.hpp"

namespace tweend::cli {
namespace {

using test::answers;
using test::run_cli;

const Json kHipPose{{"hip", {{"translation", {1, 2, 3}}}}};

TEST(Pose, IsSetAsItStandsOrFromAFile) {
  const auto run = run_cli({answers("pose.set", {{"actor", "man"}, {"pose", kHipPose}}, Json::object())},
                           {"pose", "set", kHipPose.dump(), "--actor", "man"});
  EXPECT_EQ(run.code, ExitCode::Done) << run.err;
  EXPECT_EQ(run.out, "pose set\n");
  EXPECT_EQ(run_cli({answers("pose.set", {{"pose", kHipPose}}, Json::object())}, {"pose", "set", "@-"}, kHipPose.dump()).code,
            ExitCode::Done);
}

TEST(Pose, ThatIsNoJsonIsNeverSent) {
  const auto run = run_cli({}, {"pose", "set", "hip"});
  EXPECT_EQ(run.code, ExitCode::Usage);
  EXPECT_EQ(run.err, "tweenctl: POSE: expected JSON, found 'hip'\n");
}

TEST(Pose, IsCleared) {
  EXPECT_EQ(run_cli({answers("pose.clear", {{"scene", "two"}}, Json::object())}, {"--scene", "two", "pose", "clear"}).out,
            "pose cleared\n");
}

TEST(Pose, IsSampledRelativeToTheParents) {
  const Json hip{{"name", "hip"}, {"translation", {0, 1, 0}}, {"rotation", {0, 0, 0, 1}}, {"scale", {1, 1, 1}}};
  const Json result{{"time", 0.5}, {"joints", Json::array({hip})}, {"weights", {0.25, 0}}};
  const auto run = run_cli({answers("pose.sample", {{"time", 0.5}, {"clip", "walk"}}, result)},
                           {"pose", "sample", "--time", "0.5", "--clip", "walk"});
  EXPECT_EQ(run.code, ExitCode::Done) << run.err;
  EXPECT_NE(run.out.find("1 joint at 0.5 s\n"), std::string::npos) << run.out;
  EXPECT_NE(run.out.find("0, 0, 0, 1"), std::string::npos) << run.out;
  EXPECT_NE(run.out.find("weights 0.25, 0\n"), std::string::npos) << run.out;
}

TEST(Pose, IsSampledInTheModelAsPlaces) {
  const Json hip{{"name", "hip"}, {"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 7, 8, 9, 1}}};
  const Json result{{"time", 0}, {"joints", Json::array({hip})}, {"weights", Json::array()}};
  const auto run = run_cli({answers("pose.sample", {{"space", "model"}}, result)}, {"pose", "sample", "--space", "model"});
  EXPECT_EQ(run.code, ExitCode::Done) << run.err;
  EXPECT_NE(run.out.find("7, 8, 9\n"), std::string::npos) << run.out;
  EXPECT_EQ(run.out.find("weights"), std::string::npos);
}

}  // namespace
}  // namespace tweend::cli
