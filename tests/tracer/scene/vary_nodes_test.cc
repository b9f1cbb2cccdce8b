// SPDX-License-Identifier: Apache-2.0
// What values in place of a scene file's give: what a file with these values gives when it is read.
#include "tracer/scene/vary_nodes.h"

#include "tests/tracer/scene/sdl_files_for_tests.h"
#include "tracer/base/error.h"
#include "tracer/base/files.h"
#include "tracer/base/name_pattern.h"
#include "tracer/scene/sdl.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <string>
#include <vector>

namespace ds {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view k_lamp_material =
    "scene.materials.lamp.type = matte\n"
    "scene.materials.lamp.emission = 1 0.8 0.6\n"
    "scene.materials.lamp.emission.power = 20\n"
    "scene.materials.lamp.emission.efficiency = 17\n"
    "scene.materials.body.type = glossy2\n"
    "scene.materials.body.kd = tint\n"
    "scene.materials.spare.type = matte\n";
constexpr std::string_view k_tint =
    "scene.textures.tint.type = scale\n"
    "scene.textures.tint.texture1 = 0.5\n"
    "scene.textures.tint.texture2 = 0.2 0.4 0.6\n";
constexpr std::string_view k_lamp =
    "scene.objects.lamp.vertices = 0 0 3  1 0 3  0 1 3\n"
    "scene.objects.lamp.faces = 0 1 2\n"
    "scene.objects.lamp.material = lamp\n"
    "scene.lights.sun.type = sun\n"
    "scene.lights.sun.dir = 1 0 1\n"
    "scene.lights.spot.type = spot\n"
    "scene.lights.spot.gain = 2 2 2\n";

std::string lamp_scene() {
  return fmt::format("{}{}{}{}", k_tint, k_lamp_material, ds::testing::k_square, k_lamp);
}

/// Something that the property takes, and what the file has it is not.
Vec3d other_value(const NodeProperty& property) {
  const double least = std::max(property.range.least, -4.0),
               most = std::min(property.range.most, 9.0);
  const double a = least + (most - least) * 0.625, b = least + (most - least) * 0.75;
  return property.width == 1 ? Vec3d{a, a, a} : Vec3d{a, b, a};
}

/// A copy of an environment that can be edited.
class Copy {
 public:
  explicit Copy(const fs::path& folder) {
    fs::copy(folder, path(), fs::copy_options::recursive);
    text_ = read_text_file(path() / "environment.scn");
  }
  fs::path path() const { return folder_.path() / "copy"; }
  /// As read with one more line, which replaces what an earlier one says.
  Scene with_line(const NodeValue& value) const {
    const std::string numbers =
        value.width == 1 ? fmt::format("{}", value.value.x)
                         : fmt::format("{} {} {}", value.value.x, value.value.y, value.value.z);
    write_file_atomic(path() / "environment.scn",
                      fmt::format("{}\nscene.{} = {}\n", text_, value.property, numbers));
    return read_environment(path());
  }

