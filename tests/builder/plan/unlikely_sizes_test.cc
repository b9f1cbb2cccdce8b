// SPDX-License-Identifier: Apache-2.0
#include "builder/plan/unlikely_sizes.h"

#include "tests/builder/tiny_dataset.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace ds {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

/// The demo's lengths: a thing of 0.16 m on the floor, 0.252 m away, in a room.
ImageLengths usual() {
  ImageLengths image;
  image.camera.position = {0.252, 0, 0};
  image.width = image.height = 512;
  image.model = {{-0.08, -0.05, -0.0574}, {0.08, 0.05, 0.04}};
  image.environment_m = 4;
  return image;
}

ImageLengths with_lens(double radius_m, double focus_m = 0.252) {
  ImageLengths image = usual();
  image.camera.lens_radius_m = radius_m;
  image.camera.focus_distance_m = focus_m;
  return image;
}

Box scaled(const Box& box, double factor) {
  return {box.least * factor, box.most * factor};
}

TEST(UnlikelySizes, WhatIsMeantIsNotTalkedAbout) {
  EXPECT_EQ(unlikely_place(usual()), std::nullopt);
  ImageLengths image = usual();
  image.environment_m = 0;  // a sky
  image.model = scaled(image.model, 1000);
  image.camera.position = {252, 0, 0};
  EXPECT_EQ(unlikely_place(image), std::nullopt);
  image = usual();
  image.environment_m = 0.05;  // a turntable
  EXPECT_EQ(unlikely_place(image), std::nullopt);
  for (const double radius : {0.0, 0.0025, 0.02})
    EXPECT_EQ(unlikely_lens(with_lens(radius)), std::nullopt) << radius;
  EXPECT_EQ(unlikely_lens(with_lens(0.0025, 2)), std::nullopt) << "the room is sharp";
  EXPECT_EQ(unlikely_lens(with_lens(0, 252)), std::nullopt) << "a pinhole";
}

TEST(UnlikelySizes, AModelInMillimetres) {
  ImageLengths image = usual();
  image.model = scaled(image.model, 1000);
  EXPECT_EQ(unlikely_place(image), UnlikelySize::camera_inside);
  image.camera.position = {252, 0, 0};  // as "fit" has it
  EXPECT_EQ(unlikely_place(image), UnlikelySize::model_large);
  image.model = scaled(usual().model, 1e-3);
  image.camera.position = {0.252, 0, 0};
  EXPECT_EQ(unlikely_place(image), UnlikelySize::model_tiny);
}

TEST(UnlikelySizes, ACameraInMillimetres) {
  ImageLengths image = usual();
  image.camera.position = {252, 0, 0};
  EXPECT_EQ(unlikely_place(image), UnlikelySize::model_tiny);
  image.camera.position = {0.000252, 0, 0};
  EXPECT_EQ(unlikely_place(image), UnlikelySize::camera_inside);
}

TEST(UnlikelySizes, AnAngleOfViewInRadians) {
  ImageLengths image = usual();
  image.camera.fov_deg = 0.855;
  EXPECT_EQ(unlikely_place(image), UnlikelySize::view_narrow);
  image.camera.position = {12, 0, 0};  // which shows it whole
  EXPECT_EQ(unlikely_place(image), std::nullopt);
  image.camera.position = {6, 0, 0};  // a part of it, as is meant in a closeup
  EXPECT_EQ(unlikely_place(image), std::nullopt);
  image = usual();
  image.camera.fov_deg = 4;
  EXPECT_EQ(unlikely_place(image), std::nullopt);
}

TEST(UnlikelySizes, AModelOffThePicture) {
  for (const Vec3d off : {Vec3d{0, 0, -57.4}, Vec3d{0, 30, 0}, Vec3d{5, 0, 0}}) {
    ImageLengths image = usual();
    image.model = {image.model.least + off, image.model.most + off};
    EXPECT_EQ(unlikely_place(image), UnlikelySize::out_of_view) << off.x << off.y << off.z;
  }
  ImageLengths image = usual();
  image.camera.target = {1, 0, 0};  // it looks away
  EXPECT_EQ(unlikely_place(image), UnlikelySize::out_of_view);
}

