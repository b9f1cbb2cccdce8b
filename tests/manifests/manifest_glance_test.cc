// SPDX-License-Identifier: Apache-2.0
// A glance at a line says what taking it apart says, or nothing.
#include "manifests/manifest_glance.h"

#include "tracer/base/error.h"
#include "tracer/base/files.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

namespace ds {
namespace {

void expect_same(const LineGlance& a, const LineGlance& b) {
  EXPECT_EQ(a.id, b.id);
  EXPECT_EQ(a.model, b.model);
  EXPECT_EQ(a.class_path, b.class_path);
  EXPECT_EQ(a.split, b.split);
  EXPECT_EQ(a.material, b.material);
  EXPECT_EQ(a.environment, b.environment);
  EXPECT_EQ(a.pixels, b.pixels);
  EXPECT_EQ(a.pixel_counts, b.pixel_counts);
  EXPECT_EQ(a.class_id, b.class_id);
  EXPECT_EQ(a.other_classes, b.other_classes);
  EXPECT_EQ(a.draws, b.draws);
  EXPECT_EQ(a.render_key, b.render_key);
  EXPECT_EQ(a.files_key, b.files_key);
  ASSERT_EQ(a.files.size(), b.files.size());
  for (std::size_t i = 0; i < a.files.size(); ++i) {
    EXPECT_EQ(a.files[i].path, b.files[i].path);
    EXPECT_EQ(a.files[i].kind, b.files[i].kind);
    EXPECT_EQ(a.files[i].xxh128, b.files[i].xxh128);
  }
}

/// Files with all that is known of them.
void expect_same_files(const std::string& line, const std::vector<FileRecord>& wanted) {
  const auto files = files_at_glance(line);
  ASSERT_TRUE(files);
  ASSERT_EQ(files->size(), wanted.size());
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    EXPECT_EQ((*files)[i].path, wanted[i].path);
    EXPECT_EQ((*files)[i].kind, wanted[i].kind);
    EXPECT_EQ((*files)[i].pixels, wanted[i].pixels);
    EXPECT_EQ((*files)[i].hashes.xxh128, wanted[i].hashes.xxh128);
    EXPECT_EQ((*files)[i].hashes.sha256, wanted[i].hashes.sha256);
    EXPECT_EQ((*files)[i].hashes.size_bytes, wanted[i].hashes.size_bytes);
  }
}

ImageRecord record(const std::string& model) {
  ImageRecord image;
  image.id = model + "/3";
  image.model = model;
  image.class_path = "vessel/mug";
  image.split = "test";
  image.material = "red";
  image.environment = "studio";
  image.view = "3";
  image.width = 300;
  image.height = 20;
  image.math = "strict";
  for (const char* kind : {"image", "mask"})
    image.files.push_back({"images/" + image.id + "." + kind,
                           kind,
                           {hash_text(model + kind), std::string(64, 'a'), 12},
                           hash_text("pixels")});
  image.render_key = hash_text("render" + model);
  image.files_key = hash_text("files" + model);
  for (Hash128& part : image.parts)
    part = hash_text("part");
  image.pixel_counts = {17, {}, 4000, 0};
  image.pixel_counts.left = image.pixel_counts.below = 2;
  image.class_id = 3;
  image.other_classes = {{"coarse", "thing},\"environment\":"}, {"kind", ""}};
  image.draws = {{"camera.target", {{0.5, 0.25, 1}}}, {"n", {{3}, true}}};
  image.pose.emplace();
  // Keys that the line has, too.
  ObjectRecord object;
  object.id = 101;
  object.model = "other.ply";
  object.material = "green";
  object.class_path = "vessel";
  object.pixels = ObjectCounts{101, 5, 6, 0, 1, 2, 3, 4};
  image.objects = {object};
  return image;
}

TEST(ManifestGlance, SeesWhatTheLineSays) {
  for (const char* model : {"mug.ply", "m[1].off", "a]}{[.off", "],:.off", "\u00e9 id.ply"}) {
    ImageRecord image = record(model);
    const std::string line = to_json_line(image);
    const auto glance = glance_at(line);
    ASSERT_TRUE(glance) << model;
    expect_same(*glance, glance_at(image));
    EXPECT_EQ(glance->draws, R"({"camera.target":[0.5,0.25,1.0],"n":3})");
    expect_same_files(line, image.files);
    ImageRecord drawn = image;
    drawn.other_classes.clear();
    const std::string classless = to_json_line(drawn);
    ASSERT_TRUE(glance_at(classless));
    expect_same(*glance_at(classless), glance_at(drawn));
    image.draws.clear();
    const std::string constant = to_json_line(image);
    ASSERT_TRUE(glance_at(constant));
    expect_same(*glance_at(constant), glance_at(image));
    image.files.clear();
    image.pixel_counts = {};
    image.class_path = image.split = "";
    image.class_id.reset();
    image.other_classes.clear();
    const std::string bare = to_json_line(image);
    ASSERT_TRUE(glance_at(bare));
    expect_same(*glance_at(bare), glance_at(image));
    expect_same_files(bare, {});
  }
}

TEST(ManifestGlance, LeavesToAReaderWhatIsEscapedOrNoSuchLine) {
  // Keys in a text are no keys.
  for (const char* model : {"a\"id\":\"b.off", "\"],\"files_key\":\"x", "tab\t.off"}) {
    ImageRecord image = record(model);
    EXPECT_FALSE(glance_at(to_json_line(image))) << model;
    image = record("mug.ply");
    image.class_path = model;
    EXPECT_FALSE(glance_at(to_json_line(image))) << model;
  }
  const std::string line = to_json_line(record("mug.ply"));
  EXPECT_FALSE(glance_at(""));
  EXPECT_FALSE(glance_at("{}"));
  EXPECT_FALSE(files_at_glance("{}"));
  for (const char* key :
       {"\"path\"", "\"sha256\":\"a", "\"size_bytes\"", "pixels_xxh128", ",\"id\""}) {
    std::string wrong = line;
    EXPECT_TRUE(files_at_glance(wrong));
    EXPECT_FALSE(files_at_glance(wrong.erase(wrong.find(key), std::string_view(key).size())))
        << key;
  }
  for (std::size_t size = 0; size + 9 < line.size(); ++size)
    EXPECT_FALSE(glance_at(std::string_view(line).substr(0, size))) << size;
}

std::vector<std::string> ids_in(const std::filesystem::path& folder, const std::string& text) {
  write_file_atomic(folder / "manifest/images.jsonl", text);
  std::vector<std::string> ids;
  visit_glances(folder, [&](const LineGlance& line) { ids.emplace_back(line.id); });
  return ids;
}

TEST(ManifestGlance, GoesThroughAFile) {
  const TemporaryFolder folder;
  EXPECT_THROW(visit_glances(folder.path(), [](const LineGlance&) {}), Error);
  const std::string plain = to_json_line(record("mug.ply")) + "\n";
  ImageRecord image = record("a\"b.ply");
  image.intrinsics = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  const std::string escaped = to_json_line(image) + "\n";
  EXPECT_TRUE(ids_in(folder.path(), "").empty());
  EXPECT_EQ(ids_in(folder.path(), plain + escaped),
            (std::vector<std::string>{"mug.ply/3", "a\"b.ply/3"}));
  for (const std::string& wrong :
       {plain + "{}\n" + plain, plain + plain.substr(0, plain.size() - 1)})
    EXPECT_THROW(ids_in(folder.path(), wrong), Error) << wrong;
}

}  // namespace
}  // namespace ds
