// SPDX-License-Identifier: Apache-2.0
#include "manifests/classification.h"

#include "tracer/base/error.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

namespace ds {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;

std::string findings(std::string_view text) {
  try {
    parse_classification(text, "a.cla");
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::asset);
    return error.what();
  }
  return "";
}

constexpr std::string_view k_good =
    "PSB 1\n3 4\n\nvehicle 0 0\n\ncar vehicle 2\n1510\nhatchback.ply\n\nmug 0 2\nmug-1\nmug-2\n";

TEST(Classification, ReadsNamesParentsAndModels) {
  const Classification read = parse_classification(k_good, "a.cla");
  ASSERT_EQ(read.classes.size(), 3u);
  EXPECT_EQ(read.model_count, 4);
  EXPECT_EQ(read.leaf_count(), 2);
  EXPECT_EQ(read.path(0), "vehicle");
  EXPECT_EQ(read.path(1), "vehicle/car");
  EXPECT_EQ(read.path(2), "mug");
  EXPECT_EQ(read.classes[0].parent, -1);
  EXPECT_EQ(read.classes[1].parent, 0);
  EXPECT_THAT(read.classes[1].models, ElementsAre("1510", "hatchback.ply"));
  EXPECT_THAT(read.classes[1].model_lines, ElementsAre(7, 8));
}

TEST(Classification, TakesCarriageReturnsTabsAndNoFinalLineBreak) {
  const Classification read =
      parse_classification("PSB 1\r\n1 1\r\n\r\n\tcup\t0  1 \r\n 7 ", "a.cla");
  ASSERT_EQ(read.classes.size(), 1u);
  EXPECT_THAT(read.classes[0].models, ElementsAre("7"));
}

TEST(Classification, TakesAnyLineEndAndAByteOrderMark) {
  for (const std::string end : {"\n", "\r\n", "\r"}) {
    std::string text = "\xef\xbb\xbf";
    for (const char* line : {"PSB 1", "1 2", "", "cup 0 2", "7"})
      text += line + end;
    const Classification read = parse_classification(text + "8", "a.cla");
    ASSERT_EQ(read.classes.size(), 1u);
    EXPECT_THAT(read.classes[0].models, ElementsAre("7", "8"));
    EXPECT_THAT(read.classes[0].model_lines, ElementsAre(5, 6));
  }
  EXPECT_EQ(findings("\xff\xfeP"), "a.cla: must be UTF-8, found UTF-16");
}

// As a person's folder has them; a class of three words is none of these.
TEST(Classification, ReadsFileNamesWithBlanks) {
  const Classification read = parse_classification(
      "PSB 1\n2 4\nmug 0 3\ncoffee mug.ply\n  my old mug v2.off \nred mug big.obj\nv1.0 mug 1\n7\n",
      "a.cla");
  EXPECT_THAT(read.classes.at(0).models,
              ElementsAre("coffee mug.ply", "my old mug v2.off", "red mug big.obj"));
  EXPECT_EQ(read.path(1), "mug/v1.0");
  EXPECT_EQ(findings("PSB 1\n1 1\na 0 1.5\n1\n"),
            "a.cla:3: class a: the number of models must be a count, got 1.5");
}

TEST(Classification, NamesTheLineOfEachWrongCount) {
  EXPECT_EQ(findings("PSB 1\n2 3\n\na 0 2\n1\n\nb 0 1\n2\n3\n"),
            "a.cla:4: class a must hold 2 models as it says, found 1\n"
            "a.cla:7: class b must hold 1 models as it says, found 2");
}

// One model too few or too many, one line that is none, one class pasted twice.
TEST(Classification, SaysOneMistakeOnce) {
  EXPECT_EQ(findings("PSB 1\n2 3\na 0 2\n1\nb 0 1\n2\n"),
            "a.cla:3: class a must hold 2 models as it says, found 1");
  EXPECT_EQ(findings("PSB 1\n2 2\na 0 1\n1\nb 1\n2\n"),
            "a.cla:5: must be a class (name parent count) or a model (one word, or a file name "
            "with its ending), got "
            "2 words: b 1");
  EXPECT_EQ(findings("PSB 1\n2 2\na 0 1\n1\nb 0 one\n2\n"),
            "a.cla:5: class b: the number of models must be a count, got one");
  EXPECT_EQ(findings("PSB 1\n2 4\na 0 2\n1\n2\na 0 2\n1\n2\n"), "a.cla:6: class a stands twice");
}

