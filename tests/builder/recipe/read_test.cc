// SPDX-License-Identifier: Apache-2.0
#include "builder/recipe/recipe.h"
#include "tests/builder/recipe_folder.h"
#include "tracer/scene/mesh_formats.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sys/stat.h>

namespace ds {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

std::vector<std::string> names(const std::vector<fs::path>& paths) {
  std::vector<std::string> all;
  for (const fs::path& path : paths)
    all.push_back(path.filename().string());
  return all;
}

std::vector<std::string> names(const std::vector<ModelFile>& models) {
  std::vector<std::string> all;
  for (const ModelFile& model : models)
    all.push_back(model.name);
  return all;
}

class RecipeReadTest : public testing::Test {
 protected:
  RecipeFolder folder_;
};

TEST_F(RecipeReadTest, FindsAssetsAndFillsInDefaults) {
  const Recipe recipe = folder_.read();
  EXPECT_EQ(recipe.name, "r");
  EXPECT_THAT(names(recipe.models), ElementsAre("car.ply", "mug.off", "tree.PLY"));
  EXPECT_THAT(names(recipe.materials), ElementsAre("clay.mat", "glass.mat", "steel.mat"));
  EXPECT_THAT(names(recipe.environments), ElementsAre("attic", "garden"));
  EXPECT_EQ(recipe.models[0].file, folder_.path() / "models/car.ply");
  EXPECT_TRUE(recipe.file.is_absolute());
  EXPECT_EQ(recipe.cameras.size(), 14u);
  EXPECT_EQ(recipe.view_names.back(), "13");
}

TEST_F(RecipeReadTest, TakesEveryKey) {
  const Recipe recipe =
      folder_.read(R"(
dataset = { name = "d-1", seed = 9223372036854775807, licence = "CC0" }
[engine]
width = 1
height = 16384
spp = 7
depth_total = 2
depth_diffuse = 0
depth_glossy = 1
depth_specular = 255
roulette_depth = 9
roulette_cap = 1
filter_width = 0
math = "fast"
[outputs]
image = "png"
mask = false
depth = "exr"
tone_map = "reinhard02"
tone_map_prescale = 2
tone_map_postscale = 3
tone_map_burn = 4
tone_map_gamma = 1
keep_film = false
)",
                   {"models.up=z", "models.size_m=0", "models.ground_z_m=false",
                    "models.centre=none", "models.normals=smooth", "models.crease_deg=10"});
  EXPECT_EQ(recipe.name, "d-1");
  EXPECT_EQ(recipe.seed, 9223372036854775807u);
  EXPECT_EQ(recipe.licence, "CC0");
  EXPECT_EQ(recipe.normalise.up, UpAxis::z);
  EXPECT_EQ(recipe.normalise.size_m, 0);
  EXPECT_FALSE(recipe.normalise.place_on_ground);
  EXPECT_EQ(recipe.normalise.centre, Centring::none);
  EXPECT_EQ(recipe.normalise.normals, Normals::smooth);
  EXPECT_EQ(recipe.normalise.crease_deg, 10);
  EXPECT_EQ(recipe.engine.width, 1);
  EXPECT_EQ(recipe.engine.height, 16384);
  EXPECT_EQ(recipe.engine.spp, 7);
  EXPECT_EQ(recipe.engine.depth_total, 2);
  EXPECT_EQ(recipe.engine.depth_diffuse, 0);
  EXPECT_EQ(recipe.engine.depth_glossy, 1);
  EXPECT_EQ(recipe.engine.depth_specular, 255);
  EXPECT_EQ(recipe.engine.roulette_depth, 9);
  EXPECT_EQ(recipe.engine.roulette_cap, 1);
  EXPECT_EQ(recipe.engine.filter_width, 0);
  EXPECT_EQ(recipe.engine.math, MathMode::fast);
  EXPECT_EQ(recipe.outputs.find_plane("mask"), nullptr);
  EXPECT_NE(recipe.outputs.find_plane("depth"), nullptr);
  ASSERT_TRUE(recipe.outputs.tone_map);
  EXPECT_EQ(recipe.outputs.tone_map->kind, ToneMap::Kind::reinhard02);
  EXPECT_EQ(recipe.outputs.tone_map->prescale, 2);
  EXPECT_EQ(recipe.outputs.tone_map->postscale, 3);
  EXPECT_EQ(recipe.outputs.tone_map->burn, 4);
  EXPECT_EQ(recipe.outputs.tone_map->gamma, 1);
  EXPECT_FALSE(recipe.keep_film);
}

