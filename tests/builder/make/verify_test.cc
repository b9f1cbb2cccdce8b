// SPDX-License-Identifier: Apache-2.0
#include "builder/make/verify.h"

#include "tests/builder/tiny_dataset.h"
#include "tracer/render/develop.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace ds {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::Pair;
using testing::UnorderedElementsAre;

class VerifyTest : public TinyDataset {
 protected:
  using Findings = std::vector<std::pair<std::string, std::string>>;
  static Findings short_form(const VerifyResult& result) {
    Findings findings;
    for (const Finding& finding : result.findings)
      findings.emplace_back(to_string(finding.kind), finding.path);
    return findings;
  }
  Findings verify() { return short_form(verify_files(output())); }
  Findings verify_with_recipe() {
    VerifyResult result;
    Dataset dataset = open_dataset(request, Access::look, real_disk);
    Inputs inputs(*dataset.database);
    verify_against_plan(result, dataset, make_plan(dataset, inputs, false));
    return short_form(result);
  }
  VerifyResult rerender(std::uint64_t count, std::uint64_t seed) {
    VerifyResult result;
    Dataset dataset = open_dataset(request, Access::look, real_disk);
    Inputs inputs(*dataset.database);
    FakeRenderer renderer(calls);
    calls.traced.clear();
    verify_by_tracing(
        result, dataset, make_plan(dataset, inputs, false), inputs, renderer, count, seed,
        [](const std::string&) {}, stop);
    return result;
  }
};

TEST_F(VerifyTest, FindsNothingAfterABuild) {
  build();
  EXPECT_THAT(verify(), IsEmpty());
  EXPECT_THAT(verify_with_recipe(), IsEmpty());
}

TEST_F(VerifyTest, TellsMissingExtraAndChanged) {
  build();
  fs::remove(output() / "images/box.off/0.png");
  fs::copy(output() / "images/box.off/1.png", output() / "images/box.off/9.png");
  fs::remove(output() / "images/tetra.ply/0.png");
  fs::copy(output() / "images/box.off/1.png", output() / "images/tetra.ply/0.png");
  fs::remove(output() / "images/tetra.ply/1.png");
  write_file_atomic(output() / "images/tetra.ply/1.png", std::string_view("no picture"));
  EXPECT_THAT(verify(), UnorderedElementsAre(Pair("missing", "images/box.off/0.png"),
                                             Pair("extra", "images/box.off/9.png"),
                                             Pair("changed", "images/tetra.ply/0.png"),
                                             Pair("changed", "images/tetra.ply/1.png")));
}

TEST_F(VerifyTest, TellsOtherBytesOfTheSamePixels) {
  build();
  const fs::path file = output() / "images/box.off/0.png";
  // A byte after a PNG's last chunk is no part of the picture.
  const std::string bytes = read_text_file(file) + "x";
  fs::remove(file);
  write_file_atomic(file, bytes);
  EXPECT_THAT(verify(), ElementsAre(Pair("encoding", "images/box.off/0.png")));
}

TEST_F(VerifyTest, SeesAManifestThatContradictsItself) {
  build();
  const fs::path sums = output() / "manifest/checksums.xxh128";
  std::string text = read_text_file(sums);
  text[0] = text[0] == '0' ? '1' : '0';
  write_file_atomic(sums, text);
  EXPECT_THAT(verify(), ElementsAre(Pair("manifest", testing::_)));
  fs::remove(sums);
  EXPECT_THAT(verify(), ElementsAre(Pair("missing", "manifest/checksums.xxh128")));
}

/// What its checksum bears out is looked at, and what it does not is read whole: both find the same.
TEST_F(VerifyTest, FindsTheSameWhateverItKnowsOfTheManifest) {
  build();
  const fs::path sums = output() / "manifest/checksums.xxh128";
  const std::string text = read_text_file(sums);
  std::string other = text;
  const std::size_t at = other.find("  manifest/images.jsonl") - 1;
  other[at] = other[at] == '0' ? '1' : '0';
  write_file_atomic(output() / "images/box.off/0.png", std::string_view("no picture"));
  fs::remove(output() / "images/box.off/1.png");
  const VerifyResult known = verify_files(output());
  EXPECT_EQ(known.images, k_images);
  EXPECT_EQ(known.files, 2 * k_images);
  write_file_atomic(sums, other);
  const VerifyResult read = verify_files(output());
  EXPECT_EQ(read.images, known.images);
  EXPECT_EQ(read.files, known.files);
  Findings wanted = short_form(known);
  wanted.emplace_back("manifest", "manifest/images.jsonl");
  EXPECT_EQ(short_form(read), wanted);
  // A line that is none is told with its number.
  const fs::path images = output() / "manifest/images.jsonl";
  std::string lines = read_text_file(images);
  const std::size_t spp = lines.find("\"spp\":", lines.find('\n'));
  write_file_atomic(images, lines.replace(spp, 6, "\"spp\":x"));
  const VerifyResult damaged = verify_files(output());
  EXPECT_FALSE(damaged.has_manifest);
  EXPECT_THAT(damaged.findings.at(0).what, testing::HasSubstr("images.jsonl:2: "));
}

TEST_F(VerifyTest, ComparesWithTheRecipe) {
  build();
  edit("materials/red.mat", "kd = 0.7 0.1 0.1", "kd = 0.6 0.1 0.1");
  fs::copy(recipe_folder() / "models/box.off", recipe_folder() / "models/new.off");
  const Findings findings = verify_with_recipe();
  std::map<std::string, int> kinds;
  for (const auto& [kind, path] : findings)
    ++kinds[kind];
  EXPECT_EQ(kinds, (std::map<std::string, int>{{"missing", 4}, {"manifest", 4}}));
}

TEST_F(VerifyTest, TracesTheSameChosenImagesAgain) {
  build();
  EXPECT_THAT(rerender(3, 1).findings, IsEmpty());
  const auto first = calls.traced;
  EXPECT_EQ(first.size(), 3U);
  rerender(3, 1);
  EXPECT_EQ(calls.traced, first);
  rerender(3, 2);
  EXPECT_NE(calls.traced, first);
  EXPECT_EQ(rerender(100, 1).rerendered, k_images);
}

TEST_F(VerifyTest, SeesATraceThatGivesOtherPixels) {
  build();
  // The fake draws from the file's bytes, so a comment changes its pixels though not the keys: a
  // tracer gone wrong.
  edit("materials/red.mat", "# A matte red.", "# Another comment.");
  const VerifyResult result = rerender(k_images, 0);
  EXPECT_EQ(result.findings.size(), k_images / 2);
  for (const Finding& finding : result.findings)
    EXPECT_THAT(finding.what, testing::HasSubstr("the pixels differ"));
}

}  // namespace
}  // namespace ds
