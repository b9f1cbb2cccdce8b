// SPDX-License-Identifier: Apache-2.0
#include "tracer/scene/own_materials.h"

#include "tests/tracer/scene/sdl_files_for_tests.h"
#include "tracer/base/error.h"
#include "tracer/base/hash_stream.h"
#include "tracer/scene/scene_reads.h"
#include "tracer/scene/type_tables.h"

#include <gmock/gmock.h>

namespace ds {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::SdlFolder;
using Notes = std::map<std::string, std::uint64_t>;

constexpr std::string_view k_corners =
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n";

/// A glTF file of one triangle a primitive, with the materials and all else in `more`.
std::string gltf(const std::vector<int>& primitives, const std::string& more) {
  std::string list;
  for (const int material : primitives)
    list += fmt::format(R"({}{{"attributes":{{"POSITION":0}}{}}})", list.empty() ? "" : ",",
                        material < 0 ? "" : fmt::format(R"(,"material":{})", material));
  // (0 0 0), (1 0 0), (0 1 0) as floats.
  return fmt::format(
      R"({{"asset":{{"version":"2.0"}},"nodes":[{{"mesh":0}}],"meshes":[{{"primitives":[{}]}}],)"
      R"("accessors":[{{"bufferView":0,"componentType":5126,"type":"VEC3","count":3}}],)"
      R"("bufferViews":[{{"buffer":0,"byteLength":36}},{{"buffer":0,"byteOffset":12,"byteLength":4}}],)"
      R"("buffers":[{{"byteLength":36,"uri":"data:application/octet-stream;base64,)"
      R"(AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}}],{}}})",
      list, more);
}

OwnMaterials own_of(const SdlFolder& folder, const std::string& name, std::string_view text) {
  folder.write(name, text);
  return read_own_materials(folder.path() / name);
}
OwnMaterials own_gltf(const SdlFolder& folder, const std::string& material,
                      const std::string& more = "") {
  return own_of(folder, "m.gltf", gltf({0}, R"("materials":[{)" + material + "}]" + more));
}

TEST(OwnMaterials, EachTriangleHasTheMaterialOfItsFace) {
  const SdlFolder folder;
  // An n-gon, a face without area, one twice, one without a material, and one named again.
  folder.write("m.obj",
               std::string(k_corners) +
                   "f 5 6 7\nusemtl one\nf 1 2 3 4\nf 1 1 2\nusemtl two\nf 2 3 1\nf 5 6 8\n"
                   "usemtl none of all\nusemtl one\nf 6 7 8\n");
  const FileMesh mesh = read_model(folder.path() / "m.obj").mesh;
  EXPECT_THAT(mesh.materials, ElementsAre(0, 1, 1, 2, 1));
  for (const Normals normals : {Normals::smooth, Normals::flat}) {
    NormaliseOptions options;
    options.normals = normals;
    EXPECT_EQ(normalise(mesh, options).materials, mesh.materials);
  }
  FileMesh without = mesh;
  without.materials.clear();
  EXPECT_EQ(mesh_hashes(without), mesh_hashes(mesh));  // no other recipe's key counts them
  EXPECT_NE(materials_hash(mesh), materials_hash(without));
  EXPECT_EQ(materials_hash(without), Hash128{});
}

TEST(OwnMaterials, OfPrimitivesAreNumberedAsFacesNameThem) {
  const SdlFolder folder;
  const std::string list = R"("materials":[{"name":"a"},{"name":"unused"},{"name":"b"}])";
  folder.write("m.gltf", gltf({2, -1, 0}, list));
  // Three times one triangle: the first stays.
  EXPECT_THAT(read_model(folder.path() / "m.gltf").mesh.materials, ElementsAre(1));
  const OwnMaterials own = read_own_materials(folder.path() / "m.gltf");
  ASSERT_EQ(own.materials.size(), 2U);
  EXPECT_EQ(own.materials[0].name, "b");
  EXPECT_EQ(own.materials[1].name, "a");
  EXPECT_FALSE(own.has_bare);
  EXPECT_TRUE(own_of(folder, "bare.gltf", gltf({-1, 0}, list)).has_bare);
}

