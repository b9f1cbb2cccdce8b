// SPDX-License-Identifier: Apache-2.0
// Every key of a recipe moves what its row says, no more and no less: two values of it are planned
// and compared.
#include "builder/recipe/keys.h"
#include "tests/builder/tiny_dataset.h"
#include "tracer/scene/type_tables.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>

namespace ds {
namespace {

/// Two values of a key that show the most it moves, under what it needs besides (--set).
struct Flip {
  std::string_view key;
  std::string one, other;
  std::vector<std::string> with = {};
};

const std::string k_list = R"(camera.set="list")";
const std::string k_dodecahedron = R"(camera.set="half-dodecahedron")";
const std::string k_fit = R"(camera.distance_m="fit")";
const std::string k_lens = "camera.lens_radius_m=0.01";
const std::string k_target = "engine.error=0.1";
const std::string k_linear = R"(outputs.tone_map="linear")";
const std::string k_reinhard = R"(outputs.tone_map="reinhard02")";
const std::string k_random_material = R"(materials.assign="random")";
const std::string k_random_place = R"(environments.assign="random")";

// Models that stand in the floor, more or less.
const std::string k_sunk = "models.place_m={box=[[0,0,-0.12],[0,0,0]]}";

const std::string k_others = R"(distractors.dir="{models}")";
const std::string k_places = "distractors.place_m={disc=0.3}";

class Moving : public TinyDataset {
 protected:
  Moving() {
    const auto put = [&](const std::string& name, const std::string& text) {
      write_file_atomic(recipe_folder() / name, text);
    };
    put("all.cla", "PSB 1\n1 2\n\nthing 0 2\nbox\ntetra\n");
    put("ids.txt", "other\nthing\n");
    put("LICENSE", "for models, materials and environments\n");
    put("SOURCE", "made for tests\n");
    put("box.cla", "PSB 1\n1 1\n\nthing 0 1\nbox\n");
    std::filesystem::create_directories(recipe_folder() / "models/more");
    std::filesystem::copy(recipe_folder() / "models/box.off",
                          recipe_folder() / "models/more/third.off");
    for (const char* folder : {"models", "materials", "environments"})
      std::filesystem::copy(recipe_folder() / folder,
                            recipe_folder() / (std::string("few_") + folder),
                            std::filesystem::copy_options::recursive);
    std::filesystem::remove(recipe_folder() / "few_models/tetra.ply");
    std::filesystem::remove(recipe_folder() / "few_materials/red.mat");
    std::filesystem::remove_all(recipe_folder() / "few_environments/plain");
  }

  std::string path(const std::string& name) const {
    return '"' + (recipe_folder() / name).string() + '"';
  }
  std::string paths(const std::string& name) const { return "[" + path(name) + "]"; }

  std::vector<Flip> flips() const;

  Plan plan_with(const Flip& flip, const std::string& value) {
    request.overrides = flip.with;
    request.overrides.push_back(std::string(flip.key) + "=" + value);
    return plan();
  }

