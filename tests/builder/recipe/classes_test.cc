// SPDX-License-Identifier: Apache-2.0
#include "builder/recipe/recipe.h"
#include "tests/builder/recipe_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

namespace ds {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// model -> "class split" of its images.
std::map<std::string, std::string> labels_of(const Recipe& recipe) {
  std::map<std::string, std::string> labels;
  for (const ImageSpec& image : expand(recipe))
    labels[*image.model_name] = *image.class_path + " " + *image.split;
  return labels;
}

class RecipeClassesTest : public testing::Test {
 protected:
  RecipeClassesTest() {
    folder_.add("train.cla", "PSB 1\n2 3\nthing 0 0\nvehicle thing 3\ncar\n12\n13\n");
    folder_.add("test.cla", "PSB 1\n1 1\nplant 0 1\ntree.PLY\n");
  }
  static constexpr std::string_view k_both =
      "classes.train = \"train.cla\"\nclasses.test = \"test.cla\"\n";

  std::string both(std::string_view more) const { return std::string(k_both) + std::string(more); }

  RecipeFolder folder_;
};

TEST_F(RecipeClassesTest, GiveClassAndSplitAndAreCounted) {
  const Recipe recipe = folder_.read(k_both);
  const auto labels = labels_of(recipe);
  EXPECT_EQ(labels.at("car.ply"), "thing/vehicle train");
  EXPECT_EQ(labels.at("tree.PLY"), "plant test");
  EXPECT_EQ(labels.at("mug.off"), " ");
  EXPECT_EQ(recipe.coverage.listed, 4u);
  EXPECT_EQ(recipe.coverage.missing, 2u);
  EXPECT_EQ(recipe.coverage.unlisted, 1u);
  EXPECT_THAT(recipe.class_paths, ElementsAre("plant", "thing", "thing/vehicle"));
}

TEST_F(RecipeClassesTest, MayBeUnsetByTheEmptyPath) {
  const Recipe recipe = folder_.read(k_both, {"classes.train=\"\""});
  EXPECT_EQ(recipe.train_classes, std::nullopt);
  EXPECT_EQ(labels_of(recipe).at("car.ply"), " ");
  EXPECT_EQ(labels_of(recipe).at("tree.PLY"), "plant test");
}

TEST_F(RecipeClassesTest, MayBeStrictAboutDifferences) {
  EXPECT_EQ(folder_.findings(both("classes.missing = \"error\"")),
            "r.toml:6:19: classes.missing = \"error\" wants a file for every model listed, found "
            "none for 2 of 4, such as 12, 13");
  EXPECT_EQ(folder_.findings(both("classes.unlisted = \"error\"")),
            "r.toml:6:20: classes.unlisted = \"error\" wants every model in a class file, found 1 "
            "in none: mug.off");
  const Recipe recipe = folder_.read(both("classes.unlisted = \"skip\""));
  EXPECT_EQ(recipe.models.size(), 2u);
  EXPECT_EQ(recipe.coverage.unlisted, 1u);
  EXPECT_THAT(
      folder_.findings("classes.test = \"test.cla\"\nclasses.unlisted = \"skip\"",
                       {"models.files=[\"" + (folder_.path() / "models/car.ply").string() + "\"]"}),
      HasSubstr("leaves no model"));
}

TEST_F(RecipeClassesTest, ReportTheirOwnFindingsAmongTheRecipes) {
  folder_.add("test.cla", "PSB 1\n1 2\nplant 0 2\ntree\n");
  const std::string what = folder_.findings(both("engine.spp = 0"));
  EXPECT_THAT(what, HasSubstr("r.toml:6:14: engine.spp must be"));
  EXPECT_THAT(what, HasSubstr("test.cla:3: class plant must hold 2 models as it says, found 1"));
  folder_.add("test.cla", "PSB 1\n1 1\nplant 0 1\n13\n");
  EXPECT_EQ(folder_.findings(k_both),
            "test.cla:4: model 13 must not be in train and test, found in train.cla:7 too");
  EXPECT_EQ(folder_.findings("classes.train = \"none.cla\""),
            "r.toml:4:17: classes.train must name a file, found none at none.cla");
}

TEST_F(RecipeClassesTest, ThatHaveModelsInOneFileOnlyAreCounted) {
  folder_.add("train.cla", "PSB 1\n3 2\nthing 0 0\ncar thing 1\ncar\nmug 0 1\n12\n");
  folder_.add("test.cla", "PSB 1\n3 2\nthing 0 0\nautomobile thing 1\n13\nmug 0 1\n14\n");
  const ClassCoverage coverage = folder_.read(k_both).coverage;
  EXPECT_THAT(coverage.unshared.classes,
              ElementsAre("thing/automobile (test)", "thing/car (train)"));
  EXPECT_EQ(coverage.unshared.of, 3u);
  EXPECT_FALSE(coverage.unshared_allowed);
  EXPECT_TRUE(folder_.read(both("classes.unshared = \"keep\"")).coverage.unshared_allowed);
  EXPECT_EQ(folder_.findings(both("classes.unshared = \"error\"")),
            "r.toml:6:20: classes.unshared = \"error\" wants the same classes in both class files, "
            "found in one of them only: thing/automobile (test), thing/car (train)");
  EXPECT_EQ(folder_.read(k_both, {"classes.test=\"\""}).coverage.unshared.of, 0u);
}

TEST_F(RecipeClassesTest, OfOneModelAgreeWhateverItIsCalled) {
  folder_.add("test.cla", "PSB 1\n1 1\nplant 0 1\ncar.ply\n");
  EXPECT_THAT(
      folder_.findings(k_both),
      HasSubstr("train.cla:5: must list car.ply once, found car (thing/vehicle, train) and, in "
                "test.cla:4, car.ply (plant, test)"));
  // The name without an ending is another file's.
  folder_.add("models/car.off");
  EXPECT_EQ(folder_.findings(k_both), "");
}

TEST_F(RecipeClassesTest, MayLieBesideTheModels) {
  constexpr std::string_view k_beside =
      "materials.dir = \"materials\"\nenvironments.dir = \"places\"\nclasses.train = "
      "\"{models.dir}/../train.cla\"\n";
  const std::string models = (folder_.path() / "models").string();
  EXPECT_EQ(folder_.read_whole(k_beside, {"models.dir=" + models}).train_classes,
            folder_.path() / "train.cla");
  // No folder of models, so nothing lies beside it.
  const Recipe recipe = folder_.read_whole(k_beside, {"models.files=[\"" + models + "/car.ply\"]"});
  EXPECT_EQ(recipe.train_classes, std::nullopt);
  EXPECT_EQ(labels_of(recipe).at("car.ply"), " ");
}

TEST_F(RecipeClassesTest, ExcludeASplitByHash) {
  EXPECT_EQ(folder_.findings(both("classes.split.test = 0.5")),
            "r.toml:6:22: classes.split.test must not be given together with classes.train or "
            "classes.test");
  EXPECT_EQ(folder_.findings("classes.split = { test = 1.5, by = \"fold\" }"),
            "r.toml:4:26: classes.split.test must be a number in [0, 1], got 1.5\n"
            "r.toml:4:36: classes.split.by must be \"model\" or \"class\" or \"material\" or "
            "\"environment\" or \"view\", got \"fold\"");
}

TEST_F(RecipeClassesTest, ComeFromFolders) {
  const RecipeFolder folder;
  for (const char* model : {"vehicle/car/train/a.off", "vehicle/car/test/b.off", "mug/c.off"})
    folder.add(std::string("models/") + model);
  const std::string recursive = "models.recursive = true\n";
  const Recipe first = folder.read(recursive + "classes.from = \"folder\"");
  EXPECT_EQ(labels_of(first).at("a.off"), "vehicle train");
  EXPECT_EQ(labels_of(first).at("b.off"), "vehicle test");
  EXPECT_EQ(labels_of(first).at("c.off"), "mug ");
  EXPECT_EQ(labels_of(first).at("car.ply"), " ");
  EXPECT_EQ(first.coverage.unlisted, 3u) << "those that lie in no folder";
  EXPECT_THAT(first.class_paths, ElementsAre("mug", "vehicle"));
  const Recipe all = folder.read(recursive + "classes.from = \"folders\"\nmodels.names = \"path\"");
  EXPECT_EQ(labels_of(all).at("vehicle/car/train/a.off"), "vehicle/car train");
  EXPECT_THAT(all.class_paths, ElementsAre("mug", "vehicle", "vehicle/car"));
  EXPECT_EQ(folder.findings("classes.from = \"folder\""),
            "r.toml:4:16: classes.from wants models.dir and models.recursive = true: classes are "
            "the folders in it");
}

TEST_F(RecipeClassesTest, FoldersTellSplitsWhereAllBesideThemDo) {
  const std::string from =
      "models.recursive = true\nmodels.names = \"path\"\nclasses.from = \"folders\"\n";
  const RecipeFolder sets;
  for (const char* model : {"training/car/a.off", "Validation/car/b.off", "test/mug/c.off",
                            "test/d.off", "dev/x/dev/e.off"})
    sets.add(std::string("models/") + model);
  const auto labels = labels_of(sets.read(from));
  EXPECT_EQ(labels.at("training/car/a.off"), "car train");
  EXPECT_EQ(labels.at("Validation/car/b.off"), "car val");
  EXPECT_EQ(labels.at("test/mug/c.off"), "mug test");
  EXPECT_EQ(labels.at("test/d.off"), " test") << "of no class";
  EXPECT_EQ(labels.at("dev/x/dev/e.off"), "x/dev val") << "the first folder";
  EXPECT_EQ(labels_of(sets.read(from + "classes.split_folders = false")).at("test/mug/c.off"),
            "test/mug ");
  // Beside cars, dev and val are things; train and test stay what they were.
  const RecipeFolder things;
  for (const char* model : {"car/a.off", "dev/b.off", "val/c.off", "test/car/d.off",
                            "chair/valid/e.off", "chair/train/f.off"})
    things.add(std::string("models/") + model);
  const auto of_things = labels_of(things.read(from));
  EXPECT_EQ(of_things.at("dev/b.off"), "dev ");
  EXPECT_EQ(of_things.at("val/c.off"), "val ");
  EXPECT_EQ(of_things.at("test/car/d.off"), "car test");
  EXPECT_EQ(of_things.at("chair/valid/e.off"), "chair val");
  EXPECT_EQ(of_things.at("chair/train/f.off"), "chair train");
  EXPECT_EQ(things.findings("classes.split_folders = true"),
            "r.toml:4:25: classes.split_folders has no effect without classes.from = \"folder\" or "
            "\"folders\"");
}

TEST_F(RecipeClassesTest, ComeFromATableOrOneClassFile) {
  folder_.add("c.csv", "name,class,split\ncar,vehicle/car,test\nmug.off,mug,\ngone,mug,train\n");
  const Recipe recipe = folder_.read("classes.from = \"c.csv\"");
  EXPECT_EQ(labels_of(recipe).at("car.ply"), "vehicle/car test");
  EXPECT_EQ(labels_of(recipe).at("mug.off"), "mug ");
  EXPECT_EQ(recipe.coverage.missing, 1u);
  EXPECT_EQ(recipe.coverage.unlisted, 1u);
  EXPECT_THAT(canonical_recipe(recipe), HasSubstr("classes.from = \"c.csv\"\n"));
  // Where nothing says what is test, chance may.
  const std::string half = "classes.split.test = 1\n";
  const Recipe cla = folder_.read("classes.from = \"train.cla\"\n" + half);
  EXPECT_EQ(labels_of(cla).at("car.ply"), "thing/vehicle test");
  EXPECT_THAT(folder_.findings("classes.from = \"c.csv\"\n" + half),
              HasSubstr("classes.split.test must not be given where classes.from says"));
}

TEST_F(RecipeClassesTest, ComeFromOnePlaceOnly) {
  EXPECT_THAT(
      folder_.findings(both("classes.from = \"train.cla\"")),
      testing::AllOf(HasSubstr("classes.from must not be given together with classes.train"),
                     HasSubstr("classes.from must not be given together with classes.test")));
  EXPECT_THAT(folder_.findings("classes.from = \"folds\""),
              HasSubstr("classes.from must be \"folder\" or \"folders\" or a .csv file or a .cla "
                        "file, got \"folds\""));
  EXPECT_THAT(folder_.findings("classes.from = \"no.csv\""),
              HasSubstr("classes.from must name a file, found none at no.csv"));
  folder_.add("c.csv", "name\n");
  EXPECT_THAT(folder_.findings("classes.from = \"c.csv\""), HasSubstr("c.csv:1: must name the"));
}

}  // namespace
}  // namespace ds
