// SPDX-License-Identifier: Apache-2.0
#include "builder/plan/unlikely_properties.h"

#include "manifests/manifest.h"
#include "tests/builder/tiny_dataset.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace ds {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

class UnlikelyPropertiesTest : public TinyDataset {
 protected:
  /// A tetrahedron whose vertices have these values behind their places.
  void put_model(const char* name, const char* properties, const char* values) {
    std::string text =
        std::string(
            "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
            "property float z\n") +
        properties + "element face 4\nproperty list uchar int vertex_indices\nend_header\n";
    for (const char* point : {"0 0 0", "4 0 0", "0 4 0", "0 0 4"})
      text += std::string(point) + " " + values + "\n";
    write_file_atomic(recipe_folder() / "models" / name,
                      text + "3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n");
  }
  void paint() {
    for (const char* name : {"green", "red"})
      write_file_atomic(recipe_folder() / "materials" / (std::string(name) + ".mat"),
                        std::string("scene.textures.paint.type = hitpointcolor\nscene.materials.") +
                            name + ".type = matte\nscene.materials." + name + ".kd = paint\n");
  }
  /// What is counted under a name, known afresh or from the database.
  Concern found(const char* name) {
    std::vector<Concern> all = no_concerns();
    for (const Concern& one : plan().concerns)
      concern(all, one.name.c_str()) = one;
    return concern(all, name);
  }
  std::vector<std::string> lines() {
    Dataset dataset = open_dataset(request, Access::look, real_disk);
    Inputs inputs(*dataset.database);
    const Plan all = make_plan(dataset, inputs, false, shard);
    std::vector<std::string> lines;
    find_unlikely_properties(dataset.recipe, all.images, inputs, lines);
    return lines;
  }
};

constexpr const char* k_colors = "property uchar Red\nproperty uchar Green\nproperty uchar Blue\n";
constexpr const char* k_normals = "property float nx\nproperty float ny\nproperty float nz\n";

TEST_F(UnlikelyPropertiesTest, ColoursCountWhereTheyAreRead) {
  put_model("dark.ply", k_colors, "1 0 1");
  EXPECT_EQ(found("models_unlikely"), (Concern{"models_unlikely", 0, 3, {}}));
  paint();
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(found("models_unlikely"), (Concern{"models_unlikely", 1, 3, {"dark.ply"}}));
    EXPECT_THAT(lines(),
                ElementsAre(AllOf(HasSubstr("1 of 3 models (dark.ply): some of their colours "
                                            "are integers that use 1/255"),
                                  HasSubstr("uchar runs from 0 to 255"))));
    build();
  }
}

TEST_F(UnlikelyPropertiesTest, NormalsCountWhereTheyAreKept) {
  for (const char* name : {"a.ply", "b.ply", "c.ply", "d.ply"})
    put_model(name, k_normals, "0 0 0");
  std::filesystem::remove(recipe_folder() / "models/box.off");
  std::filesystem::remove(recipe_folder() / "models/tetra.ply");
  EXPECT_EQ(found("models_unlikely").count, 0U);
  request.overrides = {"models.normals=\"keep\""};
  EXPECT_EQ(found("models_unlikely"),
            (Concern{"models_unlikely", 4, 4, {"a.ply", "b.ply", "c.ply"}}));
  EXPECT_THAT(lines(),
              ElementsAre(HasSubstr("4 of 4 models (a.ply, b.ply, c.ply and 1 more): some of "
                                    "their normals are of length 0, and faces there flat; "
                                    "models.normals = \"smooth\"")));
}

TEST_F(UnlikelyPropertiesTest, ModelsWithoutNormalsToKeepAreRefusedOnceEach) {
  put_model("a.ply", k_normals, "0 0 1");
  request.overrides = {"models.normals=\"keep\""};
  std::map<std::string, std::uint64_t> errors;
  for (const PlannedImage& image : plan().images)
    if (image.error) ++errors[image.error->what()];
  const std::string folder = (recipe_folder() / "models").string();
  const std::string wanted =
      ": has no normals to keep (models.normals = \"keep\"): \"smooth\" or \"flat\" makes them";
  EXPECT_EQ(errors, (std::map<std::string, std::uint64_t>{{folder + "/box.off" + wanted, 4},
                                                          {folder + "/tetra.ply" + wanted, 4}}));
  EXPECT_THAT(build({.keep_going = true}).failures, SizeIs(2)) << "once a model";
}

TEST_F(UnlikelyPropertiesTest, ModelsThatLostFacesAreCounted) {
  EXPECT_EQ(found("meshes_damaged"), (Concern{"meshes_damaged", 0, 4, {}}));
  write_file_atomic(recipe_folder() / "models/torn.off",
                    std::string_view("OFF\n4 5 0\n0 0 0\n4 0 0\n0 4 0\n0 0 4\n3 0 2 1\n3 0 1 3\n"
                                     "3 0 3 2\n3 1 2 3\n3 0 1 9\n"));
  EXPECT_EQ(found("meshes_damaged"), (Concern{"meshes_damaged", 1, 5, {"torn.off"}}));
  const BuildResult built = build();
  std::vector<Concern> concerns = built.concerns;
  EXPECT_EQ(concern(concerns, "meshes_damaged").count, 1U);
  EXPECT_EQ(read_dataset_manifest(output()).concerns, built.concerns);
  // Mended, the manifest is behind.
  edit("models/torn.off", "3 0 1 9", "3 0 1 2");
  EXPECT_EQ(found("meshes_damaged").count, 0U);
}

TEST_F(UnlikelyPropertiesTest, EnvironmentsThatLostFacesAreCounted) {
  edit("environments/floor/floor.ply", "element face 1", "element face 2");
  edit("environments/floor/floor.ply", "\n4 0 1 2 3", "\n4 0 1 2 3\n3 0 1 9");
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(found("meshes_damaged"), (Concern{"meshes_damaged", 1, 4, {"floor"}}));
    build();
  }
}

}  // namespace
}  // namespace ds