TEST_F(RecipeReadTest, MapsEachChoiceToItsOwnMeaning) {
  EXPECT_EQ(folder_.read("models.centre = \"box\"").normalise.centre, Centring::box);
  EXPECT_EQ(folder_.read("models.centre = \"mass\"").normalise.centre, Centring::mass);
  EXPECT_EQ(folder_.read("models.normals = \"flat\"").normalise.normals, Normals::flat);
  EXPECT_EQ(folder_.read("models.normals = \"keep\"").normalise.normals, Normals::keep);
  EXPECT_EQ(folder_.read("materials.assign = \"cycle\"").assign_materials, Assign::cycle);
  EXPECT_EQ(folder_.read("environments.assign = \"all\"").assign_environments, Assign::all);
  EXPECT_EQ(folder_.read("materials.per = \"view\"").materials_per, ChoosePer::view);
  EXPECT_EQ(folder_.read("outputs.tone_map = \"autolinear\"").outputs.tone_map->kind,
            ToneMap::Kind::autolinear);
  EXPECT_EQ(folder_.read("outputs.tone_map = \"linear\"\noutputs.tone_map_scale = 5")
                .outputs.tone_map->scale,
            5);
}

TEST_F(RecipeReadTest, ReportsAllFindingsWithTheirPlacesInTheirOrder) {
  EXPECT_EQ(
      folder_.findings_whole("[camera]\n"                             // 1
                             "fov_deg = 190\n"                        // 2
                             "fov = 49\n"                             // 3
                             "[engine]\n"                             // 4
                             "width = 0\n"                            // 5
                             "height = 512.0\n"                       // 6
                             "spp = \"many\"\n"                       // 7
                             "math = \"Strict\"\n"                    // 8
                             "[models]\n"                             // 9
                             "dir = \"nowhere\"\n"                    // 10
                             "ground_z_m = true\n"                    // 11
                             "[materials]\n"                          // 12
                             "files = [\"materials/clay.mat\", 3]\n"  // 13
                             "[environments]\n"                       // 14
                             "files = [\"places/garden\",\n"          // 15
                             "  \"places/textures\"]\n"               // 16
                             "[fogbanks]\n"                           // 17
                             "[outputs]\n"                            // 18
                             "depth = true\n"),
      "r.toml:2:11: camera.fov_deg must be a number in (0, 180), got 190\n"
      "r.toml:3:7: camera.fov is no key of a recipe, did you mean camera.fov_deg?\n"
      "r.toml:5:9: engine.width must be an integer in [1, 16384], got 0\n"
      "r.toml:6:10: engine.height must be an integer in [1, 16384], got 512.0\n"
      "r.toml:7:7: engine.spp must be an integer in [1, 16777216], got \"many\"\n"
      "r.toml:8:8: engine.math must be \"strict\" or \"fast\", got \"Strict\", did you mean "
      "\"strict\"?\n"
      "r.toml:11:14: models.ground_z_m must be a number in [-1000000, 1000000] or false, got true\n"
      "r.toml:13:32: materials.files must be a list of paths (strings), got 3\n"
      "r.toml:17:2: fogbanks is no section of a recipe; there are dataset, models, classes, "
      "materials, distractors, "
      "environments, lights, camera, engine, outputs, check\n"
      "r.toml:19:9: outputs.depth must be \"exr\" or false, got true; outputs.planes = "
      "[\"depth\"] writes it\n"
      "r.toml:10:7: models.dir must be a folder, found nowhere: No such file or directory\n"
      "r.toml:16:3: environments.files must name a folder that holds an environment.scn, found "
      "none at "
      "places/textures");
}

