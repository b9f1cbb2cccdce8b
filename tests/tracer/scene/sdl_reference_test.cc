// SPDX-License-Identifier: Apache-2.0
// The table of SDL names is what the reader reads and what assets/SDL.md holds.
#include "tests/reference_page.h"
#include "tests/tracer/scene/sdl_files_for_tests.h"
#include "tracer/scene/sdl_parameters.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace ds {
namespace {

using ::ds::testing::SdlFolder;

/// What the reader finds in a thing of the type whose properties are so.
std::string findings(const SdlSection& section, const SdlTypeRow& row,
                     const std::vector<std::pair<std::string, std::string>>& properties) {
  const std::string node =
      fmt::format("{}.{}", section_of(section.kind), section.kind == SdlKind::film ? "0" : "it");
  std::string text;
  if (!row.name.empty()) text += fmt::format("{}.type = {}\n", node, row.name);
  for (const auto& [name, value] : properties)
    text += fmt::format("{}.{} = {}\n", node, name, value);
  const SdlFolder folder;
  if (section.kind != SdlKind::film) return folder.environment_error(text);
  folder.write("environment.cfg", text);
  return folder.environment_error("");
}

template <typename Visit>
void for_each_type(const Visit& visit) {
  for (const SdlSection* section : sdl_sections())
    for (const SdlTypeRow& row : section->types) {
      std::vector<SdlParameter> all = row.parameters;
      all.insert(all.end(), section->common.begin(), section->common.end());
      visit(*section, row, all);
    }
}

TEST(SdlTable, NamesAreUnique) {
  for_each_type([](const SdlSection& section, const SdlTypeRow& row,
                   const std::vector<SdlParameter>& parameters) {
    std::set<std::string> names;
    for (const SdlParameter& p : parameters)
      EXPECT_TRUE(names.insert(p.name).second) << section.topic << " " << row.name << " " << p.name;
  });
}

TEST(SdlTable, EveryPropertyIsReadAndItsDefaultIsRight) {
  for_each_type([](const SdlSection& section, const SdlTypeRow& row,
                   const std::vector<SdlParameter>& parameters) {
    for (const SdlParameter& p : parameters) {
      std::vector<std::pair<std::string, std::string>> properties{
          {p.name, p.default_value.empty() ? "x" : p.default_value}};
      // Of a mesh in the file itself one property says nothing without the others.
      if (p.type == SdlType::list)
        for (const char* other : {"vertices", "faces", "normals", "uvs"})
          if (other != p.name) properties.emplace_back(other, "0 0 0 0 0 0");
      const std::string found = findings(section, row, properties);
      for (const char* not_read : {"unknown", "not supported", "no effect"})
        EXPECT_EQ(found.find(not_read), found.npos) << found;
      if (!p.default_value.empty()) {
        EXPECT_EQ(found.find("it." + p.name + ":"), found.npos) << found;
      }
    }
  });
}

TEST(SdlTable, RangesAreThoseOfTheReader) {
  for_each_type([](const SdlSection& section, const SdlTypeRow& row,
                   const std::vector<SdlParameter>& parameters) {
    for (const SdlParameter& p : parameters) {
      const std::size_t count = p.type == SdlType::color || p.type == SdlType::vector ? 3
                                : p.type == SdlType::pair                             ? 2
                                                                                      : 1;
      const auto is_refused = [&](double value) {
        std::string text;
        for (std::size_t i = 0; i < count; ++i)
          text += fmt::format("{} ", value);
        const std::string found = findings(section, row, {{p.name, text}});
        return found.find(p.name + ": wanted") != found.npos;
      };
      if (std::isfinite(p.range.least)) {
        EXPECT_TRUE(is_refused(p.range.least - 0.5)) << row.name << " " << p.name;
        EXPECT_EQ(is_refused(p.range.least), p.range.open_least) << row.name << " " << p.name;
      }
      if (std::isfinite(p.range.most)) {
        EXPECT_TRUE(is_refused(p.range.most * 1.01 + 0.5)) << row.name << " " << p.name;
      }
      if (p.type == SdlType::choice || p.type == SdlType::flag) {
        EXPECT_TRUE(is_refused(0.25)) << row.name << " " << p.name;
      }
    }
  });
}

TEST(SdlReference, IsWhatThePageHolds) {
  ds::testing::expect_page_holds("assets/SDL.md", sdl_reference());
}

}  // namespace
}  // namespace ds