 private:
  TemporaryFolder folder_;
  std::string text_;
};

/// How many properties whose names fit were compared.
int compare_with_edited_files(const fs::path& folder, std::string_view pattern = "*") {
  const Copy copy(folder);
  EnvironmentSource source;
  const Scene before = read_environment(copy.path(), &source);
  int compared = 0;
  for (const NodeProperty& property : node_properties(source.nodes, copy.path())) {
    if (property.width == 0 || !fits_pattern(property.full_name, pattern)) continue;
    if (property.name == "emission.efficency") continue;  // a file has one of the two spellings
    const NodeValue value{property.full_name, other_value(property), property.width};
    Scene edited;
    try {
      edited = copy.with_line(value);
    } catch (const Error&) {  // such a file is none, and such values have no scene either
      EXPECT_THROW(with_node_values(before, source.nodes, copy.path(), {{value}}), Error)
          << property.full_name;
      continue;
    }
    const Scene after = with_node_values(before, source.nodes, copy.path(), {{value}});
    EXPECT_EQ(canonical_environment(after), canonical_environment(edited)) << property.full_name;
    EXPECT_NE(property.value, value.value) << property.full_name;
    ++compared;
  }
  return compared;
}

TEST(WithNodeValues, IsTheSceneOfAFileThatHasThem) {
  const fs::path environments = DS_SOURCE_DIR "/assets/environments";
  for (const char* name : {"office", "studio"})
    EXPECT_GE(compare_with_edited_files(environments / name), 15) << name;
  // Each time it is read a sky is made.
  EXPECT_GE(compare_with_edited_files(environments / "outdoor", "*s*.d*r*"), 2);
  const ds::testing::SdlFolder folder;
  folder.write("environment.scn", lamp_scene());
  EXPECT_GT(compare_with_edited_files(folder.path()), 20);
}

TEST(WithNodeValues, OfSeveralValuesEachIsThere) {
  const ds::testing::SdlFolder folder;
  folder.write("environment.scn", lamp_scene());
  EnvironmentSource source;
  const Scene before = read_environment(folder.path(), &source);
  const std::array values = {NodeValue{"materials.body.kd", {0.25, 0.5, 0.75}, 3},
                             NodeValue{"materials.lamp.emission.power", {40, 40, 40}, 1},
                             NodeValue{"lights.spot.position", {1, 2, 3}, 3}};
  const Scene after = with_node_values(before, source.nodes, folder.path(), values);
  const auto emission = [](const Scene& scene) {
    for (const Material& material : scene.materials)
      if (material.name == "lamp@lamp") return material.emission.constant;
    return Vec3{};
  };
  EXPECT_EQ(emission(after), (emission(before) * 2.0F));
  EXPECT_TRUE(after.textures.empty());
  std::string text = lamp_scene();
  text +=
      "scene.materials.body.kd = 0.25 0.5 0.75\n"
      "scene.materials.lamp.emission.power = 40\n"
      "scene.lights.spot.position = 1 2 3\n";
  folder.write("environment.scn", text);
  EXPECT_EQ(canonical_environment(after), canonical_environment(read_environment(folder.path())));
}

// What does not change is not read again: without its mesh files an environment still has other values.
TEST(WithNodeValues, ReadsNoMeshAgain) {
  const Copy copy(DS_SOURCE_DIR "/assets/environments/studio");
  EnvironmentSource source;
  const Scene before = read_environment(copy.path(), &source);
  for (const auto& entry : fs::directory_iterator(copy.path()))
    fs::remove(entry.path());
  const Scene after = with_node_values(before, source.nodes, copy.path(),
                                       {{NodeValue{"materials.backdrop.kd", {0.1, 0.2, 0.3}, 3}}});
  ASSERT_EQ(after.objects.size(), before.objects.size());
  for (std::size_t i = 0; i < after.objects.size(); ++i)
    EXPECT_EQ(after.objects[i].mesh.positions, before.objects[i].mesh.positions);
  EXPECT_NE(canonical_environment(after), canonical_environment(before));
}

TEST(WithNodeValues, SaysWhatDoesNotGoTogether) {
  const ds::testing::SdlFolder folder;
  folder.write("environment.scn", lamp_scene());
  EnvironmentSource source;
  const Scene before = read_environment(folder.path(), &source);
  const auto message = [&](const NodeValue& value) -> std::string {
    try {
      with_node_values(before, source.nodes, folder.path(), {{value}});
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(
      message({"lights.sun.dir", {0, 1, -1}, 3}),
      ::testing::AllOf(::testing::HasSubstr("environment.scn:"),
                       ::testing::HasSubstr("lights.sun.dir: wanted a sun above the horizon")));
  EXPECT_THAT(message({"materials.lamp.emission", {}, 3}), "");  // dark
  EXPECT_THAT(message({"lights.spot.coneangle", {2, 2, 2}, 1}),
              ::testing::HasSubstr("wanted conedeltaangle in [0, coneangle], found 5 and 2"));
}

TEST(NodeProperties, TellWhatMayBeDrawn) {
  const ds::testing::SdlFolder folder;
  folder.write("environment.scn", lamp_scene());
  EnvironmentSource source;
  read_environment(folder.path(), &source);
  const std::vector<NodeProperty> all = node_properties(source.nodes, folder.path());
  const auto find = [&](std::string_view name) -> const NodeProperty* {
    const auto at = std::find_if(all.begin(), all.end(),
                                 [&](const NodeProperty& one) { return one.full_name == name; });
    return at == all.end() ? nullptr : &*at;
  };
  for (const char* name :
       {"lights.spot.gain", "lights.spot.coneangle", "lights.sun.dir", "materials.body.kd",
        "textures.tint.texture1", "materials.lamp.emission.power", "materials.lamp.id",
        "lights.spot.normalizebycolor"})
    ASSERT_NE(find(name), nullptr) << name;
  EXPECT_EQ(find("lights.spot.gain")->value, (Vec3d{2, 2, 2}));
  EXPECT_TRUE(find("lights.spot.gain")->colour);
  EXPECT_EQ(find("lights.spot.coneangle")->value, (Vec3d{30, 30, 30}));  // by default
  EXPECT_FALSE(find("lights.sun.dir")->colour);
  EXPECT_EQ(find("lights.sun.dir")->width, 3);
  EXPECT_EQ(find("materials.body.kd")->value, std::nullopt);  // a texture
  EXPECT_EQ(find("materials.body.kd")->range.text(), "in [0, 1]");
  EXPECT_EQ(find("textures.tint.texture1")->value, (Vec3d{0.5, 0.5, 0.5}));
  EXPECT_EQ(find("materials.lamp.emission.power")->value, (Vec3d{20, 20, 20}));
  EXPECT_EQ(find("materials.lamp.id")->width, 0);
  EXPECT_EQ(find("lights.spot.normalizebycolor")->width, 0);
  EXPECT_EQ(find("materials.spare.kd"), nullptr);  // nothing shows it
}

}  // namespace
}  // namespace ds
