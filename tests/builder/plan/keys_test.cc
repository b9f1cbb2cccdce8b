// SPDX-License-Identifier: Apache-2.0
#include "builder/plan/keys.h"

#include "builder/plan/image_material.h"
#include "tracer/base/canonical.h"
#include "tracer/base/files.h"
#include "tracer/device/program_text.h"
#include "tracer/device/program_tokens.h"
#include "tracer/render/engine_text.h"
#include "tracer/scene/sdl.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <set>

namespace ds {
namespace {

namespace fs = std::filesystem;

/// One image of tests/data/tiny, to be changed one property at a time.
class KeysTest : public testing::Test {
 protected:
  KeysTest()
      : recipe_(read_recipe(DS_SOURCE_DIR "/tests/data/tiny/recipe.toml", {})),
        image_(expand(recipe_).front()) {}

  ImageKeys keys() {
    Inputs inputs(database_);
    TextSet texts;
    KeyMaker maker(recipe_, inputs, texts);
    ImageKeys keys = maker.keys(image_);
    keys.kept = maker.kept_key(image_, keys);
    return keys;
  }

  Database database_{fs::path()};
  Recipe recipe_;
  ImageSpec image_;
};

/// Which keys a change moves.
struct Moved {
  bool render, mask, image;
  bool operator==(const Moved&) const = default;
};
std::ostream& operator<<(std::ostream& out, Moved m) {
  return out << "render " << m.render << ", mask " << m.mask << ", image file " << m.image;
}
Hash128 key_of(const ImageKeys& keys, std::string_view kind) {
  for (const OutputFile& output : keys.outputs)
    if (output.kind == kind) return output.key;
  ADD_FAILURE() << "no output " << kind;
  return {};
}
Moved moved(const ImageKeys& a, const ImageKeys& b) {
  return {a.render != b.render, key_of(a, "mask") != key_of(b, "mask"),
          key_of(a, "image") != key_of(b, "image")};
}

TEST_F(KeysTest, AreTheSameEachTime) {
  const ImageKeys a = keys(), b = keys();
  EXPECT_EQ(moved(a, b), (Moved{false, false, false}));
  EXPECT_EQ(a.parts, b.parts);
  EXPECT_EQ(a.files, b.files);
}

TEST_F(KeysTest, NamesNeverMatter) {
  const ImageKeys before = keys();
  image_.id = "x/0";
  image_.model_name = "x";
  image_.view = "other";
  image_.class_path = "some/class";
  image_.split = "test";
  recipe_.name = "other";
  recipe_.licence = "other";
  EXPECT_EQ(moved(before, keys()), (Moved{false, false, false}));
}

/// Pictures of one `kept` key go on from each other's films: what only says when to stop is not in
/// it, whatever else there is.
TEST_F(KeysTest, TheKeptKeyLeavesOutWhenToStop) {
  const auto kept_with = [&](const std::function<void(EngineSettings&)>& change) {
    const EngineSettings before = image_.engine;
    change(image_.engine);
    const Hash128 kept = keys().kept;
    image_.engine = before;
    return kept;
  };
  const auto nothing = [](EngineSettings&) {};
  const Hash128 uniform = kept_with(nothing);
  EXPECT_EQ(kept_with([](EngineSettings& e) { e.spp += 1; }), uniform);
  EXPECT_NE(kept_with([](EngineSettings& e) { e.seed += 1; }), uniform);
  EXPECT_NE(kept_with([](EngineSettings& e) { e.depth_total += 1; }), uniform);
  EXPECT_NE(kept_with([](EngineSettings& e) { e.outlier_limit = 9; }), uniform);
  image_.engine.target = ErrorTarget{};
  const Hash128 scheduled = kept_with(nothing);
  EXPECT_NE(scheduled, uniform);
  EXPECT_EQ(kept_with([](EngineSettings& e) { e.target->error /= 2; }), scheduled);
  EXPECT_EQ(kept_with([](EngineSettings& e) { e.target->max_spp *= 2; }), scheduled);
  EXPECT_EQ(kept_with([](EngineSettings& e) { e.spp += 1; }), scheduled);
  EXPECT_NE(kept_with([](EngineSettings& e) { e.target->tone_map.gamma = 1; }), scheduled);
  EXPECT_NE(kept_with([](EngineSettings& e) { e.target->region = ErrorRegion::model; }), scheduled);
  image_.camera.fov_deg += 1;
  EXPECT_NE(kept_with(nothing), scheduled);
}

TEST_F(KeysTest, EachSettingMovesWhatItCanChangeAndNothingElse) {
  const fs::path other_model = recipe_.models[1].file, other_material = recipe_.materials[1];
  struct Case {
    const char* what;
    std::function<void()> change;
    Moved moved;
    int part;  // of the first five, -1: none
  };
  const Case cases[] = {
      {"model", [&] { image_.model_file = other_model; }, {true, true, true}, 0},
      {"size",
       [&] {
         ImageVariables variables = *image_.variables;
         variables.values.model_size_m = 0.2;
         image_.variables = variables;
       },
       {true, true, true},
       0},
      {"crease", [&] { recipe_.normalise.crease_deg = 10; }, {true, false, true}, 0},
      {"material",
       [&] {
         image_.material_file =
             image_.material_file == other_material ? recipe_.materials[0] : other_material;
       },
       {true, false, true},
       1},
      {"camera", [&] { image_.camera.position.x += 0.01; }, {true, true, true}, 3},
      {"field of view", [&] { image_.camera.fov_deg = 50; }, {true, true, true}, 3},
      {"width", [&] { image_.engine.width += 1; }, {true, true, true}, 4},
      {"spp", [&] { image_.engine.spp += 1; }, {true, false, true}, 4},
      {"seed", [&] { image_.engine.seed += 1; }, {true, false, true}, 4},
      {"outlier limit", [&] { image_.engine.outlier_limit = 9; }, {true, false, true}, 4},
      {"rejected limit", [&] { recipe_.rejected_limit = 0.5; }, {false, false, false}, -1},
      {"error target", [&] { image_.engine.target = ErrorTarget{}; }, {true, false, true}, 4},
      {"math", [&] { image_.engine.math = MathMode::fast; }, {true, false, true}, 4},
      {"tone map",
       [&] { recipe_.outputs.tone_map = ToneMap{.scale = 3}; },
       {false, false, true},
       -1},
      {"depth",
       [&] {
         recipe_.outputs.set_plane({&plane_type("depth"), PlaneEncoding::exr});
       },
       {false, false, false},
       -1},
  };
  const Recipe recipe = recipe_;
  const ImageSpec image = image_;
  const ImageKeys before = keys();
  for (const Case& c : cases) {
    SCOPED_TRACE(c.what);
    recipe_ = recipe;
    image_ = image;
    c.change();
    const ImageKeys after = keys();
    EXPECT_EQ(moved(before, after), c.moved);
    for (int part = 0; part < 5; ++part) {
      const auto i = static_cast<std::size_t>(part);
      EXPECT_EQ(before.parts[i] != after.parts[i], part == c.part) << k_part_names[i];
    }
  }
}

/// As KeyMaker's header says them, from whole texts made for this image alone.
ImageKeys keys_of_whole_texts(const Recipe& recipe, Inputs& inputs, const ImageSpec& image) {
  const Scene scene = scene_without_model(recipe, inputs, image);
  const std::string program = program_tokens(path_program_text(scene_effects(scene, image.camera)));
  TextSet texts;
  ImageKeys keys;
  keys.parts[0] = texts.add(
      canonical_model(inputs.model_hashes(image.model_file), {.normals = true}, recipe.normalise));
  keys.parts[1] = texts.add(canonical_material(inputs.material(image.material_file)));
  keys.parts[2] = texts.add(canonical_environment(inputs.environment(image.environment_folder)));
  keys.parts[3] = texts.add(canonical_camera(image.camera));
  keys.parts[4] = texts.add(canonical_engine(image.engine, program));
  CanonicalText render, kept;
  kept.add("kind", "film_sums");
  for (std::size_t i = 0; i < 5; ++i) {
    const Hash128 unstopped = hash_text(canonical_kept_engine(image.engine, program));
    render.add(k_part_names[i], keys.parts[i].hex());
    kept.add(k_part_names[i], (i < 4 ? keys.parts[i] : unstopped).hex());
  }
  keys.render = hash_text(render.text());
  keys.kept = hash_text(kept.text());
  return keys;
}

/// One KeyMaker for all images, whatever they share and do not.
TEST_F(KeysTest, WhatIsSharedGivesTheKeysOfWholeTexts) {
  Inputs inputs(database_);
  TextSet texts;
  KeyMaker maker(recipe_, inputs, texts);
  std::vector<ImageSpec> images = expand(recipe_);
  for (const ImageSpec& image : expand(recipe_)) {
    images.push_back(image);
    images.back().camera.lens_radius_m = 0.01;
    images.push_back(image);
    images.back().engine.target = ErrorTarget{};
    images.push_back(image);
    images.back().camera.position.x += 0.01;
    images.back().engine.width += 1;
  }
  std::set<Hash128> different;
  for (const ImageSpec& image : images) {
    SCOPED_TRACE(image.id);
    const ImageKeys wanted = keys_of_whole_texts(recipe_, inputs, image);
    const ImageKeys made = maker.keys(image);
    EXPECT_TRUE(std::equal(made.parts.begin(), made.parts.end() - 1, wanted.parts.begin()));
    EXPECT_EQ(made.render, wanted.render);
    EXPECT_EQ(render_key(made.parts), made.render);
    EXPECT_EQ(maker.kept_key(image, made), wanted.kept);
    different.insert(made.render);
    maker.add_texts(image, made);
    for (const Hash128 part : made.parts)
      EXPECT_NE(texts.find(part), nullptr);
  }
  EXPECT_EQ(different.size(), images.size());
}

TEST_F(KeysTest, ALensMovesTheFilmAndNotTheMask) {
  const ImageKeys before = keys();
  image_.camera.lens_radius_m = 0.01;
  const ImageKeys after = keys();
  EXPECT_EQ(moved(before, after), (Moved{true, false, true}));
}

TEST_F(KeysTest, AnUnusedStepOfTheNormalisationMovesNothing) {
  recipe_.normalise.place_on_ground = false;
  recipe_.normalise.normals = Normals::flat;
  const ImageKeys before = keys();
  recipe_.normalise.ground_z_m = 7;
  recipe_.normalise.crease_deg = 7;
  EXPECT_EQ(moved(before, keys()), (Moved{false, false, false}));
}

/// The keys with the model's colours, or its uvs, in a material of that text, before they change
/// and after.
class KeysOfExtrasTest : public KeysTest {
 protected:
  Moved moved_by(const char* material, const char* before, const char* after) {
    const fs::path model = folder_.path() / "m.ply", file = folder_.path() / "m.mat";
    write_file_atomic(file, material);
    write_file_atomic(folder_.path() / "t.png", "not read here");
    image_.model_file = model;
    image_.material_file = file;
    write_file_atomic(model, std::string(k_head) + before);
    const ImageKeys first = keys();
    write_file_atomic(model, std::string(k_head) + after);
    return moved(first, keys());
  }