TEST(Classification, ComparesTheHeaderWithWhatFollows) {
  EXPECT_EQ(findings("PSB 1\n2 5\n\na 0 1\n1\n"),
            "a.cla:2: must hold 2 classes as it says, found 1\n"
            "a.cla:2: must hold 5 models as it says, found 1");
}

TEST(Classification, RefusesAParentThatIsNoEarlierClass) {
  EXPECT_EQ(findings("PSB 1\n2 0\na b 0\nb 0 0\n"),
            "a.cla:3: class a: the parent must be an earlier class or 0, got b");
  EXPECT_EQ(findings("PSB 1\n1 0\na a 0\n"),
            "a.cla:3: class a: the parent must be an earlier class or 0, got a");
  EXPECT_EQ(
      findings("PSB 1\n4 0\nvehicle 0 0\ncar vehicel 0\nbus vehicel 0\nvan vehicel 0\n"),
      "a.cla:4: class car: the parent must be an earlier class or 0, got vehicel, did you mean "
      "vehicle?");
}

TEST(Classification, RefusesAModelInTwoClassesOrTwiceInOne) {
  EXPECT_EQ(findings("PSB 1\n2 2\na 0 1\n9\nb 0 1\n9\n"),
            "a.cla:6: model 9 stands in class b and already in class a (line 4)");
  EXPECT_EQ(findings("PSB 1\n1 2\na 0 2\n9\n9\n"),
            "a.cla:5: model 9 stands in class a and already in class a (line 4)");
}

TEST(Classification, RefusesWhatIsNoClassFile) {
  EXPECT_EQ(findings("OFF\n1 2 3\n"), "a.cla:1: must be \"PSB 1\", got \"OFF\"");
  EXPECT_EQ(findings("PSB 2\n"), "a.cla:1: must be \"PSB 1\", got \"PSB 2\"");
  EXPECT_EQ(findings(""),
            "a.cla: must start with \"PSB 1\" and the number of classes and models, found the end "
            "of the file");
  EXPECT_EQ(findings("PSB 1\n-1 99999999999\n"),
            "a.cla:2: must be the number of classes and of models, got \"-1 99999999999\"");
}

TEST(Classification, ModelsOfAClassThatIsNoneAreNoFindingsOfTheirOwn) {
  EXPECT_EQ(findings("PSB 1\n2 2\nmug cup 0 1\nbunny\n"),
            "a.cla:3: must be a class (name parent count) or a model (one word, or a file name "
            "with its ending), got 4 words: mug cup 0 1");
}

TEST(Classification, ReportsEverythingTogether) {
  EXPECT_EQ(findings("PSB 1\n3 1\n7\na 0 x\na 0 0\nb/c 0 1\n1\ntwo words\n"),
            "a.cla:3: model 7 stands before the first class\n"
            "a.cla:4: class a: the number of models must be a count, got x\n"
            "a.cla:5: class a stands twice\n"
            "a.cla:6: a class name must hold no / and no control character and be none of 0 . .., "
            "got \"b/c\"\n"
            "a.cla:8: must be a class (name parent count) or a model (one word, or a file name "
            "with its ending), got "
            "2 words: two words");
}

TEST(Labels, FindsByWholeNameThenStemThenBenchmarkNumber) {
  const Labels labels(
      parse_classification(k_good, "train.cla"),
      parse_classification("PSB 1\n1 3\ncup 0 3\n1510.off\nm1510x\n12\n", "test.cla"));
  EXPECT_EQ(labels.find("hatchback.ply"), (ModelLabel{"vehicle/car", "train"}));
  EXPECT_EQ(labels.find("hatchback.off"), std::nullopt);
  EXPECT_EQ(labels.find("mug-1.ply"), (ModelLabel{"mug", "train"}));
  EXPECT_EQ(labels.find("m1510.off"), (ModelLabel{"vehicle/car", "train"}));
  EXPECT_EQ(labels.find("1510.off"), (ModelLabel{"cup", "test"}));
  EXPECT_EQ(labels.find("1510.ply"), (ModelLabel{"vehicle/car", "train"}));
  EXPECT_EQ(labels.find("m1510x.off"), (ModelLabel{"cup", "test"}));
  EXPECT_EQ(labels.find("m12.off"), (ModelLabel{"cup", "test"}));
  EXPECT_EQ(labels.find("m012.off"), std::nullopt);
  EXPECT_EQ(labels.find("m.off"), std::nullopt);
  EXPECT_EQ(labels.find(""), std::nullopt);
  EXPECT_EQ(labels.size(), 7u);
}

