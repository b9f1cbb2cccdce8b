// SPDX-License-Identifier: Apache-2.0
#include "tracer/scene/mesh_formats.h"

#include "tests/tracer/scene/mesh_samples.h"

#include <set>

namespace ds {
namespace {

TEST(MeshFormats, HaveNamesAndEndingsOfTheirOwn) {
  std::set<std::string_view> names, endings;
  for (const MeshFormat* format : mesh_formats()) {
    EXPECT_TRUE(names.insert(format->name).second) << format->name;
    EXPECT_FALSE(format->holds.empty()) << format->name;
  }
  for (const std::string_view ending : mesh_endings()) {
    EXPECT_TRUE(endings.insert(ending).second) << ending;
    EXPECT_TRUE(ending.size() > 1 && ending[0] == '.') << ending;
    EXPECT_TRUE(has_mesh_ending("folder.d/a b" + std::string(ending))) << ending;
  }
  EXPECT_GE(endings.size(), names.size());
}

TEST(MeshFormats, EndingsAreInAnyCaseAndNothingElse) {
  for (const char* name : {"a.ply", "b.PLY", "c.Off", "d.tar.off"})
    EXPECT_TRUE(has_mesh_ending(name)) << name;
  for (const char* name : {"ply", ".ply", "a.plyx", "a.pl", "a.ply.gz", "a", "a.", "off/a"})
    EXPECT_FALSE(has_mesh_ending(name)) << name;
}

TEST(MeshFormats, AreNamedInMessagesHelpAndReference) {
  EXPECT_THAT(mesh_format_names(), testing::MatchesRegex("PLY.* or [A-Z]+"));
  EXPECT_THAT(mesh_endings_text(" and "), testing::MatchesRegex("\\.ply.* and \\.[a-z]+"));
  for (const MeshFormat* format : mesh_formats())
    EXPECT_THAT(mesh_format_reference(),
                testing::HasSubstr(fmt::format("\n| {} | `.", format->name)));
}

/// What is of one kind must not be taken for another's, whatever the order of the list.
TEST(MeshFormats, KnowTheirOwnFilesOnly) {
  const auto matching = [](std::string_view bytes, const std::string& file) {
    std::vector<std::string_view> names;
    for (const MeshFormat* format : mesh_formats())
      if (format->matches(bytes, file)) names.push_back(format->name);
    return names;
  };
  using Names = std::vector<std::string_view>;
  EXPECT_EQ(matching(samples::k_tetra_off, "m"), Names{"OFF"});
  EXPECT_EQ(matching(samples::k_tetra_ply, "m"), Names{"PLY"});
  EXPECT_EQ(matching("", "m"), Names{});
  EXPECT_EQ(matching("GIF89a", "m.gif"), Names{});
}

}  // namespace
}  // namespace ds