  static constexpr const char* k_head =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
      "property float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
      "property float u\nproperty float v\nelement face 1\n"
      "property list uchar int vertex_index\nend_header\n";
  static constexpr const char* k_plain =
      "0 0 0 9 9 9 0 0\n1 0 0 9 9 9 1 0\n0 1 0 9 9 9 0 1\n3 0 1 2\n";
  static constexpr const char* k_recoloured =
      "0 0 0 9 9 8 0 0\n1 0 0 9 9 9 1 0\n0 1 0 9 9 9 0 1\n3 0 1 2\n";
  static constexpr const char* k_remapped =
      "0 0 0 9 9 9 0 0\n1 0 0 9 9 9 1 0\n0 1 0 9 9 9 0 2\n3 0 1 2\n";
  static constexpr const char* k_reshaped =
      "0 0 0 9 9 9 0 0\n1 0 0 9 9 9 1 0\n0 2 0 9 9 9 0 1\n3 0 1 2\n";
  TemporaryFolder folder_;
};

TEST_F(KeysOfExtrasTest, ColoursCountWhereTheMaterialReadsThem) {
  const std::string plain = "scene.materials.a.kd = 0.5\n";
  EXPECT_EQ(moved_by(plain.c_str(), k_plain, k_recoloured), (Moved{false, false, false}));
  EXPECT_EQ(moved_by(plain.c_str(), k_plain, k_reshaped), (Moved{true, true, true}));
  for (const std::string type : {"hitpointcolor", "hitpointgrey", "hitpointalpha"}) {
    const std::string texture = "scene.textures.t.type = " + type + "\n";
    EXPECT_EQ(moved_by((texture + "scene.materials.a.kd = t\n").c_str(), k_plain, k_recoloured),
              (Moved{true, false, true}))
        << type;
    // Below another texture, and as a part of a mix.
    for (const char* user : {"scene.textures.s.type = scale\nscene.textures.s.texture1 = t\n"
                             "scene.materials.a.kd = s\n",
                             "scene.materials.b.kd = t\nscene.materials.c.kd = 0.1\n"
                             "scene.materials.a.type = mix\nscene.materials.a.material1 = b\n"
                             "scene.materials.a.material2 = c\n"})
      EXPECT_TRUE(moved_by((texture + user).c_str(), k_plain, k_recoloured).render) << type << user;
    // A texture that is there and that no material uses.
    EXPECT_FALSE(moved_by((texture + plain).c_str(), k_plain, k_recoloured).render) << type;
  }
}

TEST_F(KeysOfExtrasTest, UvsCountWhereTheMaterialReadsThem) {
  EXPECT_EQ(moved_by("scene.materials.a.kd = 0.5\n", k_plain, k_remapped),
            (Moved{false, false, false}));
  const char* material =
      "scene.textures.t.type = imagemap\nscene.textures.t.file = t.png\n"
      "scene.materials.a.kd = t\n";
  EXPECT_EQ(moved_by(material, k_plain, k_remapped), (Moved{true, false, true}));
  EXPECT_EQ(moved_by(material, k_plain, k_recoloured), (Moved{false, false, false}));
}

TEST_F(KeysTest, PathsOfOutputsFollowTheId) {
  recipe_.outputs.set_plane({&plane_type("depth"), PlaneEncoding::exr});
  const ImageKeys made = keys();
  ASSERT_EQ(made.outputs.size(), 3U);
  EXPECT_EQ(made.outputs[0].path, "images/box.off/0.png");
  EXPECT_EQ(made.outputs[1].path, "images/box.off/0.mask.png");
  EXPECT_EQ(made.outputs[2].path, "images/box.off/0.depth.exr");
}

TEST_F(KeysTest, AFileThatCannotBeReadFailsTheSameWayEachTime) {
  image_.model_file = "/no/such/file.ply";
  Inputs inputs(database_);
  std::string first, second;
  try {
    inputs.model_hashes(image_.model_file);
  } catch (const Error& error) {
    first = error.what();
  }
  try {
    inputs.model_hashes(image_.model_file);
  } catch (const Error& error) {
    second = error.what();
  }
  EXPECT_NE(first, "");
  EXPECT_EQ(first, second);
}

}  // namespace
}  // namespace ds
