// SPDX-License-Identifier: Apache-2.0
#include "builder/plan/evenness.h"

#include "tests/builder/tiny_dataset.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace ds {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

/// Twelve models in two classes of two splits each.
class Evenness : public TinyDataset {
 protected:
  Evenness() {
    std::string table = "name,class,split\n";
    for (int i = 0; i < 12; ++i) {
      const std::string name = "m" + std::to_string(i) + ".off";
      std::filesystem::copy(recipe_folder() / "models/box.off", recipe_folder() / "models" / name);
      table += name + (i % 2 == 0 ? ",even," : ",odd,") + (i < 6 ? "train\n" : "test\n");
    }
    std::filesystem::remove(recipe_folder() / "models/box.off");
    std::filesystem::remove(recipe_folder() / "models/tetra.ply");
    write_file_atomic(recipe_folder() / "classes.csv", table);
  }
  std::vector<Uneven> uneven(const std::vector<std::string>& more, Plan* made = nullptr) {
    request.overrides = {"classes.from=\"" + (recipe_folder() / "classes.csv").string() + "\"",
                         "materials.assign=random"};
    request.overrides.insert(request.overrides.end(), more.begin(), more.end());
    const Plan planned = plan();
    std::vector<Uneven> found =
        find_uneven(read_recipe(request.target, request.overrides), planned);
    if (made != nullptr) *made = planned;
    return found;
  }
};

// The two materials of 6 models a split: 3 and 3 is even, 4 and 2 is a third more and less, 5 and 1 is not.
TEST_F(Evenness, SplitsAreToldWhereTheyAreFarFromEven) {
  std::size_t told = 0, silent = 0;
  for (int seed = 0; seed < 12; ++seed) {
    Plan plan;
    const auto found = uneven({"dataset.seed=" + std::to_string(seed)}, &plan);
    std::map<std::string, std::map<std::string, std::set<std::string>>> models;
    std::map<std::string, std::set<std::string>> of_class;
    for (const PlannedImage& image : plan.images) {
      models[*image.spec.split][*image.spec.material_name].insert(*image.spec.model_name);
      of_class[*image.spec.class_path + " (" + *image.spec.split + ")"].insert(
          *image.spec.material_name);
    }
    std::size_t most = 0;
    for (const auto& [split, by_material] : models)
      for (const auto& [material, of] : by_material)
        most = std::max(most, of.size());
    std::vector<std::string> lacking;
    for (const auto& [name, shown] : of_class)
      if (shown.size() == 1) lacking.push_back(name);
    const bool is_uneven = most >= 5;
    ASSERT_EQ(found.size(), is_uneven || !lacking.empty() ? 1U : 0U) << seed;
    if (found.empty()) {
      ++silent;
      continue;
    }
    ++told;
    EXPECT_EQ(found[0].kind, "materials");
    EXPECT_EQ(found[0].classes, 4U);
    EXPECT_THAT(found[0].lacking, testing::UnorderedElementsAreArray(lacking));
    EXPECT_EQ(found[0].most.empty(), !is_uneven) << seed;
    if (!is_uneven) continue;
    EXPECT_EQ(models[found[0].split][found[0].most].size(), most);
    EXPECT_DOUBLE_EQ(found[0].most_share, static_cast<double>(most) / 6);
    EXPECT_DOUBLE_EQ(found[0].even_share, 0.5);
    EXPECT_THAT(to_text(found[0]), HasSubstr("materials.assign = \"balanced\" evens them out"));
  }
  EXPECT_GT(told, 0U);
  EXPECT_GT(silent, 0U);
}

TEST_F(Evenness, WhatIsBalancedOrCycledOrSplitByIsNot) {
  for (int seed = 0; seed < 12; ++seed) {
    const std::string seeded = "dataset.seed=" + std::to_string(seed);
    EXPECT_THAT(uneven({seeded, "materials.assign=balanced"}), IsEmpty()) << seed;
    EXPECT_THAT(uneven({seeded, "materials.assign=cycle"}), IsEmpty()) << seed;
    EXPECT_THAT(uneven({seeded, "classes.from=\"\"", "classes.split.by=material",
                        "classes.split.test=0.5"}),
                IsEmpty())
        << seed;
  }
}

}  // namespace
}  // namespace ds
