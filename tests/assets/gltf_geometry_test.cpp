// Accessors, primitives and materials, through the whole reader.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <meshoptimizer.h>

#include <cmath>

#include "tests/assets/sample_gltf.hpp"
#include "tests/assets/sample_images.hpp"

namespace tweend::assets {
namespace {

using ::testing::ElementsAre;
using ::testing::ElementsAreArray;
using ::testing::FloatNear;
using ::testing::HasSubstr;
using ::testing::Pointwise;

Json& primitive(GltfBuilder& b) { return b.json["meshes"][0]["primitives"][0]; }
Json& attributes(GltfBuilder& b) { return primitive(b)["attributes"]; }

TEST(GltfAccessors, ReadInterleavedViews) {
  GltfBuilder b = triangle_gltf();
  // x y z nx ny nz for each of three vertices
  const std::size_t view = b.view<float>({0, 0, 0, 0, 0, 1, 2, 0, 0, 0, 0, 1, 0, 2, 0, 0, 0, 1});
  b.json["bufferViews"][view]["byteStride"] = 24;
  for (const int offset : {0, 12}) {
    b.json["accessors"].push_back(
        {{"bufferView", view}, {"byteOffset", offset}, {"componentType", 5126}, {"count", 3}, {"type", "VEC3"}});
    attributes(b)[offset == 0 ? "POSITION" : "NORMAL"] = b.json["accessors"].size() - 1;
  }
  const model::ImportedModel m = must_read(b);
  EXPECT_THAT(m.model->rest->positions(), ElementsAre(0, 0, 0, 2, 0, 0, 0, 2, 0));
  EXPECT_THAT(m.model->rest->normals(), ElementsAre(0, 0, 1, 0, 0, 1, 0, 0, 1));
}

TEST(GltfAccessors, ReadSparseOnes) {
  GltfBuilder b = triangle_gltf();
  Json& position = b.json["accessors"][0];
  position["sparse"] = {{"count", 2},
                        {"indices", {{"bufferView", b.view<std::uint8_t>({0, 2})}, {"componentType", 5121}}},
                        {"values", {{"bufferView", b.view<float>({7, 8, 9, 4, 5, 6})}}}};
  EXPECT_THAT(must_read(b).model->rest->positions(), ElementsAre(7, 8, 9, 1, 0, 0, 4, 5, 6));
  b.json["accessors"][0].erase("bufferView");
  EXPECT_THAT(must_read(b).model->rest->positions(), ElementsAre(7, 8, 9, 0, 0, 0, 4, 5, 6)) << "zeros without a view";
}

template <class T>
std::vector<float> quantized(const std::vector<T>& values, bool normalized) {
  GltfBuilder b = triangle_gltf();
  b.json["extensionsUsed"] = Json::array({"KHR_mesh_quantization"});
  b.json["extensionsRequired"] = b.json["extensionsUsed"];
  attributes(b)["POSITION"] = b.accessor("VEC3", values, normalized);
  if (values.size() * sizeof(T) / 3 % 4 != 0) {  // as vertices have to lie: on multiples of 4
    std::vector<T> padded;
    for (std::size_t i = 0; i < values.size(); i += 3) {
      padded.insert(padded.end(), {values[i], values[i + 1], values[i + 2], T{0}});
    }
    const std::size_t view = b.view(padded);
    b.json["bufferViews"][view]["byteStride"] = 4 * sizeof(T);
    b.json["accessors"].back()["bufferView"] = view;
  }
  const auto m = must_read(b);
  const auto p = m.model->rest->positions();
  return {p.begin(), p.end()};
}

TEST(GltfAccessors, ReadEveryComponentType) {
  // The factors are those of the specification's table in section 3.11.
  EXPECT_THAT(quantized<std::int8_t>({-128, 127, 0, 1, 2, 3, 4, -5, 6}, false), ElementsAre(-128, 127, 0, 1, 2, 3, 4, -5, 6));
  EXPECT_THAT(
      quantized<std::int8_t>({-128, 127, 0, 1, -127, 3, 4, -5, 6}, true),
      Pointwise(FloatNear(1e-6F), {-1.0F, 1.0F, 0.0F, 1 / 127.0F, -1.0F, 3 / 127.0F, 4 / 127.0F, -5 / 127.0F, 6 / 127.0F}));
  EXPECT_THAT(
      quantized<std::uint8_t>({0, 255, 51, 1, 2, 3, 9, 5, 6}, true),
      Pointwise(FloatNear(1e-6F), {0.0F, 1.0F, 0.2F, 1 / 255.0F, 2 / 255.0F, 3 / 255.0F, 9 / 255.0F, 5 / 255.0F, 6 / 255.0F}));
  EXPECT_THAT(quantized<std::int16_t>({-32768, 32767, 0, 1, 2, 3, 4, -5, 6}, false),
              ElementsAre(-32768, 32767, 0, 1, 2, 3, 4, -5, 6));
  EXPECT_FLOAT_EQ(quantized<std::int16_t>({-32768, 32767, 0, 1, 2, 3, 4, -5, 6}, true)[0], -1.0F);
  EXPECT_FLOAT_EQ(quantized<std::uint16_t>({13107, 0, 0, 1, 2, 3, 4, 65535, 6}, true)[0], 0.2F);
  EXPECT_FLOAT_EQ(quantized<std::uint16_t>({13107, 0, 0, 1, 2, 3, 4, 65535, 6}, false)[7], 65535.0F);
}

std::vector<std::uint32_t> triangles(int mode, const std::vector<std::uint32_t>& indices) {
  GltfBuilder b = triangle_gltf();
  attributes(b)["POSITION"] = b.accessor<float>("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 2, 0});
  primitive(b)["mode"] = mode;
  if (!indices.empty()) primitive(b)["indices"] = b.accessor("SCALAR", indices);
  attributes(b)["NORMAL"] = b.accessor("VEC3", std::vector<float>(15, 1.0F));
  const auto m = must_read(b);
  const auto i = m.model->mesh->indices();
  return {i.begin(), i.end()};
}

TEST(GltfPrimitives, StripsAndFansBecomeTriangles) {
  EXPECT_THAT(triangles(5, {}), ElementsAre(0, 1, 2, 1, 3, 2, 2, 3, 4));
  EXPECT_THAT(triangles(6, {}), ElementsAre(1, 2, 0, 2, 3, 0, 3, 4, 0));
  EXPECT_THAT(triangles(5, {4, 3, 2, 1}), ElementsAre(4, 3, 2, 3, 1, 2));
  EXPECT_THAT(triangles(4, {4, 3, 2}), ElementsAre(4, 3, 2));
}

TEST(GltfPrimitives, PointsAndLinesArePassedOver) {
  GltfBuilder b = triangle_gltf();
  primitive(b)["mode"] = 1;
  const model::ImportedModel m = must_read(b);
  EXPECT_EQ(m.model->mesh, nullptr);
  EXPECT_EQ(m.model->skin, nullptr);
  EXPECT_EQ(m.model->joint_count(), 1U);
  ASSERT_EQ(m.warnings.size(), 1U);
  EXPECT_THAT(m.warnings[0], HasSubstr("/meshes/0/primitives/0"));
}

TEST(GltfPrimitives, StandBehindEachOther) {
  GltfBuilder b = triangle_gltf();
  Json second = primitive(b);
  second["attributes"]["TEXCOORD_0"] = b.accessor<float>("VEC2", {0, 0, 1, 0, 0, 0.25F});
  second["attributes"]["COLOR_0"] = b.accessor<std::uint8_t>("VEC4", {255, 0, 51, 255, 0, 0, 0, 0, 255, 255, 255, 255}, true);
  second["material"] = 0;
  b.json["materials"] = Json::parse(R"([{"name":"red","pbrMetallicRoughness":{"baseColorFactor":[0.5,0,1,0.25]},
      "alphaMode":"MASK","alphaCutoff":0.75,"extensions":{"KHR_materials_unlit":{}}}])");
  b.json["meshes"][0]["primitives"].push_back(second);
  const model::ImportedModel m = must_read(b);
  const model::Mesh& mesh = *m.model->mesh;
  EXPECT_THAT(mesh.indices(), ElementsAre(0, 1, 2, 3, 4, 5));
  EXPECT_THAT(mesh.texcoords(), ElementsAre(0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 0, 0.75F)) << "v upwards";
  EXPECT_THAT(mesh.colors().first(12), ElementsAreArray(std::vector<float>(12, 1.0F)));
  EXPECT_FLOAT_EQ(mesh.colors()[14], 0.2F);
  ASSERT_EQ(mesh.surface().materials.size(), 2U);
  EXPECT_EQ(mesh.surface().materials[0].base_color, glm::vec3(1.0F)) << "the format's default";
  const model::Material& red = mesh.surface().materials[1];
  EXPECT_EQ(red.name, "red");
  EXPECT_NEAR(red.base_color.x, 0.735357, 1e-5) << "sRGB of half the light";
  EXPECT_EQ(red.base_color.z, 1.0F);
  EXPECT_EQ(red.alpha, 0.25F);
  EXPECT_EQ(red.alpha_cutoff, 0.75F);
  EXPECT_TRUE(red.unlit);
  EXPECT_EQ(mesh.surface().parts[1], (model::MeshPart{3, 3, 1}));
}

TEST(GltfPrimitives, OneWithoutNormalsIsFlat) {
  GltfBuilder b = triangle_gltf();
  // Two triangles at a right angle, and a morph target that lifts vertex 1, which both share.
  attributes(b)["POSITION"] = b.accessor<float>("VEC3", {0, 0, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1});
  primitive(b)["indices"] = b.accessor<std::uint8_t>("SCALAR", {0, 2, 1, 0, 1, 3});
  primitive(b)["targets"] = Json::array({Json{{"POSITION", b.accessor<float>("VEC3", {0, 0, 0, 0, 5, 0, 0, 0, 0, 0, 0, 0})}}});
  const model::ImportedModel m = must_read(b);
  EXPECT_EQ(m.model->vertex_count(), 6U);
  EXPECT_THAT(m.model->mesh->indices(), ElementsAre(0, 2, 1, 4, 5, 3));
  EXPECT_THAT(m.model->rest->positions().subspan(15, 3), ElementsAre(0, 1, 0));
  EXPECT_EQ(m.model->morphs->targets()[0].positions[3 * 5 + 1], 5.0F);
}

/// Of a triangle whose texture coordinates are (0 0), (1 0), (0 1), transformed.
std::vector<float> texcoords(const Json& transform) {
  GltfBuilder b = triangle_gltf();
  attributes(b)["TEXCOORD_0"] = b.accessor<float>("VEC2", {9, 9, 9, 9, 9, 9});
  attributes(b)["TEXCOORD_1"] = b.accessor<float>("VEC2", {0, 0, 1, 0, 0, 1});
  primitive(b)["material"] = 0;
  const std::string png = png_file({1, 1, {255, 0, 0, 255}});
  b.json["images"] = Json::array({Json{{"uri", "data:image/png;base64," + GltfBuilder::base64(png)}}});
  b.json["textures"] = Json::parse(R"([{"source":0,"sampler":0}])");
  b.json["samplers"] = Json::parse(R"([{"wrapS":33071,"wrapT":33648}])");
  Json info{{"index", 0}, {"texCoord", 1}};
  if (!transform.is_null()) info["extensions"]["KHR_texture_transform"] = transform;
  b.json["materials"] = Json::array({Json{{"pbrMetallicRoughness", {{"baseColorTexture", info}}}}});
  const model::ImportedModel m = must_read(b);
  const model::Material& material = m.model->mesh->surface().materials[0];
  EXPECT_NE(material.base_color_texture, nullptr);
  EXPECT_EQ(material.base_color, glm::vec3(1.0F));
  EXPECT_EQ(material.wrap_u, model::TextureWrap::ClampToEdge);
  EXPECT_EQ(material.wrap_v, model::TextureWrap::MirroredRepeat);
  const auto uv = m.model->mesh->texcoords();
  return {uv.begin(), uv.end()};
}

TEST(GltfMaterials, BakeTheTransformOfATexture) {
  EXPECT_THAT(texcoords(nullptr), ElementsAre(0, 1, 1, 1, 0, 0));
  EXPECT_THAT(texcoords({{"offset", {0.5, 0.25}}, {"scale", {2, 3}}}), ElementsAre(0.5F, 0.75F, 2.5F, 0.75F, 0.5F, 1 - 3.25F));
  // A quarter counter-clockwise as seen on the picture, where v runs down: (1 0) goes to (0 -1), (0 1) to (1 0).
  EXPECT_THAT(texcoords({{"rotation", std::acos(-1.0) / 2}}),
              Pointwise(FloatNear(1e-6F), {0.0F, 1.0F, 0.0F, 2.0F, 1.0F, 1.0F}));
  EXPECT_THAT(texcoords({{"texCoord", 0}}), ElementsAre(9, -8, 9, -8, 9, -8));
}

std::size_t meshopt_view(GltfBuilder& b, const std::vector<unsigned char>& packed, std::size_t count, std::size_t stride,
                         const char* mode, const char* filter) {
  const std::size_t at = b.view(packed);
  const Json where = b.json["bufferViews"][at];
  b.json["bufferViews"][at] = {{"buffer", 1},
                               {"byteLength", count * stride},
                               {"extensions",
                                {{"EXT_meshopt_compression",
                                  {{"buffer", 0},
                                   {"byteOffset", where["byteOffset"]},
                                   {"byteLength", where["byteLength"]},
                                   {"byteStride", stride},
                                   {"count", count},
                                   {"mode", mode},
                                   {"filter", filter}}}}}};
  if (std::string_view(mode) == "ATTRIBUTES") b.json["bufferViews"][at]["byteStride"] = stride;
  return at;
}

TEST(GltfBuffers, UnpackMeshopt) {
  GltfBuilder b = triangle_gltf();
  const std::vector<float> positions{0, 0, 0, 3, 0, 0, 0, 3, 0, 3, 3, 0.5F};
  std::vector<unsigned char> packed(meshopt_encodeVertexBufferBound(4, 12));
  packed.resize(meshopt_encodeVertexBuffer(packed.data(), packed.size(), positions.data(), 4, 12));
  const std::size_t position_view = meshopt_view(b, packed, 4, 12, "ATTRIBUTES", "NONE");
  const std::vector<std::uint32_t> indices{0, 1, 2, 2, 1, 3};
  std::vector<unsigned char> packed_indices(meshopt_encodeIndexBufferBound(6, 4));
  packed_indices.resize(meshopt_encodeIndexBuffer(packed_indices.data(), packed_indices.size(), indices.data(), 6));
  const std::size_t index_view = meshopt_view(b, packed_indices, 6, 2, "TRIANGLES", "NONE");
  // Unit vectors along +z and +x, octahedral in 8 bits: (0 0 127 0), (127 0 127 0).
  const std::vector<std::int8_t> octahedral{0, 0, 127, 0, 127, 0, 127, 0, 0, 0, 127, 0, 0, 0, 127, 0};
  std::vector<unsigned char> packed_normals(meshopt_encodeVertexBufferBound(4, 4));
  packed_normals.resize(meshopt_encodeVertexBuffer(packed_normals.data(), packed_normals.size(), octahedral.data(), 4, 4));
  const std::size_t normal_view = meshopt_view(b, packed_normals, 4, 4, "ATTRIBUTES", "OCTAHEDRAL");
  b.json["accessors"] = {
      {{"bufferView", position_view}, {"componentType", 5126}, {"count", 4}, {"type", "VEC3"}},
      {{"bufferView", normal_view}, {"componentType", 5120}, {"normalized", true}, {"count", 4}, {"type", "VEC3"}},
      {{"bufferView", index_view}, {"componentType", 5123}, {"count", 6}, {"type", "SCALAR"}}};
  attributes(b) = {{"POSITION", 0}, {"NORMAL", 1}};
  primitive(b)["indices"] = 2;
  b.json["buffers"] = {{{"byteLength", b.bin.size()}}, {{"byteLength", 1000}}};
  b.json["extensionsRequired"] = Json::array({"EXT_meshopt_compression", "KHR_mesh_quantization"});
  const model::ImportedModel m = must_read(b);
  EXPECT_THAT(m.model->rest->positions(), ElementsAreArray(positions));
  const auto list = m.model->mesh->indices();
  EXPECT_EQ(list.size(), 6U);
  EXPECT_THAT(m.model->rest->normals().first(6), Pointwise(FloatNear(0.01F), {0.0F, 0.0F, 1.0F, 1.0F, 0.0F, 0.0F}));

  GltfBuilder cut = b;
  cut.json["bufferViews"][position_view]["extensions"]["EXT_meshopt_compression"]["byteLength"] = 8;
  const auto refused = try_read(cut.glb());
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::BadAsset);
  EXPECT_THAT(refused.error().message, HasSubstr("/extensions/EXT_meshopt_compression"));
  GltfBuilder huge = b;
  huge.json["bufferViews"][position_view]["byteLength"] = 12e9;
  huge.json["bufferViews"][position_view]["extensions"]["EXT_meshopt_compression"]["count"] = 1e9;
  EXPECT_FALSE(try_read(huge.glb()));
}

}  // namespace
}  // namespace tweend::assets
