// SPDX-License-Identifier: Apache-2.0
// Which texts beside assets are their licences and sources.
#include "builder/plan/licence_files.h"

#include "tracer/base/files.h"

#include <gmock/gmock.h>

#include <set>

namespace ds {
namespace {

namespace fs = std::filesystem;

class LicenceFiles : public testing::Test {
 protected:
  void put(const std::string& file, std::string_view text) const {
    make_folders((folder_.path() / file).parent_path());
    write_file_atomic(folder_.path() / file, text);
  }
  /// Of a model there.
  std::set<std::string> licences(const std::string& model) const {
    std::set<std::string> texts;
    for (const auto& [asset, text] : licences_beside("models", {{model, folder_.path() / model}}))
      texts.insert(text);
    return texts;
  }

  TemporaryFolder folder_;
};

TEST_F(LicenceFiles, HaveUsualNamesInAnyCase) {
  for (const char* name :
       {"LICENSE.md", "Licence.txt", "copying", "UNLICENSE", "LICENSE-CC-BY-4.0"}) {
    put("a/b/c.off", "");
    put(std::string("a/b/") + name, "words");
    EXPECT_EQ(licences("a/b/c.off"), (std::set<std::string>{"words"})) << name;
    fs::remove_all(folder_.path() / "a");
  }
  put("a/license-plate.off", "OFF");
  put("a/license.pdf", "words");
  EXPECT_TRUE(licences("a/license-plate.off").empty());
}

TEST_F(LicenceFiles, OfTheNearestFolderAllCount) {
  put("LICENSE", "of all");
  put("a/b/c.off", "");
  EXPECT_TRUE(licences("a/b/c.off").empty()) << "two folders up";
  EXPECT_EQ(licences("a/c.off"), (std::set<std::string>{"of all"}));
  put("a/LICENSES/CC-BY-4.0.txt", "one");
  put("a/LICENSES/anything", "two");
  put("a/LICENSES/.hidden", "three");
  put("a/COPYING", "four");
  for (const char* model : {"a/c.off", "a/b/c.off"})
    EXPECT_EQ(licences(model), (std::set<std::string>{"one", "two", "four"})) << model;
  put("a/b/LICENSE", std::string(2U << 20U, 'x'));
  EXPECT_TRUE(licences("a/b/c.off").empty()) << "its own, which is no text, and not another's";
}

TEST_F(LicenceFiles, AreOfEachAssetInOneFolder) {
  put("a/LICENSE-MIT", "MIT");
  put("a/LICENSE-APACHE.txt", "Apache");
  put("a/SOURCES.md", "there");
  const NamedAssets assets{{"x.off", folder_.path() / "a/x.off"},
                           {"y.off", folder_.path() / "a/y.off"}};
  EXPECT_THAT(licences_beside("models", assets),
              testing::UnorderedElementsAre(
                  testing::Pair("models/x.off", "MIT"), testing::Pair("models/x.off", "Apache"),
                  testing::Pair("models/y.off", "MIT"), testing::Pair("models/y.off", "Apache")));
  EXPECT_THAT(sources_beside("models", assets),
              testing::ElementsAre(testing::Pair("models/x.off", "there"),
                                   testing::Pair("models/y.off", "there")));
}

}  // namespace
}  // namespace ds