TEST_F(RecipeReadTest, ReportsOverridesByTheirKey) {
  EXPECT_EQ(
      folder_.findings("", {"camera.fov_deg=190", "engine={spp=0}", "engine.widht=3", "nonsense"}),
      "--set: wants section.key=value, got \"nonsense\"\n"
      "--set camera.fov_deg: must be a number in (0, 180), got 190\n"
      "--set engine: engine.spp must be an integer in [1, 16777216], got 0\n"
      "--set engine.widht: is no key of a recipe, did you mean engine.width?");
}

TEST_F(RecipeReadTest, ReportsMissingSections) {
  EXPECT_EQ(
      folder_.findings_whole(""),
      "r.toml: models.dir or models.files must be given, for example with --set models.dir=FOLDER\n"
      "r.toml: materials.dir or materials.files must be given, for example with --set "
      "materials.dir=FOLDER\n"
      "r.toml: environments.dir or environments.files must be given, for example with --set "
      "environments.dir=FOLDER");
}

TEST_F(RecipeReadTest, ReportsWrongShapes) {
  EXPECT_EQ(folder_.findings("camera = 3"), "r.toml:4:10: camera must be a table of keys, got 3");
  // The right word in another section, but of another kind of value.
  EXPECT_THAT(folder_.findings("classes.val = \"val.cla\""),
              AllOf(HasSubstr("classes.val is no key of a recipe; classes has train, test"),
                    Not(HasSubstr("did you mean"))));
  EXPECT_THAT(folder_.findings("outputs.width = 64"), HasSubstr("did you mean engine.width?"));
  EXPECT_EQ(folder_.findings("[[camera]]\nfov_deg = 40"),
            "r.toml:4:1: camera must be one [camera], a table of keys, got [{fov_deg = 40}], as "
            "[[camera]] makes it");
  EXPECT_THAT(folder_.findings("[[classes.split]]\ntest = 0.5"),
              HasSubstr("classes.split must be one [classes.split], a table of keys"));
  EXPECT_THAT(folder_.findings("[[materials.vary]]\n\"a.kd\" = 0.5"),
              HasSubstr("; it is [materials.vary], not [[materials.vary]]"));
  EXPECT_EQ(folder_.findings("camera = []"), "r.toml:4:10: camera must be a table of keys, got []");
  EXPECT_EQ(folder_.findings("dataset.name = \"../x\""),
            "r.toml:4:16: dataset.name must be a string of letters, digits and . _ - that starts "
            "with no dot, got "
            "\"../x\"");
  EXPECT_EQ(folder_.findings("engine.filter_width = nan"),
            "r.toml:4:23: engine.filter_width must be a number in [0, 16], got nan");
  EXPECT_EQ(folder_.findings("dataset.seed = -1"),
            "r.toml:4:16: dataset.seed must be an integer >= 0, got -1");
  EXPECT_EQ(folder_.findings("models.up = [\"y\"]"),
            "r.toml:4:13: models.up must be \"y\" or \"z\", got [\"y\"]");
  EXPECT_EQ(folder_.findings("outputs.image = \"tiff\""),
            "r.toml:4:17: outputs.image must be \"png\" or false, got \"tiff\"");
}

