// SPDX-License-Identifier: Apache-2.0
// The bits of strict pictures as they were when golden_bits.txt was last written. A change that is
// meant to move pixels writes it anew by `ci/bits --update` and says why in its commit; one that is
// not meant to has broken something.
#include "tests/render/bits.h"
#include "tracer/base/files.h"

#include <gtest/gtest.h>

#include <sstream>

namespace ds {
namespace {

std::map<std::string, std::string> golden_table() {
  std::istringstream lines(read_text_file(DS_SOURCE_DIR "/tests/render/golden_bits.txt"));
  std::map<std::string, std::string> table;
  for (std::string line; std::getline(lines, line);)
    table[line.substr(0, line.rfind(' '))] = line.substr(line.rfind(' ') + 1);
  return table;
}

TEST(GoldenBits, PicturesAreThoseOfTheTable) {
  const std::map<std::string, std::string> golden = golden_table();
  const std::map<std::string, std::string> now = pictures::bits_of({});
  // A program or a scene's text may change and move no pixel: their rows are for what follows.
  const auto pixels = [](std::map<std::string, std::string> table) {
    std::erase_if(table, [](const auto& row) {
      return row.first.ends_with(" program") || row.first.ends_with(" scene");
    });
    return table;
  };
  EXPECT_EQ(pixels(now), pixels(golden)) << "the table now; ci/bits --update writes it:\n"
                                         << pictures::to_text(now);
  // What moved a picture must be in its key: the scene, which shows every material of the lists, the
  // program's text or the host's version.
  if (golden.at("host_version") != now.at("host_version")) return;
  for (const auto& [key, value] : now) {
    const std::string name = key.substr(0, key.find(' '));
    const bool film = key.ends_with(" film");
    if (!film && !key.ends_with(" geometry")) continue;
    if (!golden.contains(key) || golden.at(key) == value) continue;
    const std::string scene = name + " scene";
    if (golden.at(scene) != now.at(scene)) continue;
    const std::string program = (film ? name : "geometry") + " program";
    EXPECT_NE(golden.at(program), now.at(program))
        << key << ": host code moved pixels: raise k_host_render_version";
  }
}

}  // namespace
}  // namespace ds