TEST(Labels, FindModelsNamedByTheirPaths) {
  const Labels labels(parse_classification("PSB 1\n3 6\nchair 0 2\na/1/model.obj\na/2/model\n"
                                           "mug 0 2\nmug.off\ncup\nlamp 0 2\n17\na.b\n",
                                           "train.cla"),
                      std::nullopt);
  const auto class_of = [&](std::string_view model) {
    const auto label = labels.find(model);
    return label ? label->class_path : "";
  };
  EXPECT_EQ(class_of("a/1/model.obj"), "chair");
  EXPECT_EQ(class_of("a/1/model.ply"), "");
  EXPECT_EQ(class_of("a/2/model.obj"), "chair");
  EXPECT_EQ(class_of("b/2/model.obj"), "");
  EXPECT_EQ(class_of("x/mug.off"), "mug");
  EXPECT_EQ(class_of("x/y/cup.ply"), "mug");
  EXPECT_EQ(class_of("0/m17/m17.off"), "lamp");
  EXPECT_EQ(class_of("a.b/c"), "") << "a folder's dot begins no ending";
}

TEST(Labels, RefusesAModelInTrainAndTest) {
  const Classification train = parse_classification(k_good, "train.cla");
  const Classification test =
      parse_classification("PSB 1\n1 2\ncup 0 2\nmug-2\n1510\n", "test.cla");
  try {
    Labels labels(train, test);
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(),
                 "test.cla:4: model mug-2 must not be in train and test, found in train.cla:12 "
                 "too; and 1 more "
                 "models");
  }
}

TEST(Labels, AreEmptyWithoutClassFiles) {
  const Labels labels(std::nullopt, std::nullopt);
  EXPECT_EQ(labels.size(), 0u);
  EXPECT_EQ(labels.find("mug.ply"), std::nullopt);
}

TEST(ClassPaths, AreTheUnionSorted) {
  EXPECT_THAT(class_paths(parse_classification(k_good, "a"),
                          parse_classification("PSB 1\n2 0\nvehicle 0 0\nbus vehicle 0\n", "b")),
              ElementsAre("mug", "vehicle", "vehicle/bus", "vehicle/car"));
}

// The counts are those of the benchmark's own publication (Shilane et al. 2004, base
// classification) and of the issue.
TEST(Classification, ReadsTheBenchmarksOwnFiles) {
  const fs::path folder = fs::path(DS_SOURCE_DIR) / "../shared/data/psb";
  if (!fs::exists(folder)) GTEST_SKIP() << folder << " is not there";
  const Classification train = read_classification(folder / "train.cla");
  const Classification test = read_classification(folder / "test.cla");
  EXPECT_EQ(train.classes.size(), 129u);
  EXPECT_EQ(test.classes.size(), 131u);
  EXPECT_EQ(train.leaf_count(), 90);
  EXPECT_EQ(test.leaf_count(), 92);
  EXPECT_EQ(train.model_count, 907);
  EXPECT_EQ(test.model_count, 907);

  const Labels labels(train, test);
  EXPECT_EQ(labels.size(), 1814u);
  EXPECT_EQ(labels.find("m1299.off"), (ModelLabel{"aircraft/airplane/F117", "train"}));
  int in_train = 0, in_test = 0;
  for (const auto& model : fs::directory_iterator(folder / "models")) {
    const auto label = labels.find(model.path().filename().string());
    ASSERT_TRUE(label) << model.path();
    (label->split == "train" ? in_train : in_test) += 1;
  }
  EXPECT_EQ(in_train, 36);  // ../shared/data/README.md: 36 of each
  EXPECT_EQ(in_test, 36);
}

}  // namespace
}  // namespace ds