TEST_F(RecipeReadTest, RefusesAKeyThatHasNoEffect) {
  // Of another set than the one that is named: what that one lacks is no fault of its own.
  EXPECT_EQ(folder_.findings("camera.set = \"list\"\ncamera.elevation_deg = 20"),
            "r.toml:5:24: camera.elevation_deg has no effect with camera.set = \"list\", only with "
            "camera.set = \"orbit\"");
  EXPECT_EQ(folder_.findings("camera.count = 8"),
            "r.toml:4:16: camera.count has no effect with camera.set = \"half-dodecahedron\", only "
            "with camera.set = "
            "\"orbit\" | \"hemisphere\" | \"random\"");
  // But not where --set has just chosen something else.
  const Recipe recipe =
      folder_.read("camera.set = \"orbit\"\ncamera.count = 8", {"camera.set=half-dodecahedron"});
  EXPECT_EQ(recipe.cameras.size(), 14u);
  EXPECT_EQ(folder_.findings("", {"camera.count=8"}),
            "--set camera.count: has no effect with camera.set = \"half-dodecahedron\", only with "
            "camera.set = "
            "\"orbit\" | \"hemisphere\" | \"random\"");
}

TEST_F(RecipeReadTest, TakesPathsFromTheRecipesFolderAndFromTheCurrentOneInSet) {
  const RecipeFolder other;
  other.add("more/vase.ply");
  const fs::path before = fs::current_path();
  fs::current_path(other.path());
  const Recipe recipe = folder_.read("", {"models.dir=more"});
  const std::string missing = folder_.findings("", {"materials.dir=more"});
  fs::current_path(before);
  ASSERT_EQ(recipe.models.size(), 1u);
  EXPECT_EQ(recipe.models[0].file, other.path() / "more/vase.ply");
  EXPECT_EQ(recipe.materials[0], folder_.path() / "materials/clay.mat");
  EXPECT_EQ(missing, "--set materials.dir: must hold a .mat file, found none in " +
                         (other.path() / "more").string());
}

TEST_F(RecipeReadTest, LetsSetReplaceDirByFilesAndBack) {
  const std::string file = (folder_.path() / "models/notes.txt").string();
  EXPECT_THAT(names(folder_.read("", {"models.files=[\"" + file + "\"]"}).models),
              ElementsAre("notes.txt"));
  const std::string dir = (folder_.path() / "models").string();
  EXPECT_EQ(folder_
                .read_whole("models.files = [\"models/car.ply\"]\nmaterials.dir = \"materials\"\n"
                            "environments.dir = \"places\"\n",
                            {"models.dir=" + dir})
                .models.size(),
            3u);
  EXPECT_EQ(folder_.findings("models.files = [\"models/car.ply\"]"),
            "r.toml:4:16: models.files must not be given together with models.dir");
}

TEST_F(RecipeReadTest, WantsOneOutputAtLeast) {
  EXPECT_FALSE(folder_.read("[outputs]\nimage = false\n").outputs.image);
  EXPECT_TRUE(folder_.read().outputs.image);
  EXPECT_EQ(folder_.findings("[outputs]\nimage = false\nmask = false\n"),
            "r.toml:5:9: outputs.image is off, and so are mask and depth; wanted one at least");
}

TEST_F(RecipeReadTest, APlaneIsAskedForOnce) {
  EXPECT_EQ(
      folder_.findings("[outputs]\ndepth = \"exr\"\nplanes = [\"depth:png16\"]\n"),
      "r.toml:5:9: outputs.depth is \"exr\", and outputs.planes has depth as png16; wanted one "
      "of the two");
  EXPECT_EQ(
      folder_.findings("[outputs]\nmask = false\nplanes = [\"mask\"]\n"),
      "r.toml:5:8: outputs.mask is off, and outputs.planes has mask as png8; wanted one of the "
      "two");
  EXPECT_EQ(folder_.findings("outputs.planes = [\"depth:png16\"]\n", {"outputs.depth=false"}),
            "--set outputs.depth: is off, and outputs.planes has depth as png16; wanted one of the "
            "two");
  // Both say the same, or one of them is a default.
  for (const char* text :
       {"mask = true\nplanes = [\"mask\"]", "planes = [\"mask\", \"depth:png16\"]",
        "depth = \"exr\"\nplanes = [\"depth\"]"})
    EXPECT_EQ(folder_.findings(std::string("[outputs]\n") + text), "") << text;
}

