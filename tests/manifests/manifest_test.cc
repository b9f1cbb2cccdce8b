// SPDX-License-Identifier: Apache-2.0
#include "manifests/manifest.h"

#include "manifests/json_text.h"
#include "tracer/base/error.h"
#include "tracer/base/files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cstdlib>
#include <fstream>
#include <limits>

namespace ds {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

FileRecord file_record(const fs::path& folder, const std::string& path, const std::string& kind) {
  return {path, kind, hash_file(folder / path), hash_text("pixels of " + path)};
}

/// A folder with two images of one model, as a build leaves it.
class ManifestTest : public testing::Test {
 protected:
  ManifestTest() {
    for (const char* id : {"mug.ply/10", "mug.ply/2"}) {
      const std::string stem = std::string("images/") + id;
      write_file_atomic(folder_ / (stem + ".png"), "picture " + stem);
      write_file_atomic(folder_ / (stem + ".mask.png"), "mask " + stem);
      ImageRecord image;
      image.id = id;
      image.model = "mug.ply";
      image.class_path = "vessel/mug";
      image.split = "train";
      image.material = "red-plastic";
      image.environment = "studio";
      image.view = image.id.substr(8);
      image.files = {file_record(folder_, stem + ".png", "image"),
                     file_record(folder_, stem + ".mask.png", "mask")};
      image.seed = (std::uint64_t{1} << 53) - 1;
      image.spp = 64;
      image.width = 256;
      image.height = 128;
      image.math = "strict";
      image.intrinsics = camera_intrinsics(49, 256, 128);
      image.camera_to_world = camera_pose(Camera{});
      image.lens_radius_m = 0.002;
      image.focus_distance_m = 0.1 + 0.2;
      image.tone_map_scale = 1.0 / 3;
      image.relative_error = 0.0625;
      image.rejected_samples = 3;
      image.pixel_counts = {30'000, 17, 4000, {}};
      image.class_id = 7;
      image.other_classes = {{"coarse", "vessel"}};
      image.draws = {{"camera.fov_deg", {{0.1 + 0.2}}}, {"outputs.quality", {{90}, true}}};
      image.pose = {{0, 2, 0, 0.1 + 0.2, -2, 0, 0, 4, 0, 0, 2, 5, 0, 0, 0, 1},
                    {{1, 2, 3}, {4, 5, 6}}};
      ObjectRecord object;
      object.id = 101;
      object.model = "ball.ply";
      object.class_path = "toy/ball";
      object.class_id = 0;
      object.material = "steel";
      object.pose = *image.pose;
      object.pixels = ObjectCounts{101, 30, 40, 2, 100, 150, 20, 98};
      image.objects.push_back(object);
      object.id = 103;
      object.class_path.clear();
      object.class_id.reset();
      object.pixels.reset();
      image.objects.push_back(object);
      image.film.samples = 256 * 128 * 64;
      image.film.least_spp = image.film.most_spp = 64;
      image.film.negative_samples = 3;
      image.film.removed_energy = 0.1 + 0.2;
      image.film.error_low = 0.0625 / 2;
      image.render_key = hash_text("key");
      image.files_key = hash_text("files");
      for (std::size_t i = 0; i < 5; ++i)
        image.parts[i] = hash_text("part " + std::to_string(i));
      images_.push_back(image);
    }
    dataset_.name = "mugs";
    dataset_.licence = "CC0-1.0";
    dataset_.recipe_text = "dataset.name = \"mugs\"\n";
    dataset_.dsbuild_version = "0.1.0";
    dataset_.seed = 7;
    dataset_.class_paths = {"vessel", "vessel/mug"};
    dataset_.counts = {{"images", 2}, {"models", 1}};
    dataset_.draws["camera.fov_deg"] = {"{uniform = [0.0, 1.0]}", 2, {0.25}, {0.5}, {0.1 + 0.2}};
    dataset_.draws["camera.target"] = {"{ball = 1.0}", 0, {}, {}, {}};
    dataset_.licences = {
        {"CC0-1.0", "CC0 1.0 Universal\n", {"environments/studio", "models/mug.ply"}},
        {"", "all mine", {"materials/red-plastic.mat"}}};
    dataset_.sources = {{"https://a.org", "from https://a.org", {"models/mug.ply"}},
                        {"", "by hand", {"materials/red-plastic.mat"}}};
  }

  std::string read(const std::string& path) const { return read_text_file(folder_ / path); }
  fs::path path() const { return folder_; }
  int check_with_xxhsum() const {
    const std::string command = "cd '" + folder_.string() +
                                "' && xxhsum --status -c manifest/checksums.xxh128 >/dev/null 2>&1";
    return std::system(command.c_str());
  }

  TemporaryFolder temporary_;
  fs::path folder_ = temporary_.path();
  DatasetRecord dataset_;
  std::vector<ImageRecord> images_;
};

TEST_F(ManifestTest, SaysOfObjectsWhatItSaysOfTheModel) {
  const nlohmann::json line = nlohmann::json::parse(to_json_line(images_[0]));
  const nlohmann::json& one = line["objects"][0];
  for (const char* key : {"model_to_world", "model_to_camera", "model_box", "box_m"})
    EXPECT_EQ(one[key], line[key]) << key;
  EXPECT_EQ(one["box"], nlohmann::json({100, 20, 6, 10}));  // of 256 x 128
  EXPECT_EQ(one["visible_fraction"], 0.75);
  EXPECT_EQ(one["occlusion"], 0.25);
  EXPECT_FALSE(line["objects"][1].contains("box"));
  EXPECT_TRUE(line["objects"][1]["class_id"].is_null());
  EXPECT_FALSE(line["pixel_counts"].contains("objects"));
  images_[0].objects[0].pixels = ObjectCounts{101, 0, 0, 0, 256, 256, 128, 128};
  const nlohmann::json hidden = nlohmann::json::parse(to_json_line(images_[0]))["objects"][0];
  EXPECT_TRUE(hidden["box"].is_null() && hidden["visible_fraction"].is_null());
  nlohmann::json wrong = line;
  wrong["objects"][0]["pixels"].erase("seen");
  EXPECT_THROW(image_from_json_line(wrong.dump(), "images.jsonl", 1), Error);
}

TEST_F(ManifestTest, ReadsBackWhatWasWritten) {
  write_manifest(folder_, dataset_, images_);
  const auto images = read_images_manifest(folder_);
  ASSERT_EQ(images.size(), 2u);
  EXPECT_EQ(images[0].id, "mug.ply/10");  // by the bytes of the id
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(to_json_line(images[i]), to_json_line(images_[i]));
    EXPECT_EQ(images[i].seed, images_[i].seed);
    EXPECT_EQ(images[i].focus_distance_m, 0.1 + 0.2);
    EXPECT_EQ(images[i].tone_map_scale, 1.0 / 3);
    EXPECT_EQ(images[i].relative_error, 0.0625);
    EXPECT_EQ(images[i].film, images_[i].film);
    EXPECT_EQ(images[i].pixel_counts, images_[i].pixel_counts);
    EXPECT_EQ(images[i].class_id, 7U);
    EXPECT_EQ(images[i].other_classes, images_[i].other_classes);
    EXPECT_EQ(images[i].draws, images_[i].draws);
    EXPECT_EQ(images[i].pose, images_[i].pose);
    ASSERT_EQ(images[i].objects.size(), 2U);
    EXPECT_EQ(images[i].objects[0].pixels, images_[i].objects[0].pixels);
    EXPECT_EQ(images[i].objects[0].class_id, 0U);
    EXPECT_EQ(images[i].objects[0].pose, images_[i].objects[0].pose);
    EXPECT_FALSE(images[i].objects[1].pixels || images[i].objects[1].class_id);
    EXPECT_EQ(images[i].intrinsics, images_[i].intrinsics);
    EXPECT_EQ(images[i].camera_to_world, images_[i].camera_to_world);
    EXPECT_EQ(images[i].parts, images_[i].parts);
    ASSERT_EQ(images[i].files.size(), 2u);
    EXPECT_EQ(images[i].files[1].hashes.sha256, images_[i].files[1].hashes.sha256);
    EXPECT_EQ(images[i].files[1].hashes.size_bytes, images_[i].files[1].hashes.size_bytes);
    EXPECT_EQ(images[i].files[1].pixels, images_[i].files[1].pixels);
  }
  EXPECT_EQ(to_json(read_dataset_manifest(folder_)), to_json(dataset_));
}

TEST_F(ManifestTest, ACameraOfParallelRaysHasNoIntrinsics) {
  images_[0].camera_model = "orthographic";
  images_[0].intrinsics = std::nullopt;
  images_[0].metres_per_pixel = 0.5 / 256;
  const std::string line = to_json_line(images_[0]);
  EXPECT_THAT(line, HasSubstr("\"intrinsics\":null"));
  EXPECT_THAT(to_json_line(images_[1]), testing::Not(HasSubstr("metres_per_pixel")));
  write_manifest(folder_, dataset_, images_);
  for (const ImageRecord& image : read_images_manifest(folder_)) {
    const bool parallel = image.camera_model == "orthographic";
    EXPECT_EQ(image.intrinsics.has_value(), !parallel);
    EXPECT_EQ(image.metres_per_pixel.has_value(), parallel);
    if (parallel) {
      EXPECT_EQ(to_json_line(image), line);
    }
  }
}

TEST_F(ManifestTest, NamesMendedModelsAndOnlyThose) {
  EXPECT_THAT(to_json(dataset_), testing::Not(HasSubstr("mended_models")));
  EXPECT_TRUE(dataset_from_json(to_json(dataset_), "d").mended_models.empty());
  dataset_.mended_models = {{"mug.ply", {{"non_finite", 1}, {"out_of_range", 12}}}};
  const std::string text = to_json(dataset_);
  EXPECT_EQ(dataset_from_json(text, "d").mended_models, dataset_.mended_models);
  auto wrong = nlohmann::json::parse(text);
  wrong["mended_models"]["mug.ply"]["non_finite"] = -1;
  EXPECT_THROW(dataset_from_json(wrong.dump(), "d"), Error);
  wrong["mended_models"]["mug.ply"] = 3;
  EXPECT_THROW(dataset_from_json(wrong.dump(), "d"), Error);
  wrong["mended_models"] = nlohmann::json::array();
  EXPECT_THROW(dataset_from_json(wrong.dump(), "d"), Error);
}

TEST_F(ManifestTest, HoldsSources) {
  auto object = nlohmann::json::parse(to_json(dataset_));
  EXPECT_EQ(object["sources"][0]["url"], "https://a.org");
  EXPECT_TRUE(object["sources"][1]["url"].is_null());
  EXPECT_EQ(dataset_from_json(object.dump(), "d").sources, dataset_.sources);
  object["sources"] = "https://a.org";
  EXPECT_THROW(dataset_from_json(object.dump(), "d"), Error);
  object.erase("sources");
  EXPECT_TRUE(dataset_from_json(object.dump(), "d").sources.empty());
}

TEST_F(ManifestTest, HoldsEachLicenceOnce) {
  const auto object = nlohmann::json::parse(to_json(dataset_));
  ASSERT_EQ(object["licences"].size(), 2u);
  EXPECT_EQ(object["licences"][0]["spdx"], "CC0-1.0");
  EXPECT_EQ(object["licences"][0]["assets"].size(), 2u);
  EXPECT_TRUE(object["licences"][1]["spdx"].is_null());
  EXPECT_EQ(dataset_from_json(object.dump(), "d").licences, dataset_.licences);
  for (const nlohmann::json& wrong :
       {nlohmann::json("CC0-1.0"), nlohmann::json::array({1}),
        nlohmann::json::array({{{"spdx", 1}, {"text", ""}, {"assets", nlohmann::json::array()}}}),
        nlohmann::json::array({{{"spdx", nullptr}, {"text", ""}, {"assets", "mug.ply"}}})}) {
    auto damaged = object;
    damaged["licences"] = wrong;
    EXPECT_THROW(dataset_from_json(damaged.dump(), "d"), Error) << wrong;
  }
}

// What dsbuild wrote before format 2: the text beside each asset's name, whole floats as integers.
TEST_F(ManifestTest, ReadsFormat1) {
  auto object = nlohmann::json::parse(to_json(dataset_));
  object["format"] = 1;
  object["licences"] = {{"environments/studio", "CC0 1.0 Universal\n"},
                        {"materials/red-plastic.mat", "all mine"},
                        {"models/mug.ply", "CC0 1.0 Universal\n"}};
  EXPECT_EQ(dataset_from_json(object.dump(), "d").licences, dataset_.licences);
  auto line = nlohmann::json::parse(to_json_line(images_[0]));
  line["lens_radius_m"] = 0;
  line["camera_to_world"][0] = {0, 0, -1, 0.252};
  const ImageRecord image = image_from_json_line(line.dump(), "images.jsonl", 1);
  EXPECT_EQ(image.lens_radius_m, 0);
  EXPECT_EQ(image.camera_to_world, images_[0].camera_to_world);
}

TEST_F(ManifestTest, DoesNotDependOnTheOrderOfTheImages) {
  write_manifest(folder_, dataset_, images_);
  const std::string lines = read("manifest/images.jsonl"), sums = read("manifest/checksums.xxh128");
  std::swap(images_[0], images_[1]);
  write_manifest(folder_, dataset_, images_);
  EXPECT_EQ(read("manifest/images.jsonl"), lines);
  EXPECT_EQ(read("manifest/checksums.xxh128"), sums);
}

TEST_F(ManifestTest, LinesAreCanonical) {
  const std::string line = to_json_line(images_[0]);
  EXPECT_THAT(line, HasSubstr("\"focus_distance_m\":0.30000000000000004,"));
  EXPECT_THAT(line, HasSubstr("\"seed\":9007199254740991,"));
  EXPECT_THAT(line, HasSubstr("\"camera_to_world\":[[0.0,0.0,-1.0,0.252],[1.0,0.0,0.0,0.0],"
                              "[0.0,-1.0,0.0,0.0],[0.0,0.0,0.0,1.0]]"));
  EXPECT_THAT(line, HasSubstr("\"tone_map_scale\":0.3333333333333333,"));
  EXPECT_EQ(line.find(' '), line.npos);
  EXPECT_TRUE(
      line.starts_with("{\"box_m\":[[4.3,-4.0,11.0],[10.3,2.0,17.0]],\"camera_convention\":"
                       "\"opencv\",\"camera_model\":\"perspective\",\"camera_to_world\":"));
  // Another JSON library's idea of sorted keys without spaces agrees but for the spelling of
  // numbers.
  const auto parsed = nlohmann::json::parse(line);
  EXPECT_EQ(canonical_json(parsed), line);
}

TEST_F(ManifestTest, ChecksumsAreWhatXxhsumReads) {
  if (std::system("xxhsum --version >/dev/null 2>&1") != 0)
    GTEST_SKIP() << "xxhsum is not installed";
  write_manifest(folder_, dataset_, images_);
  EXPECT_EQ(check_with_xxhsum(), 0);
  // Each file that the manifest covers, itself included.
  for (const char* path : {"images/mug.ply/2.png", "images/mug.ply/10.mask.png",
                           "manifest/images.jsonl", "manifest/dataset.json"}) {
    const std::string text = read(path);
    std::ofstream(folder_ / path, std::ios::binary) << text << "x";
    EXPECT_NE(check_with_xxhsum(), 0) << path;
    std::ofstream(folder_ / path, std::ios::binary) << text;
    EXPECT_EQ(check_with_xxhsum(), 0) << path;
  }
}

TEST_F(ManifestTest, ChecksumsAreTheToolsOwnOutput) {
  if (std::system("xxhsum --version >/dev/null 2>&1") != 0)
    GTEST_SKIP() << "xxhsum is not installed";
  write_manifest(folder_, dataset_, images_);
  const std::string command =
      "cd '" + folder_.string() +
      "' && find images manifest -type f ! -name checksums.xxh128 | LC_ALL=C sort | xargs "
      "xxhsum -H2 > tool";
  ASSERT_EQ(std::system(command.c_str()), 0);
  EXPECT_EQ(read("manifest/checksums.xxh128"), read("tool"));
}

TEST_F(ManifestTest, RefusesWhatNoManifestCanSay) {
  auto twice = images_;
  twice.push_back(images_[0]);
  EXPECT_THROW(write_manifest(folder_, dataset_, twice), Error);
  for (const char* path :
       {"/tmp/a.png", "../a.png", "images/../../a.png", "a\nb.png", "a\\b.png", ""}) {
    auto images = images_;
    images[0].files[0].path = path;
    EXPECT_THROW(write_manifest(folder_, dataset_, images), Error) << path;
  }
  auto images = images_;
  images[0].tone_map_scale = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(write_manifest(folder_, dataset_, images), Error);
  images = images_;
  images[0].model = "\xff";
  EXPECT_THROW(write_manifest(folder_, dataset_, images), Error);
  EXPECT_FALSE(fs::exists(folder_ / "manifest"))
      << "nothing is written before all is known to be right";
}

TEST_F(ManifestTest, ReadsLinesOfBeforeTheFilmsFacts) {
  nlohmann::json line = nlohmann::json::parse(to_json_line(images_[0]));
  line.erase("film");
  line.erase("pixel_counts");
  for (const char* later : {"class_id", "classes", "model_to_world", "model_box", "box_m"})
    line.erase(later);
  EXPECT_FALSE(image_from_json_line(line.dump(), "images.jsonl", 1).pose);
  EXPECT_EQ(image_from_json_line(line.dump(), "images.jsonl", 1).film, FilmFacts{});
  EXPECT_EQ(image_from_json_line(line.dump(), "images.jsonl", 1).pixel_counts, PixelCounts{});
}

TEST_F(ManifestTest, SaysWhereTheModelIsInTheWorldAndInTheCamera) {
  ImageRecord& image = images_[0];
  // The camera at (10, 0, 0) looks back along x: right is y, down is -z.
  image.camera_to_world = {0, 0, -1, 10, 1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 0, 1};
  const auto line = nlohmann::json::parse(to_json_line(image));
  // Twice as large, turned by -90 degrees about z, moved by (0.3, 4, 5).
  EXPECT_EQ(line["box_m"], nlohmann::json::parse("[[4.3, -4.0, 11.0], [10.3, 2.0, 17.0]]"));
  // The file's (0, 0, 0) is at (0.3, 4, 5): 4 to the right, 5 up, 9.7 before the camera.
  const auto& cv = line["model_to_camera"]["opencv"];
  EXPECT_EQ(cv[0], nlohmann::json::parse("[-2.0, 0.0, 0.0, 4.0]"));
  EXPECT_EQ(cv[1], nlohmann::json::parse("[0.0, 0.0, -2.0, -5.0]"));
  EXPECT_EQ(cv[2][1], -2.0);
  EXPECT_DOUBLE_EQ(cv[2][3].get<double>(), 9.7);
  const auto& gl = line["model_to_camera"]["opengl"];
  EXPECT_EQ(gl[0], cv[0]);
  EXPECT_EQ(gl[1], nlohmann::json::parse("[0.0, 0.0, 2.0, 5.0]"));
  EXPECT_DOUBLE_EQ(gl[2][3].get<double>(), -9.7);
}

TEST_F(ManifestTest, NamesLineAndFieldOfEveryDamage) {
  write_manifest(folder_, dataset_, images_);
  nlohmann::json first = nlohmann::json::parse(to_json_line(images_[0]));
  first["spp"] = -1;
  first["render_key"] = "zz";
  first["film"]["most_spp"] = 0x100000000;
  first["camera_to_world"][3] = {0, 0, 1};
  first.erase("view");
  write_file_atomic(folder_ / "manifest/images.jsonl",
                    first.dump() + "\n{]\n[1]\n" + to_json_line(images_[1]));
  try {
    read_images_manifest(folder_);
    FAIL() << "no error";
  } catch (const Error& error) {
    const std::string what = error.what();
    EXPECT_EQ(error.kind(), ErrorKind::asset);
    EXPECT_THAT(what, HasSubstr("images.jsonl:1: spp must be a count, got -1\n"));
    EXPECT_THAT(what,
                HasSubstr("images.jsonl:1: film.most_spp must be a count, a number or a truth, "
                          "got 4294967296\n"));
    EXPECT_THAT(
        what, HasSubstr("images.jsonl:1: render_key must be 32 hexadecimal digits, got \"zz\"\n"));
    EXPECT_THAT(what, HasSubstr("images.jsonl:1: camera_to_world must be rows of numbers, got "));
    EXPECT_THAT(what, HasSubstr("images.jsonl:1: view must be there\n"));
    EXPECT_THAT(what, HasSubstr("images.jsonl:2: must be a JSON object: "));
    EXPECT_THAT(what, HasSubstr("images.jsonl:3: must be a JSON object, got array\n"));
    EXPECT_THAT(what, HasSubstr("images.jsonl:4: must end in a line break: the file is cut off"));
  }
}

TEST_F(ManifestTest, SaysWhenItIsMissingOrOfAnotherFormat) {
  EXPECT_THROW(read_images_manifest(folder_), Error);
  EXPECT_THROW(read_dataset_manifest(folder_), Error);
  auto dataset = nlohmann::json::parse(to_json(dataset_));
  dataset["format"] = k_manifest_format + 1;
  EXPECT_THROW(dataset_from_json(dataset.dump(), "d"), Error);
}

TEST(CanonicalJson, WritesEachNumberInItsShortestForm) {
  const nlohmann::json values = {0.1, -0.0, 1.0, 1e300, 5e-324, 123456789.125, 3, -7};
  EXPECT_EQ(canonical_json(values), "[0.1,0.0,1.0,1e+300,5e-324,123456789.125,3,-7]");
  const auto back = nlohmann::json::parse(canonical_json(values));
  for (std::size_t i = 0; i < values.size(); ++i)
    EXPECT_EQ(back[i], values[i]);
  // A reader that takes a column's type from a row gets the same from every row.
  for (std::size_t i = 0; i < values.size(); ++i)
    EXPECT_EQ(back[i].is_number_float(), i < 6) << values[i];
}

TEST(CanonicalJson, SortsKeysByBytesAndIndents) {
  const nlohmann::json value = {
      {"b", nlohmann::json::array()}, {"a", {{"z", 1}, {"A", nullptr}}}, {"é", "ü\n"}};
  EXPECT_EQ(canonical_json(value), "{\"a\":{\"A\":null,\"z\":1},\"b\":[],\"é\":\"ü\\n\"}");
  EXPECT_EQ(canonical_json({{"a", {1, true}}}, 2), "{\n  \"a\": [\n    1,\n    true\n  ]\n}\n");
}

}  // namespace
}  // namespace ds