TEST(OwnMaterials, WhatGltfSaysNothingOfIsAsItsSpecificationHasIt) {
  const SdlFolder folder;
  const OwnMaterials own = own_gltf(folder, "");
  for (const OwnMaterial* material : {&own.materials.at(0), &own.bare}) {
    EXPECT_EQ(material->inputs.at("basecolor").factor, (Vec3{1, 1, 1}));
    EXPECT_EQ(material->inputs.at("metallic").factor.x, 1);
    EXPECT_EQ(material->inputs.at("roughness").factor.x, 1);
    EXPECT_EQ(material->inputs.at("specular").factor.x, 0.5F);  // 4 %: disney's 0.08 times it
  }
  EXPECT_EQ(own.notes, Notes{});
  const OwnMaterials said = own_gltf(
      folder,
      R"("pbrMetallicRoughness":{"baseColorFactor":[0.25,0.5,2,0.5],"metallicFactor":0.25,"roughnessFactor":0.75})");
  EXPECT_EQ(said.materials.at(0).inputs.at("basecolor").factor, (Vec3{0.25F, 0.5F, 1}));
  EXPECT_EQ(said.materials.at(0).inputs.at("metallic").factor.x, 0.25F);
  EXPECT_EQ(said.materials.at(0).inputs.at("roughness").factor.x, 0.75F);
  EXPECT_EQ(said.notes, (Notes{{"out_of_range", 1}}));
}

TEST(OwnMaterials, GltfTexturesKeepTheirChannelsAndPlaces) {
  const SdlFolder folder;
  const OwnMaterials own = own_gltf(
      folder,
      R"("pbrMetallicRoughness":{"baseColorTexture":{"index":0},"metallicRoughnessTexture":{"index":1,"extensions":)"
      R"({"KHR_texture_transform":{"offset":[0,1],"rotation":1.57079632679,"scale":[0.5,0.5]}}}})",
      R"(,"textures":[{"source":0},{"source":1,"sampler":0}],"samplers":[{"magFilter":9728,"wrapS":33071,"wrapT":33071}],)"
      R"("images":[{"uri":"my%20image.png"},{"bufferView":1,"mimeType":"image/png"}])");
  const auto& inputs = own.materials.at(0).inputs;
  ASSERT_EQ(own.images.size(), 2U);
  EXPECT_EQ(own.images[0].file, folder.path() / "my image.png");
  EXPECT_EQ(own.images[0].embedded, -1);
  const OwnInput &base = inputs.at("basecolor"), &rough = inputs.at("roughness"),
                 &metal = inputs.at("metallic");
  EXPECT_EQ(base.image, 0);
  EXPECT_TRUE(base.srgb);
  EXPECT_THAT(base.uv_transform, ElementsAre(1, 0, 0, 0, 1, 0));
  EXPECT_EQ(rough.image, 1);
  EXPECT_EQ(metal.image, 1);
  EXPECT_FALSE(rough.srgb || metal.srgb);
  EXPECT_EQ(rough.channel, ImageChannel::green);
  EXPECT_EQ(metal.channel, ImageChannel::blue);
  EXPECT_EQ(rough.filter, ImageFilter::nearest);
  EXPECT_EQ(rough.wrap, ImageWrap::clamp);
  // "This example utilizes only the lower left quadrant of the source image": the extension's own words.
  const auto& m = rough.uv_transform;
  float least_u = 1, most_u = 0, least_v = 1, most_v = 0;
  for (const auto& [u, v] : {std::pair{0.F, 0.F}, {1.F, 0.F}, {0.F, 1.F}, {1.F, 1.F}}) {
    const float s = m[0] * u + m[1] * v + m[2], t = m[3] * u + m[4] * v + m[5];
    least_u = std::min(least_u, s), most_u = std::max(most_u, s);
    least_v = std::min(least_v, t), most_v = std::max(most_v, t);
  }
  EXPECT_NEAR(least_u, 0, 1e-6);
  EXPECT_NEAR(most_u, 0.5, 1e-6);
  EXPECT_NEAR(least_v, 0.5, 1e-6);
  EXPECT_NEAR(most_v, 1, 1e-6);
  // Bytes 12 to 15 of the buffer are the float 1.
  EXPECT_EQ(embedded_image(folder.path() / "m.gltf", 1), std::string("\0\0\x80\x3f", 4));
  EXPECT_EQ(own.images[1].content, hash_text(std::string("\0\0\x80\x3f", 4)));
}

TEST(OwnMaterials, ADataUriOfAnotherTypeIsSaidToBeOne) {
  const SdlFolder folder;
  try {
    own_gltf(folder, R"("pbrMetallicRoughness":{"baseColorTexture":{"index":0}})",
             R"(,"textures":[{"source":0}],"images":[{"uri":"data:image/webp;base64,aGVsbG8="}])");
    ADD_FAILURE() << "read without an error";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("application/octet-stream, found image/webp;base64"));
  }
}

TEST(OwnMaterials, AnImageOfADataUriIsItsBytes) {
  const SdlFolder folder;
  const OwnMaterials own =
      own_gltf(folder, R"("pbrMetallicRoughness":{"baseColorTexture":{"index":0}})",
               R"(,"textures":[{"source":0}],"images":[{"uri":"data:image/png;base64,aGVsbG8="}])");
  ASSERT_EQ(own.images.size(), 1U);
  EXPECT_EQ(own.images[0].embedded, 0);
  EXPECT_EQ(own.images[0].content, hash_text("hello"));
  EXPECT_EQ(embedded_image(folder.path() / "m.gltf", 0), "hello");
}