TEST_F(RecipeReadTest, ThePlaneThatIsMeantIsSaid) {
  EXPECT_EQ(folder_.findings("outputs.depth = \"png16\""),
            "r.toml:4:17: outputs.depth must be \"exr\" or false, got \"png16\"; outputs.planes = "
            "[\"depth:png16\"] writes it");
  EXPECT_EQ(folder_.findings("outputs.depth = \"png\""),
            "r.toml:4:17: outputs.depth must be \"exr\" or false, got \"png\"; outputs.planes = "
            "[\"depth:png16\"] writes it");
  EXPECT_EQ(folder_.findings("outputs.amodal_mask = true"),
            "r.toml:4:23: outputs.amodal_mask is no key of a recipe; outputs.planes = "
            "[\"amodal_mask\"] writes it");
}

TEST_F(RecipeReadTest, RefusesTwoModelsOfOneName) {
  folder_.add("more/car.ply");
  EXPECT_EQ(
      folder_.findings("", {"models.files=[\"" + (folder_.path() / "models/car.ply").string() +
                            "\", \"" + (folder_.path() / "more/car.ply").string() + "\"]"}),
      "--set models.files: must give each name once, got car.ply at models/car.ply and "
      "more/car.ply; models.names = \"path\" tells them apart");
  folder_.add("models/deeper/mug.off");
  EXPECT_EQ(folder_.findings(""), "");
  EXPECT_EQ(folder_.findings("models.recursive = true"),
            "r.toml:1:14: models.dir must give each name once, got mug.off at "
            "models/deeper/mug.off and models/mug.off; models.names = \"path\" tells them apart");
}

TEST_F(RecipeReadTest, NamesModelsByTheirPathsWhereTheRecipeWantsIt) {
  const std::string wanted = "models.names = \"path\"\n";
  folder_.add("models/chair/1/model.obj");
  folder_.add("models/chair/2/model.obj");
  folder_.add("models/mug/1/model.obj");
  const auto by_path = [&] {
    return names(folder_.read(wanted + "models.recursive = true").models);
  };
  EXPECT_THAT(by_path(), ElementsAre("car.ply", "chair/1/model.obj", "chair/2/model.obj", "mug.off",
                                     "mug/1/model.obj", "tree.PLY"));
  // Adding or removing others renames none, even where one is then the only one of its file name.
  fs::remove_all(folder_.path() / "models/chair/1");
  fs::remove_all(folder_.path() / "models/mug");
  EXPECT_THAT(by_path(), ElementsAre("car.ply", "chair/2/model.obj", "mug.off", "tree.PLY"));
  EXPECT_THAT(names(folder_.read("models.recursive = true").models),
              ElementsAre("car.ply", "model.obj", "mug.off", "tree.PLY"));
  // Files given one by one are called as they are written, below the dataset's folder.
  const std::string up = "../" + folder_.path().filename().string() + "/models/./mug.off";
  const Recipe files = folder_.read_whole(
      "models.files = [\"models/car.ply\", \"" + up + "\", \"" +
      (folder_.path() / "models/tree.PLY").string() +
      "\"]\nmaterials.dir = \"materials\"\nenvironments.dir = \"places\"\n" + wanted);
  const std::string folder = folder_.path().filename().string();
  EXPECT_THAT(names(files.models), testing::UnorderedElementsAre(
                                       "models/car.ply", folder + "/models/mug.off",
                                       folder_.path().string().substr(1) + "/models/tree.PLY"));
  for (const ModelFile& model : files.models)
    EXPECT_TRUE(fs::exists(model.file)) << model.name;
}

/// What reading warns of, the folder's own name taken out.
std::string warnings(const RecipeFolder& folder, std::string_view text) {
  testing::internal::CaptureStderr();
  folder.read(text);
  std::string said = testing::internal::GetCapturedStderr();
  for (std::size_t at = 0; (at = said.find(folder.path().string(), at)) != said.npos;)
    said.erase(at, folder.path().string().size() + 1);
  return said;
}