TEST(UnlikelySizes, ALensInMillimetres) {
  EXPECT_EQ(unlikely_lens(with_lens(2.5)), UnlikelySize::lens_wide);
  EXPECT_EQ(unlikely_lens(with_lens(0.1)), UnlikelySize::lens_wide) << "wider than the model";
  EXPECT_EQ(unlikely_lens(with_lens(0.0025, 252)), UnlikelySize::out_of_focus);
  EXPECT_EQ(unlikely_lens(with_lens(0.0025, 0.000252)), UnlikelySize::out_of_focus);
  EXPECT_EQ(unlikely_lens(with_lens(0.02, 0.04)), UnlikelySize::out_of_focus) << "smeared";
}

class UnlikelySizesTest : public TinyDataset {
 protected:
  std::vector<std::string> lines_with(const std::vector<std::string>& overrides) {
    request.overrides = overrides;
    const Dataset dataset = open_dataset(request, Access::look, real_disk);
    Inputs inputs(*dataset.database);
    std::vector<std::string> lines;
    std::vector<PlannedImage> images;
    expand(dataset.recipe, [&](ImageSpec&& spec) { images.emplace_back().spec = std::move(spec); });
    const Concern all = find_unlikely_sizes(dataset.recipe, images, inputs, lines);
    EXPECT_EQ(all.of, images.size());
    EXPECT_EQ(all.count > 0, !lines.empty());
    return lines;
  }
};

TEST_F(UnlikelySizesTest, ALineForEachKindHasTheFiguresAndTheKey) {
  EXPECT_THAT(lines_with({}), ElementsAre());
  EXPECT_THAT(lines_with({"models.size_m=160"}),
              ElementsAre(AllOf(HasSubstr("8 of 8 images (box.off/0, box.off/1, box.off/2 and 5 "
                                          "more): the camera stands inside"),
                                HasSubstr("the model is 160 m long"),
                                HasSubstr("is models.size_m = 160 in millimetres?"))));
  EXPECT_THAT(lines_with({"camera.distance_m=400"}),
              ElementsAre(AllOf(HasSubstr("smaller than two pixels"),
                                HasSubstr("is camera.distance_m = 400 in millimetres?"))));
  EXPECT_THAT(lines_with({"camera.lens_radius_m=2.5"}),
              ElementsAre(AllOf(HasSubstr("its radius is 2.5 m"),
                                HasSubstr("is camera.lens_radius_m = 2.5 in millimetres?"))));
  EXPECT_THAT(lines_with({"camera.lens_radius_m=0.0025", "camera.focus=distance",
                          "camera.focus_distance_m=400"}),
              ElementsAre(HasSubstr("is camera.focus_distance_m = 400 in millimetres?")));
  EXPECT_THAT(lines_with({"camera.fov_deg=0.855"}),
              ElementsAre(HasSubstr("is camera.fov_deg = 0.855 in radians? it is in degrees, 48.99 "
                                    "of them")));
  EXPECT_THAT(lines_with({"models.ground_z_m=-57"}),
              ElementsAre(HasSubstr("nothing of the model is in front of the camera")));
  // One cause is one line: the lens is right for a model of 0.16 m.
  EXPECT_THAT(lines_with({"models.size_m=0.00016", "camera.lens_radius_m=0.002"}),
              ElementsAre(HasSubstr("models.size_m = 0.00016 is in metres")));
}

TEST_F(UnlikelySizesTest, AFileInMillimetresThatKeepsItsSize) {
  const std::filesystem::path file = recipe_folder() / "models/box.off";
  write_file_atomic(file, std::string_view("OFF\n4 4 0\n0 0 0\n90 0 0\n0 90 0\n0 0 160\n"
                                           "3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n"));
  EXPECT_THAT(
      lines_with({"models.size_m=0", "models.files=[\"" + file.string() + "\"]"}),
      ElementsAre(AllOf(HasSubstr("the model is 160 m long"),
                        HasSubstr("models.size_m = 0 takes the model file's lengths as metres"))));
}

}  // namespace
}  // namespace ds
