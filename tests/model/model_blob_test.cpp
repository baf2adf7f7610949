#include "server/model/model_blob.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <random>

namespace tweend::model {
namespace {

template <class T>
T must(Result<T> result) {
  if (!result) throw std::runtime_error(result.error().message);
  return std::move(*result);
}

MeshPtr textured_square() {
  Surface surface;
  Material painted;
  painted.name = "painted";
  painted.base_color_texture = must(Image::make(1, 2, {1, 2, 3, 4, 5, 6, 7, 8}));
  painted.wrap_v = TextureWrap::ClampToEdge;
  painted.alpha = 0.5F;
  painted.alpha_cutoff = 0.25F;
  painted.unlit = true;
  surface.materials = {painted, Material{}};
  surface.parts = {{0, 3, 1}, {3, 3, 0}};
  return must(Mesh::make(4, {0, 1, 2, 0, 2, 3}, {0, 0, 1, 0, 1, 1, 0, 1}, surface, std::vector<float>(16, 0.5F)));
}

/// A skinned square with two morph targets and a clip of poses.
ImportedModel skinned() {
  const MeshPtr mesh = textured_square();
  const VertexKeyPtr rest = must(VertexKey::make(*mesh, std::vector<float>{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0},
                                                 std::vector<float>{1, 2, 3, 0.1F, 0.2F, 0.3F, 7, 8, 9, 0, 0, 1}));
  const SkeletonPtr skeleton =
      must(Skeleton::make({{"hip", -1, {}}, {"Ä", 0, {{1, 2, 3}, glm::quat(0.6F, 0.8F, 0, 0), {1, 2, 1}}}}));
  const SkinPtr skin =
      must(Skin::make({{0, {}}, {1, {}}}, 4, std::vector<std::uint16_t>(16, 1),
                      {0.3F, 0.3F, 0.1F, 0.7F, 1, 0, 0, 0, 0, 0, 0, 0, 0.2F, 0.2F, 0.2F, 0.2F}, rest->positions()));
  std::vector<MorphTarget> targets(2);
  targets[0] = {"smile", 0.25F, 1, {0, 0, 1, 0, 0, 2}, {}, {1, 0, 0, 1, 0, 0}};
  targets[1].name = "frown";
  const MorphTargetsPtr morphs = must(MorphTargets::make(std::move(targets), 4));
  Clip clip;
  clip.name = "walk";
  clip.settings = {true, 5.0, animation::Interpolation::CatmullRom};
  clip.times_s = {0.5, 1.25};
  const animation::Channel turn{1, animation::Property::Rotation}, weight{1, animation::Property::Weight};
  clip.keyframes = {{0,
                     {},
                     {},
                     nullptr,
                     std::make_shared<const PoseKey>(std::vector<KeyedValue>{{turn, {0, 0, 0, 1}}, {weight, {0.5F, 0, 0, 0}}})},
                    {0, animation::Interpolation::Step, animation::CubicBezier{0.1, 0.2, 0.3, 0.4}, nullptr,
                     std::make_shared<const PoseKey>(std::vector<KeyedValue>{{turn, {1, 0, 0, 0}}},
                                                     std::vector<KeyedTangents>{{glm::vec4(1), glm::vec4(2)}})}};
  clip.channel_modes = std::make_shared<const std::vector<ChannelMode>>(
      std::vector<ChannelMode>{{turn, animation::Interpolation::Cubic}, {weight, animation::Interpolation::Step}});
  auto model = std::make_shared<const Model>(Model{mesh, rest, skeleton, skin, morphs});
  return {"a.glb", std::move(model), {clip}, {"first", "second"}};
}

/// A square that its vertices' keyframes move.
ImportedModel moving() {
  const MeshPtr mesh = must(Mesh::make(3, {0, 1, 2}));
  Clip clip;
  clip.name = "default";
  for (const float x : {0.0F, 1.0F}) {
    clip.times_s.push_back(x);
    clip.keyframes.push_back({0, {}, {}, must(VertexKey::make(*mesh, std::vector<float>{x, 0, 0, 1, 0, 0, 0, 1, 0})), nullptr});
  }
  auto model = std::make_shared<const Model>(Model{mesh, clip.keyframes[0].vertices, {}, {}, {}});
  return {"s", std::move(model), {clip}, {}};
}

void expect_same(const Clip& a, const Clip& b) {
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.settings, b.settings);
  EXPECT_EQ(a.declared_type, b.declared_type);
  EXPECT_EQ(a.times_s, b.times_s);
  ASSERT_EQ(a.keyframes.size(), b.keyframes.size());
  for (std::size_t i = 0; i < a.keyframes.size(); ++i) {
    EXPECT_EQ(a.keyframes[i].interpolation, b.keyframes[i].interpolation);
    EXPECT_EQ(a.keyframes[i].easing, b.keyframes[i].easing);
    if (a.keyframes[i].pose) {
      EXPECT_EQ(a.keyframes[i].pose->hash(), b.keyframes[i].pose->hash());
    }
    if (a.keyframes[i].vertices) {
      EXPECT_EQ(a.keyframes[i].vertices->hash(), b.keyframes[i].vertices->hash());
    }
  }
  ASSERT_EQ(a.channel_modes != nullptr, b.channel_modes != nullptr);
  if (a.channel_modes) {
    EXPECT_EQ(*a.channel_modes, *b.channel_modes);
  }
}

TEST(ModelBlob, ComesBackTheSame) {
  const ImportedModel before = skinned();
  const ImportedModel after = must(read_model_blob(write_model_blob(before).bytes));
  EXPECT_EQ(after.source, "a.glb");
  EXPECT_EQ(after.warnings, before.warnings);
  EXPECT_EQ(after.model->mesh->hash(), before.model->mesh->hash());
  EXPECT_EQ(after.model->rest->hash(), before.model->rest->hash());
  EXPECT_EQ(after.model->rest->bounds(), before.model->rest->bounds());
  EXPECT_EQ(after.model->skeleton->hash(), before.model->skeleton->hash());
  EXPECT_EQ(after.model->skin->hash(), before.model->skin->hash());
  EXPECT_EQ(after.model->morphs->hash(), before.model->morphs->hash());
  ASSERT_EQ(after.clips.size(), 1U);
  expect_same(after.clips[0], before.clips[0]);
}

TEST(ModelBlob, SharesVerticesAgain) {
  const ImportedModel before = moving();
  const ImportedModel after = must(read_model_blob(write_model_blob(before).bytes));
  EXPECT_EQ(after.model->rest, after.clips[0].keyframes[0].vertices);
  EXPECT_EQ(after.model->skeleton, nullptr);
  expect_same(after.clips[0], before.clips[0]);
}

TEST(ModelBlob, HoldsASkeletonAlone) {
  auto model = std::make_shared<const Model>(Model{{}, {}, must(Skeleton::make({{"a", -1, {}}})), {}, {}});
  const ImportedModel after = must(read_model_blob(write_model_blob({"x", std::move(model), empty_clips(), {}}).bytes));
  EXPECT_EQ(after.model->mesh, nullptr);
  EXPECT_EQ(after.clips[0].name, "default");
}

TEST(ModelBlob, RefusesEveryCut) {
  const std::string bytes = write_model_blob(skinned()).bytes;
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    const auto read = read_model_blob(std::string_view(bytes).substr(0, size));
    ASSERT_FALSE(read) << size;
    EXPECT_EQ(read.error().code, ErrorCode::BadAsset);
  }
  EXPECT_FALSE(read_model_blob(bytes + "more"));
}

TEST(ModelBlob, SurvivesAnyByte) {
  for (const ImportedModel& imported : {skinned(), moving()}) {
    const std::string bytes = write_model_blob(imported).bytes;
    for (std::size_t i = 0; i < bytes.size(); ++i) {
      for (const int value : {0x00, 0x01, 0x7F, 0x80, 0xFF}) {
        std::string other = bytes;
        other[i] = static_cast<char>(value);
        const auto read = read_model_blob(other);  // read or refused; what is read can be written
        if (read) {
          EXPECT_FALSE(write_model_blob(*read).bytes.empty());
        }
      }
    }
  }
}

TEST(ModelBlob, RefusesAnotherVersion) {
  std::string bytes = write_model_blob(moving()).bytes;
  bytes[4] = 9;
  const auto read = read_model_blob(bytes);
  ASSERT_FALSE(read);
  EXPECT_NE(read.error().message.find("version 9"), std::string::npos);
}

}  // namespace
}  // namespace tweend::model