TEST_F(RecipeReadTest, CountsWhatIsNotUsedOfTheModelsFolder) {
  fs::remove(folder_.path() / "models/notes.txt");
  EXPECT_EQ(
      warnings(folder_, ""),
      "dsbuild: warning: models.dir: not used of models: 1 whose name begins with a dot, which "
      "hides it (.hidden.ply)\n");
  fs::remove(folder_.path() / "models/.hidden.ply");
  folder_.add("models/LICENSE");
  EXPECT_EQ(warnings(folder_, ""), "");
  folder_.add("models/a.blend");
  folder_.add("models/b.blend");
  folder_.add("models/c.FBX");
  folder_.add("models/deeper/again/vase.off");
  folder_.add("models/empty/words.txt");
  fs::create_symlink("nowhere.ply", folder_.path() / "models/gone.ply");
  EXPECT_EQ(warnings(folder_, ""),
            "dsbuild: warning: models.dir: not used of models: 3 files of other endings (1 .FBX, 2 "
            ".blend); " +
                mesh_endings_text(" and ") +
                " are read; 1 link that leads nowhere; 1 folder that holds models; "
                "models.recursive = true reads it\n");
  EXPECT_EQ(warnings(folder_, "models.recursive = true"),
            "dsbuild: warning: models.dir: not used of models: 4 files of other endings (1 .FBX, 2 "
            ".blend, 1 .txt); " +
                mesh_endings_text(" and ") + " are read; 1 link that leads nowhere\n");
  const RecipeFolder other;
  other.add("deep/a/b.off");
  EXPECT_THAT(other.findings("", {"models.dir=" + (other.path() / "deep").string()}),
              HasSubstr("found none in deep, but 1 folder that holds models; models.recursive"));
}

TEST_F(RecipeReadTest, CountsPipesAndSocketsOfAnyName) {
  fs::remove(folder_.path() / "models/notes.txt");
  fs::remove(folder_.path() / "models/.hidden.ply");
  ASSERT_EQ(::mkfifo((folder_.path() / "models/pipe.off").c_str(), 0600), 0);
  EXPECT_EQ(
      warnings(folder_, ""),
      "dsbuild: warning: models.dir: not used of models: 1 that is no file (a pipe, socket or "
      "device)\n");
  ASSERT_EQ(::mkfifo((folder_.path() / "models/README").c_str(), 0600), 0);
  folder_.add("models/a.blend");
  EXPECT_EQ(
      warnings(folder_, ""),
      "dsbuild: warning: models.dir: not used of models: 1 file of other endings (1 .blend); " +
          mesh_endings_text(" and ") +
          " are read; 2 that are no files (a pipe, socket or device)\n");
}

TEST_F(RecipeReadTest, FollowsLinkedFoldersOnce) {
  const RecipeFolder other;
  other.add("far/vase.ply");
  fs::create_directory_symlink(other.path() / "far", folder_.path() / "models/a");
  fs::create_directory_symlink(other.path() / "far", folder_.path() / "models/b");
  fs::create_directory_symlink("..", folder_.path() / "models/round");
  EXPECT_THAT(names(folder_.read("models.recursive = true").models),
              ElementsAre("car.ply", "mug.off", "tree.PLY", "vase.ply"));
}

TEST_F(RecipeReadTest, RefusesNamesThatAManifestCannotHold) {
  folder_.add("models/bad\nname.ply");
  EXPECT_THAT(folder_.findings(""),
              HasSubstr("r.toml:1:14: models.dir must give names of UTF-8 without control"));
  const RecipeFolder other;
  other.add("models/bad\xffname.ply");
  EXPECT_THAT(other.findings(""), HasSubstr("r.toml:1:14: models.dir must give names of UTF-8"));
}

TEST_F(RecipeReadTest, RefusesDotsInNamesThatBecomePartOfAStem) {
  folder_.add("materials/steel.v2.mat");
  EXPECT_EQ(folder_.findings(""), "");
  EXPECT_EQ(folder_.findings("materials.assign = \"all\""),
            "r.toml:4:20: materials.assign = \"all\" wants names without a dot, got steel.v2");
}