TEST(OwnMaterials, WhatOfGltfIsNotShownIsCounted) {
  const SdlFolder folder;
  const std::string textures = R"(,"textures":[{"source":0},{}],"images":[{"uri":"a.png"}])";
  const auto notes = [&](const std::string& material) {
    return own_gltf(folder, material, textures).notes;
  };
  EXPECT_EQ(notes(R"("emissiveFactor":[0,0.5,0])"), (Notes{{"emission", 1}}));
  EXPECT_EQ(notes(R"("alphaMode":"MASK")"), (Notes{{"transparency", 1}}));
  EXPECT_EQ(notes(R"("alphaMode":"BLEND")"), (Notes{{"transparency", 1}}));
  EXPECT_EQ(notes(R"("alphaMode":"OPAQUE","doubleSided":true)"), Notes{});
  EXPECT_EQ(notes(R"("normalTexture":{"index":0})"), (Notes{{"normal_maps", 1}}));
  EXPECT_EQ(notes(R"("occlusionTexture":{"index":0})"), (Notes{{"occlusion_maps", 1}}));
  EXPECT_EQ(notes(R"("extensions":{"KHR_materials_clearcoat":{"clearcoatFactor":1}})"),
            (Notes{{"extensions", 1}}));
  EXPECT_EQ(notes(R"("pbrMetallicRoughness":{"baseColorTexture":{"index":0,"texCoord":1}})"),
            (Notes{{"further_uvs", 1}}));
  EXPECT_EQ(notes(R"("pbrMetallicRoughness":{"baseColorTexture":{"index":1}})"),
            (Notes{{"extensions", 1}}));
  EXPECT_EQ(
      own_gltf(
          folder, R"("pbrMetallicRoughness":{"baseColorTexture":{"index":0}})",
          R"(,"textures":[{"source":0,"sampler":0}],"samplers":[{"wrapS":33648,"wrapT":33648}])"
          R"(,"images":[{"uri":"a.png"}])")
          .notes,
      (Notes{{"mirrored", 1}}));
}

TEST(OwnMaterials, ImagesOutOfTheFolderAreRefused) {
  const SdlFolder folder;
  for (const char* uri : {"../a.png", "/a.png", "http://a/b.png"})
    EXPECT_THROW(
        own_gltf(folder, R"("pbrMetallicRoughness":{"baseColorTexture":{"index":0}})",
                 fmt::format(R"(,"textures":[{{"source":0}}],"images":[{{"uri":"{}"}}])", uri)),
        Error)
        << uri;
  for (const char* wrong : {R"("textures":[{"source":7}])", R"("textures":[])",
                            R"("textures":[{"source":0}],"images":[{"bufferView":9}])"})
    EXPECT_THROW(own_gltf(folder, R"("pbrMetallicRoughness":{"baseColorTexture":{"index":0}})",
                          fmt::format(",{}", wrong)),
                 Error)
        << wrong;
}

TEST(OwnMaterials, TheirTextReadsBackAsThemselves) {
  const SdlFolder folder;
  OwnMaterials own = own_gltf(
      folder,
      R"("name":"\u00fc\"\\n","pbrMetallicRoughness":{"baseColorFactor":[0.1,0.2,0.3,1],)"
      R"("baseColorTexture":{"index":0},"metallicRoughnessTexture":{"index":1}},"alphaMode":"BLEND")",
      R"(,"textures":[{"source":0},{"source":1}],"images":[{"uri":"a.png"},{"uri":"data:image/png;base64,aGVsbG8="}])");
  own.materials.back().name += "\xff";  // no UTF-8
  EXPECT_EQ(own_materials_from_text(own_materials_text(own)), own);
  EXPECT_THROW(own_materials_from_text("[]"), Error);
  EXPECT_THROW(own_materials_from_text("hello"), Error);
}