  static Moves moved(const Plan& a, const Plan& b) {
    const auto all = [&](const auto& same) {
      return std::equal(a.images.begin(), a.images.end(), b.images.begin(), b.images.end(), same);
    };
    const auto shows = [](const PlannedImage& x, const PlannedImage& y) {
      return x.spec.id == y.spec.id && *x.spec.model_file == *y.spec.model_file &&
             *x.spec.material_file == *y.spec.material_file &&
             *x.spec.environment_folder == *y.spec.environment_folder;
    };
    if (!all(shows)) return Moves::images;
    // Which of them can be made.
    if (!all([](const auto& x, const auto& y) {
          return x.error.has_value() == y.error.has_value();
        }))
      return Moves::images;
    // Of planes that both have.
    const bool geometry = !all([](const auto& x, const auto& y) {
      for (const OutputFile& one : x.keys.outputs)
        for (const OutputFile& other : y.keys.outputs)
          if (one.plane != nullptr && one.plane == other.plane && one.key != other.key)
            return false;
      return true;
    });
    const bool film =
        !all([](const auto& x, const auto& y) { return x.keys.render == y.keys.render; });
    EXPECT_TRUE(film || !geometry) << "masks move, and pictures do not";
    if (geometry) return Moves::scene;
    if (film) return Moves::film;
    const auto files = [](const PlannedImage& x, const PlannedImage& y) {
      return std::equal(x.keys.outputs.begin(), x.keys.outputs.end(), y.keys.outputs.begin(),
                        y.keys.outputs.end(), [](const OutputFile& one, const OutputFile& other) {
                          return one.path == other.path && one.key == other.key;
                        });
    };
    if (!all(files)) return Moves::files;
    EXPECT_NE(a.labels.hash, b.labels.hash) << "a setting that the manifest does not hold";
    return Moves::manifest;
  }
};

/// Keys of one value only.
std::vector<std::string_view> fixed_keys() {
  std::vector<std::string_view> fixed;
  if (camera_types().size() == 1) fixed.push_back("camera.type");
  return fixed;
}

/// What the table of cameras adds to the keys.
std::vector<Flip> camera_flips() {
  std::vector<Flip> flips;
  const auto literal = [](std::size_t type) {
    return fmt::format("\"{}\"", camera_types()[type].name);
  };
  if (camera_types().size() > 1)
    flips.push_back({"camera.type", literal(0), literal(camera_types().size() - 1)});
  for (std::size_t i = 0; i < camera_types().size(); ++i)
    if (camera_types()[i].host.span == kernels::CameraSpan::extent_m) {
      flips.push_back({"camera.extent_m", "0.2", "0.3", {"camera.type=" + literal(i)}});
      break;
    }
  return flips;
}

std::vector<Flip> Moving::flips() const {
  std::vector<Flip> flips = camera_flips();
  const std::vector<Flip> others = {
      {"dataset.name", "\"one\"", "\"other\""},
      {"dataset.seed", "1", "2"},
      {"dataset.licence", "\"\"", "\"CC0-1.0\""},
      {"dataset.unlicensed", "\"keep\"", "\"error\""},
      {"dataset.unsourced", "\"keep\"", "\"error\""},
      {"dataset.description", "\"\"", "\"text\""},
      {"dataset.creator", "\"\"", "\"text\""},
      {"dataset.url", "\"\"", "\"text\""},
      {"dataset.published", "\"\"", "\"2026-11-27\""},
      {"dataset.version", "\"\"", "\"text\""},
      {"dataset.cite", "\"\"", "\"text\""},
      {"models.dir", path("models"), path("few_models")},
      {"models.files", paths("models/box.off"), paths("models/tetra.ply")},
      {"models.recursive", "false", "true"},
      {"models.names", "\"file\"", "\"path\"", {"models.recursive=true"}},
      {"models.up", "\"y\"", "\"z\""},
      {"models.size_m", "0.1", "0.2"},
      {"models.turn", "\"none\"", "[1, 0, 0, 1]"},
      {"models.place_m", "[0, 0, 0]", "[0.01, 0, 0]"},
      {"models.ground_z_m", "-0.05", "-0.06"},
      {"models.centre", "\"mass\"", "\"none\""},
      {"models.normals", "\"smooth\"", "\"flat\""},
      {"models.crease_deg", "10", "20"},
      {"classes.train", "\"\"", path("all.cla")},
      {"classes.test", "\"\"", path("all.cla")},
      {"classes.from", "\"folder\"", "\"folders\"", {"models.recursive=true"}},
      {"classes.more", "[]", paths("all.cla")},
      {"classes.ids", "\"\"", path("ids.txt"), {"classes.from=" + path("all.cla")}},
      {"classes.split_folders",
       "true",
       "false",
       {"models.recursive=true", "classes.from=\"folder\""}},
      {"classes.split.test", "0.1", "0.9"},
      {"classes.split.val", "0.1", "0.9"},
      {"classes.split.train", "0.5", "0.5000000001", {"classes.split.test=0.5"}},
      {"classes.split.by", "\"model\"", "\"view\"", {"classes.split.test=0.5"}},
      {"classes.split.stratified",
       "false",
       "true",
       {"classes.split.test=0.5", "classes.from=" + path("all.cla")}},
      {"classes.split.held_out", "[\"box.off\"]", "[\"tetra.ply\"]"},
      {"classes.split.held_out_val", "[\"box.off\"]", "[\"tetra.ply\"]"},
      {"classes.split.folds", "2", "5"},
      {"classes.missing", "\"ignore\"", "\"error\"", {"classes.train=" + path("all.cla")}},
      {"classes.unlisted", "\"keep\"", "\"skip\"", {"classes.train=" + path("box.cla")}},
      {"classes.unshared", "\"keep\"", "\"error\"", {"classes.train=" + path("box.cla")}},
      {"materials.dir", path("materials"), path("few_materials")},
      {"materials.files", paths("materials/red.mat"), paths("materials/green.mat")},
      {"materials.assign", "\"cycle\"", "\"all\""},
      {"materials.per", "\"model\"", "\"view\"", {k_random_material}},
      {"materials.vary", "{}", "{\"*.kd\"={uniform=[0.1,0.2]}}"},
      {"distractors.dir", path("models"), path("few_models"), {k_places}},
      {"distractors.count", "1", "2", {k_others, k_places}},
      {"distractors.place_m", "{disc=0.3}", "{disc=0.4}", {k_others}},
      {"distractors.size_m", "0.05", "0.06", {k_others, k_places}},
      {"distractors.turn", "\"none\"", "{rotation=\"up\"}", {k_others, k_places}},
      {"distractors.vary", "{}", "{\"*.kd\"={uniform=[0.1,0.2]}}", {k_others, k_places}},
      {"distractors.gap_m", "0", "0.2", {k_others, k_places}},
      {"distractors.tries", "1", "64", {k_others, "distractors.place_m={disc=0.2}"}},
      {"distractors.own", "false", "true", {k_others, k_places}},
      {"distractors.class",
       "\"\"",
       "\"other\"",
       {"distractors.dir=" + path("models"), k_places, "classes.from=" + path("all.cla")}},
      {"environments.dir", path("environments"), path("few_environments")},
      {"environments.files", paths("environments/plain"), paths("environments/floor")},
      {"environments.assign", "\"cycle\"", "\"all\""},
      {"environments.per", "\"view\"", "\"model\"", {k_random_place}},
      {"environments.turn_deg", "0", "30"},
      {"environments.gain", "1", "2"},
      {"environments.temperature_k", "false", "3000"},
      {"environments.vary", "{}", "{\"sky.gain\"={uniform=[2,3]}}"},
      // Those that stand too near are drawn again, and the view with them.
      {"lights",
       "[{type=\"point\",position_m=[0,0,5]}]",
       "[{type=\"point\",position_m={box=[[-0.1,-0.1,-0.05],[0.1,0.1,0.2]]}}]",
       {"camera.keep.clearance_m=0.04", "camera.azimuth_deg={uniform=[0,360]}"}},
      {"camera.keep.in_frame", "0", "1", {"camera.target={ball=0.12}"}},
      {"camera.keep.visible", "0", "0.5", {k_sunk}},
      {"camera.keep.clearance_m", "0", "0.2", {"camera.distance_m={uniform=[0.2,0.4]}"}},
      {"camera.keep.tries", "1", "64", {"camera.keep.visible=0.5", k_sunk}},
      {"camera.set", "\"orbit\"", "\"half-dodecahedron\""},
      {"camera.distance_m", "0.4", "\"fit\""},
      {"camera.fit_margin", "0.05", "0.1", {k_fit}},
      {"camera.normalise", "true", "false", {k_dodecahedron}},
      {"camera.positions", "[[0,-0.5,0.1]]", "[[0,-0.5,0.1],[0.5,0,0.1]]", {k_list}},
      {"camera.count", "4", "5"},
      {"camera.elevation_deg", "20", "30"},
      {"camera.azimuth_deg", "0", "30"},
      {"camera.position_m", "[0.4, 0, 0.1]", "[0.4, 0, 0.2]", {R"(camera.set="random")"}},
      {"camera.roll_deg", "0", "10"},
      {"camera.target", "[0, 0, 0]", "[0, 0, 0.01]"},
      {"camera.views", "[]", "[0, 1]"},
      {"camera.fov_deg", "49", "50"},
      {"camera.lens_radius_m", "0", "0.01"},
      {"camera.focus", "\"origin\"", "\"target\"", {k_lens, "camera.target=[0, 0, 0.05]"}},
      {"camera.focus_distance_m", "0.3", "0.4", {k_lens, R"(camera.focus="distance")"}},
      {"engine.width", "32", "33"},
      {"engine.height", "32", "33"},
      {"engine.spp", "1", "2"},
      {"engine.error", "false", "0.5"},
      {"engine.max_spp", "64", "128", {k_target}},
      {"engine.error_region", "\"image\"", "\"model\"", {k_target}},
      {"engine.keep_sums", "false", "true"},
      {"engine.depth_total", "6", "7"},
      {"engine.depth_diffuse", "4", "5"},
      {"engine.depth_glossy", "4", "5"},
      {"engine.depth_specular", "6", "7"},
      {"engine.roulette_depth", "3", "4"},
      {"engine.roulette_cap", "0.5", "0.6"},
      {"engine.filter_width", "3", "2"},
      {"engine.math", "\"strict\"", "\"fast\""},
      {"engine.outlier_limit", "0", "100"},
      {"engine.rejected_limit", "0.001", "0.5"},
      {"outputs.image", "\"png\"", "false"},
      {"outputs.mask", "true", "false"},
      {"outputs.depth", "false", "\"exr\""},
      {"outputs.planes", "[]", "[\"uv\"]"},
      {"outputs.tone_map", "\"environment\"", "\"autolinear\""},
      {"outputs.tone_map_scale", "1", "2", {k_linear}},
      {"outputs.tone_map_prescale", "1", "2", {k_reinhard}},
      {"outputs.tone_map_postscale", "1", "2", {k_reinhard}},
      {"outputs.tone_map_burn", "3", "4", {k_reinhard}},
      {"outputs.tone_map_gamma", "2.2", "2", {k_linear}},
      {"outputs.camera.exposure_ev", "0", "0.5"},
      {"outputs.camera.vignetting", "0", "0.5"},
      {"outputs.camera.blur_px", "0", "0.5"},
      {"outputs.camera.noise", "0", "0.01"},
      {"outputs.camera.jpeg_quality", "false", "90"},
      {"outputs.keep_film", "true", "false"},
  };
  flips.insert(flips.end(), others.begin(), others.end());
  for (const KeySpec& key : recipe_keys())
    if (key.name.starts_with("check."))
      flips.push_back(
          {key.name, std::string(key.default_value), key.range.contains(0.6) ? "0.6" : "2"});
  return flips;
}

TEST_F(Moving, EveryKeyMovesWhatItsRowSays) {
  std::vector<std::string_view> flipped = fixed_keys();
  const std::vector<Flip> all = flips();
  for (const Flip& flip : all) {
    flipped.push_back(flip.key);
    const KeySpec* row = find_key(flip.key);
    ASSERT_NE(row, nullptr) << flip.key;
    const Moves found = moved(plan_with(flip, flip.one), plan_with(flip, flip.other));
    EXPECT_EQ(static_cast<int>(found), static_cast<int>(row->moves)) << flip.key;
  }
  std::vector<std::string_view> names;
  for (const KeySpec& key : recipe_keys())
    names.push_back(key.name);
  EXPECT_THAT(flipped, testing::UnorderedElementsAreArray(names));
}

// What is without effect under other values moves nothing but the manifest.
TEST_F(Moving, NoPictureMovesByWhatIsNotInUse) {
  const Flip flips[] = {
      {"camera.focus", "\"origin\"", "\"target\"", {"camera.target=[0, 0, 0.05]"}},
      {"camera.focus_distance_m", "0.3", "0.4", {R"(camera.focus="distance")"}},
  };
  for (const Flip& flip : flips) {
    const Moves found = moved(plan_with(flip, flip.one), plan_with(flip, flip.other));
    EXPECT_EQ(static_cast<int>(found), static_cast<int>(Moves::manifest)) << flip.key;
  }
}

// engine.error is of the developed picture, so how that is developed decides what is traced.
TEST_F(Moving, TheToneMapMovesTheFilmOfAnErrorTarget) {
  for (const Flip& flip : flips()) {
    if (!flip.key.starts_with("outputs.tone_map")) continue;
    Flip with = flip;
    with.with.push_back(k_target);
    EXPECT_EQ(moved(plan_with(with, flip.one), plan_with(with, flip.other)), Moves::film)
        << flip.key;
  }
}

}  // namespace
}  // namespace ds