TEST_F(RecipeReadTest, SaysWhenThereIsNoRecipe) {
  try {
    read_recipe(folder_.path() / "none.toml", {});
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::recipe);
    EXPECT_THAT(error.what(),
                HasSubstr("none.toml: must be a recipe or the folder of a dataset, found no file"));
  }
}

TEST_F(RecipeReadTest, NamesADatasetByItsFile) {
  folder_.add("my set.toml", RecipeFolder::k_assets);
  EXPECT_THROW(read_recipe(folder_.path() / "my set.toml", {}), Error);
  EXPECT_EQ(read_recipe(folder_.path() / "my set.toml", {"dataset.name=x"}).name, "x");
}

TEST_F(RecipeReadTest, CanonicalTextHoldsValuesAndNamesButNoPath) {
  folder_.add("my.cla", "PSB 1\n1 1\nvehicle 0 1\ncar\n");
  const std::string text =
      canonical_recipe(folder_.read("classes.train = \"my.cla\"\ncamera.fov_deg = 50"));
  EXPECT_THAT(text, HasSubstr("dataset.name = \"r\"\n"));
  EXPECT_THAT(text, HasSubstr("models.files = [\"car.ply\", \"mug.off\", \"tree.PLY\"]\n"));
  EXPECT_THAT(text, HasSubstr("classes.train = \"my.cla\"\n"));
  EXPECT_THAT(text, HasSubstr("camera.fov_deg = 50.0\n"));
  EXPECT_THAT(text, HasSubstr("engine.spp = 64\n"));
  EXPECT_THAT(text, testing::Not(HasSubstr("camera.count")));
  EXPECT_EQ(text.find(folder_.path().filename().string()), text.npos);
}

TEST_F(RecipeReadTest, CanonicalTextIsTheSameFromAnotherFolderAndSpelling) {
  const RecipeFolder other;
  EXPECT_EQ(canonical_recipe(folder_.read("engine.spp = 16\ncamera.distance_m = 1")),
            canonical_recipe(
                other.read("# a comment\n[camera]\ndistance_m = 1.0e0", {"engine.spp=0x10"})));
}

// What ships must be readable; psb.toml needs the models' folder, and takes the class files beside
// it.
TEST(ShippedRecipes, AreRead) {
  const fs::path root = DS_SOURCE_DIR;
  const Recipe figurines = read_recipe(root / "recipes/figurines.toml", {});
  EXPECT_GE(figurines.models.size(), 12u);
  EXPECT_EQ(figurines.coverage.missing, 0u);
  EXPECT_EQ(figurines.coverage.unlisted, 0u);
  EXPECT_EQ(figurines.materials.size(), 3u);
  EXPECT_EQ(figurines.environments.size(), 3u);
}

TEST(ShippedRecipes, BenchmarkNeedsItsModelsAndTakesTheClassesBesideThem) {
  const fs::path root = DS_SOURCE_DIR;
  try {
    read_recipe(root / "recipes/psb.toml", {});
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(),
                testing::EndsWith("recipes/psb.toml: models.dir or models.files must be given, for "
                                  "example with --set models.dir=FOLDER"));
  }
  const fs::path models = root / "../shared/data/psb/models";
  if (!fs::exists(models)) GTEST_SKIP() << models << " is not there";
  const Recipe recipe = read_recipe(root / "recipes/psb.toml", {"models.dir=" + models.string()});
  EXPECT_EQ(recipe.models.size(), 72u);
  EXPECT_EQ(recipe.coverage.listed, 1814u);
  EXPECT_EQ(recipe.coverage.missing, 1742u);
  EXPECT_EQ(recipe.coverage.unlisted, 0u);
  EXPECT_EQ(recipe.engine.spp, 500);
  EXPECT_EQ(expand(recipe).size(), 72u * 14);
}

}  // namespace
}  // namespace ds