TEST(OwnMaterials, OfFormatsWithoutAreLightGrey) {
  const SdlFolder folder;
  const OwnMaterials own = own_of(folder, "m.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  EXPECT_THAT(own.materials, IsEmpty());
  EXPECT_TRUE(own.has_bare);
  EXPECT_EQ(own.notes, (Notes{{k_bare_faces, 1}}));
  EXPECT_EQ(own.bare, light_grey());
}

const TextureRef& input(const Scene& scene, std::size_t material, std::string_view name) {
  const Material& m = scene.materials.at(material);
  return m.inputs.at(static_cast<std::size_t>(
      find_input(material_types()[static_cast<std::size_t>(m.type)], name)));
}

TEST(OwnScene, IsWhatTheSameMaterialIsInAMaterialFile) {
  const SdlFolder folder;
  folder.write("m.mtl", "newmtl a\nKd 0.2 0.4 0.6\nPr 0.3\nPm 0.7\n");
  const OwnMaterials own =
      own_of(folder, "m.obj", std::string(k_corners) + "mtllib m.mtl\nusemtl a\nf 1 2 3\n");
  const Scene scene = own_scene(own, false, content_hash);
  const Scene same = folder.material(
      "scene.materials.a.type = disney\nscene.materials.a.basecolor = 0.2 0.4 0.6\n"
      "scene.materials.a.roughness = 0.3\nscene.materials.a.metallic = 0.7\n"
      "scene.materials.a.specular = 0.5\n");
  ASSERT_EQ(scene.materials.size(), 1U);
  EXPECT_EQ(scene.materials[0].type, same.materials[0].type);
  for (std::size_t i = 0; i < same.materials[0].inputs.size(); ++i) {
    EXPECT_EQ(scene.materials[0].inputs[i].constant, same.materials[0].inputs[i].constant) << i;
    EXPECT_EQ(scene.materials[0].inputs[i].texture, -1);
  }
  EXPECT_THAT(scene.own_materials, ElementsAre(-1, 0));
}

TEST(OwnScene, ColoursOfTheMeshMultiplyTheBaseColour) {
  const SdlFolder folder;
  folder.write("a.png", "not decoded here");
  folder.write("m.mtl", "newmtl a\nKd 0.5\nmap_Kd a.png\nnewmtl b\nKd 0.25\n");
  const OwnMaterials own =
      own_of(folder, "m.obj",
             std::string(k_corners) + "mtllib m.mtl\nusemtl a\nf 1 2 3\nusemtl b\nf 2 3 5\n");
  const Scene plain = own_scene(own, false, content_hash),
              coloured = own_scene(own, true, content_hash);
  EXPECT_EQ(reads_of_model(plain), (MeshExtras{true, false, false}));
  EXPECT_EQ(reads_of_model(coloured), (MeshExtras{true, true, false}));
  EXPECT_EQ(input(plain, 1, "basecolor").constant, (Vec3{0.25F, 0.25F, 0.25F}));
  EXPECT_GE(input(coloured, 1, "basecolor").texture, 0);
  EXPECT_EQ(plain.images.at(0).content, content_hash(folder.path() / "a.png"));
  EXPECT_TRUE(plain.images[0].srgb);
}

TEST(OwnScene, AMissingImageIsSaidWithTheMaterialThatShowsIt) {
  const SdlFolder folder;
  folder.write("m.mtl", "newmtl red\nmap_Kd none.png\n");
  const OwnMaterials own =
      own_of(folder, "m.obj", std::string(k_corners) + "mtllib m.mtl\nusemtl red\nf 1 2 3\n");
  try {
    own_scene(own, false, content_hash);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::asset);
    EXPECT_THAT(
        error.what(),
        HasSubstr("none.png: wanted an image that the material \"red\" shows, found no file"));
  }
}

TEST(OwnScene, IsComposedFaceByFace) {
  const SdlFolder folder;
  folder.write("m.mtl", "newmtl a\nKd 0.5\nnewmtl b\nKd 0.25\n");
  const OwnMaterials own = own_of(
      folder, "m.obj",
      std::string(k_corners) + "mtllib m.mtl\nf 5 6 7\nusemtl b\nf 1 2 3\nusemtl a\nf 2 3 5\n");
  const Scene environment = folder.environment(std::string("scene.materials.body.kd = 1\n") +
                                               std::string(testing::k_square));
  const Scene material = own_scene(own, false, content_hash);
  Mesh mesh = in_floats(read_model(folder.path() / "m.obj").mesh);
  const Scene scene = compose(environment, material, mesh);
  const Object& model = scene.objects.back();
  ASSERT_EQ(model.triangle_materials.size(), 3U);
  const auto shown = [&](std::size_t triangle) {
    return scene.materials.at(static_cast<std::size_t>(material_of_triangle(model, triangle)));
  };
  EXPECT_EQ(shown(0).id, 0U);  // none
  EXPECT_EQ(shown(1).id, 1U);  // b, the first that a face names
  EXPECT_EQ(shown(2).id, 2U);
  EXPECT_EQ(shown(1).inputs[0].constant.x, 0.25F);
  EXPECT_EQ(shown(2).inputs[0].constant.x, 0.5F);
  EXPECT_THAT(shown_materials(model), ElementsAre(1, 2, 3));
  EXPECT_EQ(model.id, k_model_object_id);

  // In the key: which face has which.
  Scene others = material;
  others.own_faces.low ^= 1U;
  EXPECT_NE(canonical_material(others), canonical_material(material));
  EXPECT_THROW(compose(environment, others, mesh), Error);
  std::swap(mesh.materials[0], mesh.materials[1]);
  EXPECT_THROW(compose(environment, material, mesh), Error);
}

}  // namespace
}  // namespace ds
