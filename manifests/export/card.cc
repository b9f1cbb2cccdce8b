// SPDX-License-Identifier: Apache-2.0
#include "manifests/export/card.h"

#include "manifests/json_text.h"
#include "tracer/base/error.h"

#include <algorithm>
#include <map>
#include <set>

namespace ds {
namespace {

std::string in_lower_case(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  return text;
}

std::string size_category(std::uint64_t images) {
  return images < 1000        ? "n<1K"
         : images < 10'000    ? "1K<n<10K"
         : images < 100'000   ? "10K<n<100K"
         : images < 1'000'000 ? "100K<n<1M"
                              : "1M<n<10M";
}

/// Every licence by its SPDX id; "" for a text that is none of SPDX's.
std::set<std::string> spdx_ids(const DatasetRecord& dataset) {
  std::set<std::string> ids;
  for (const LicenceRecord& licence : dataset.licences)
    ids.insert(licence.spdx);
  return ids;
}

/// As YAML, which JSON's strings are.
std::string quoted(const std::string& text) {
  return canonical_json(text);
}

std::string front_matter(const ExportInput& input) {
  const DatasetRecord& dataset = input.dataset;
  const std::set<std::string> ids = spdx_ids(dataset);
  std::uint64_t images = 0;
  for (const auto& [split, count] : input.splits)
    images += count;
  std::string text = "---\n";
  const bool one = ids.size() == 1 && !ids.begin()->empty() &&
                   (dataset.licence.empty() || dataset.licence == *ids.begin());
  if (one)
    text += fmt::format("license: {}\n", in_lower_case(*ids.begin()));
  else
    text += fmt::format("license: other\nlicense_name: {}\nlicense_link: LICENSES\n",
                        quoted(dataset.licence.empty() ? "see LICENSES" : dataset.licence));
  text += fmt::format("pretty_name: {}\n", quoted(dataset.name));
  text += "task_categories:\n- image-classification\n";
  if (input.has("mask")) text += "- image-segmentation\n- object-detection\n";
  text += fmt::format(
      "tags:\n- synthetic\nsize_categories:\n- {}\nannotations_creators:\n- machine-generated\n"
      "source_datasets:\n- original\n",
      size_category(images));
  return text + "---\n";
}

/// "LICENSES/MIT.txt"; "LICENSES/MIT-2.txt" of another text under the same id, as with another name in
/// it, and "LICENSES/licence.txt" of one that has none.
std::vector<std::string> licence_files(const std::vector<LicenceRecord>& licences) {
  std::map<std::string, int> seen;
  std::vector<std::string> files;
  for (const LicenceRecord& licence : licences) {
    std::string name = licence.spdx.empty() ? "licence" : licence.spdx;
    std::replace_if(
        name.begin(), name.end(), [](char c) { return c == '/' || c == ' '; }, '_');
    const int number = ++seen[name];
    files.push_back(number == 1 ? fmt::format("LICENSES/{}.txt", name)
                                : fmt::format("LICENSES/{}-{}.txt", name, number));
  }
  return files;
}

std::string body(const ExportInput& input, const ExporterType& type, const ExportFolder& to) {
  const DatasetRecord& dataset = input.dataset;
  std::string text =
      fmt::format("# {}\n\nPictures path-traced from 3D models by dsbuild, as {}.\n\n",
                  dataset.name, type.help);
  text += "| split | images |\n| --- | --- |\n";
  for (const auto& [split, count] : input.splits)
    text += fmt::format("| {} | {} |\n", split, count);
  text += fmt::format("\n{} classes; a label is the place in this list, from 0: {}\n\n",
                      input.classes.size(), fmt::join(input.classes, ", "));
  text +=
      "Every picture, mask and label is computed, none was drawn or looked at by a person. Masks "
      "show "
      "what is seen of the model; what stands before it is cut out. World: right-handed, z up, "
      "metres. "
      "Cameras: x right, y down, z forward; pixel centres at .5. They are synthetic pictures: "
      "whatever a real camera adds is missing.\n";
  for (const std::string& note : to.notes())
    text += fmt::format("\nNote: {}\n", note);
  text += "\n## Licences\n\n";
  if (!dataset.licence.empty()) text += fmt::format("The dataset: {}\n\n", dataset.licence);
  if (dataset.licences.empty()) text += "No licence stands beside any of its models and scenes.\n";
  const std::vector<std::string> files = licence_files(dataset.licences);
  for (std::size_t i = 0; i < files.size(); ++i) {
    const LicenceRecord& licence = dataset.licences[i];
    text += fmt::format("- [{}]({}): {}\n", licence.spdx.empty() ? "no SPDX id" : licence.spdx,
                        files[i], fmt::join(licence.assets, ", "));
  }
  text += fmt::format(
      "\n## How it was made\n\nBy dsbuild {}, seed {}, from this recipe (`dsbuild build` makes the "
      "same "
      "bytes again):\n\n```\n{}\n```\n\n`dsbuild verify FOLDER` compares this folder with its "
      "checksums.\n",
      dataset.dsbuild_version, dataset.seed, dataset.recipe_text);
  return text;
}

}  // namespace

void write_card(const ExportInput& input, const ExporterType& type, ExportFolder& to) {
  const std::vector<std::string> files = licence_files(input.dataset.licences);
  for (std::size_t i = 0; i < files.size(); ++i)
    to.write(files[i], input.dataset.licences[i].text);
  to.write("README.md", front_matter(input) + "\n" + body(input, type, to));
}

}  // namespace ds
