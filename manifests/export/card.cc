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

/// As YAML, which JSON's strings are.
std::string quoted(const std::string& text) {
  return canonical_json(text);
}

/// The hub's id only of what the recipe says of the whole dataset: licences beside some of its assets are
/// no licence of its pictures.
std::string licence_lines(const DatasetRecord& dataset) {
  std::string text;
  const bool is_id = !dataset.licence.empty() && dataset.licence.find(' ') == dataset.licence.npos;
  if (is_id)
    text = fmt::format("license: {}\n", in_lower_case(dataset.licence));
  else
    text = fmt::format("license: other\nlicense_name: {}\n",
                       quoted(dataset.licence.empty() ? "not stated" : dataset.licence));
  if (!is_id && !dataset.licences.empty()) text += "license_link: LICENSES\n";
  return text;
}

std::string front_matter(const ExportInput& input, const std::string& lines) {
  std::uint64_t images = 0;
  for (const auto& [split, count] : input.splits)
    images += count;
  std::string text = "---\n" + licence_lines(input.dataset);
  text += fmt::format("pretty_name: {}\n", quoted(input.dataset.name));
  text += "task_categories:\n- image-classification\n";
  if (input.has("mask")) text += "- image-segmentation\n- object-detection\n";
  text += fmt::format(
      "tags:\n- synthetic\nsize_categories:\n- {}\nannotations_creators:\n- machine-generated\n"
      "source_datasets:\n- original\n",
      size_category(images));
  return text + lines + "---\n";
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

/// Images by class and split; "" is what no class file lists.
std::string counts_text(const ExportInput& input) {
  std::string text = "| class | label |", rule = "\n| --- | --- |";
  for (const auto& [split, count] : input.splits) {
    text += fmt::format(" {} |", split.empty() ? "no split" : split);
    rule += " --- |";
  }
  text += rule + "\n";
  for (const auto& [path, by_split] : input.counts) {
    const auto at = std::find(input.classes.begin(), input.classes.end(), path);
    const bool known = at != input.classes.end();
    text += fmt::format("| {} | {} |", path.empty() ? "none" : path,
                        known ? std::to_string(at - input.classes.begin()) : "");
    for (const auto& [split, count] : input.splits) {
      const auto found = by_split.find(split);
      text += fmt::format(" {} |", found == by_split.end() ? 0 : found->second);
    }
    text += "\n";
  }
  return text;
}

/// What of the dataset is not here, and what else its readers must know.
std::string notes_text(const ExportInput& input, const ExportFolder& to) {
  std::string text;
  if (!input.filters.empty())
    text += fmt::format("- A part of the dataset: {}.\n", fmt::join(input.filters, ", "));
  for (const auto& [why, count] : input.left_out)
    text += fmt::format("- {} images are left out: {}.\n", count,
                        why == "unclassified" ? "they have no class or split"
                        : why == "split"      ? "they are of another split"
                                              : "the filter");
  for (const std::string& note : to.notes())
    text += fmt::format("- {}\n", note);
  return text.empty() ? "" : "\n## Notes\n\n" + text;
}

/// What the recipe says of the dataset as a whole.
std::string about_text(const DatasetRecord& dataset) {
  const auto said = [&](const char* name) {
    const auto at = dataset.about.find(name);
    return at == dataset.about.end() ? std::string() : at->second;
  };
  std::string text = said("description");
  if (!text.empty()) text += "\n\n";
  std::string line;
  for (const auto& [name, label] : {std::pair("creator", "by"), std::pair("version", "version"),
                                    std::pair("published", "published"), std::pair("url", "at")})
    if (const std::string value = said(name); !value.empty())
      line += fmt::format("{}{} {}", line.empty() ? "" : ", ", label, value);
  if (!line.empty()) text += line + ".\n\n";
  return text;
}

std::string planes_text(const ExportInput& input, const ExporterType& type) {
  std::string text;
  for (const auto& [name, plane] : input.dataset.planes) {
    const bool taken = type.takes.empty() ||
                       std::find(type.takes.begin(), type.takes.end(), name) != type.takes.end();
    if (taken && input.has(name))
      text += fmt::format("- `{}` ({}): {}\n", name, plane.encoding, plane.convention);
  }
  return text.empty() ? "" : "\nBeside each picture:\n" + text;
}

std::string licences_text(const ExportInput& input) {
  const DatasetRecord& dataset = input.dataset;
  std::string text = fmt::format("\n## Licences\n\nThe dataset: {}\n",
                                 dataset.licence.empty() ? "not stated" : dataset.licence);
  const std::vector<std::string> files = licence_files(dataset.licences);
  for (std::size_t i = 0; i < files.size(); ++i) {
    const LicenceRecord& licence = dataset.licences[i];
    text += fmt::format("- [{}]({}): {}\n", licence.spdx.empty() ? "no SPDX id" : licence.spdx,
                        files[i], fmt::join(licence.assets, ", "));
  }
  if (!input.unlicensed.empty())
    text += fmt::format("- no licence stands beside {}: {}\n",
                        input.unlicensed.size() == 1 ? "this" : "these",
                        fmt::join(input.unlicensed, ", "));
  return text;
}

/// Addresses and the first line of what stands beside assets: all of it is in the manifest.
std::string sources_text(const ExportInput& input) {
  const DatasetRecord& dataset = input.dataset;
  if (dataset.sources.empty()) return "";
  std::string text = "\n## Sources\n\n";
  for (const SourceRecord& source : dataset.sources) {
    std::string line = source.text.substr(0, source.text.find_first_of("\r\n"));
    if (!source.url.empty() && line.find(source.url) == line.npos) line += " " + source.url;
    text += fmt::format("- {}: {}\n", fmt::join(source.assets, ", "), line);
  }
  if (!input.unsourced.empty())
    text += fmt::format("- no source stands beside {}: {}\n",
                        input.unsourced.size() == 1 ? "this" : "these",
                        fmt::join(input.unsourced, ", "));
  return text;
}

/// Of formats whose numbers are those of the manifest.
std::string manifest_conventions(const ExportInput& input) {
  return std::string(input.has("mask") ? "A bbox is [x, y, width, height] of that in whole pixels. "
                                       : "") +
         "World: right-handed, z up, metres. Cameras: x right, y down, z forward; pixel centres at "
         ".5.";
}

std::string body(const ExportInput& input, const ExporterType& type, const ExportFolder& to) {
  const DatasetRecord& dataset = input.dataset;
  std::string text =
      fmt::format("# {}\n\n{}Pictures of 3D models, path-traced by dsbuild, {} pixels, as {}.\n\n",
                  dataset.name, about_text(dataset), input.size, type.help);
  text += counts_text(input) + planes_text(input, type);
  text +=
      "\nEverything here is computed, nothing was drawn or looked at by a person, and whatever a "
      "real "
      "camera adds is missing. ";
  if (input.has("mask"))
    text += "Masks show what is seen of the model; what stands before it is cut out. ";
  text += (type.conventions != nullptr ? type.conventions : manifest_conventions(input)) + "\n";
  text += notes_text(input, to) + licences_text(input) + sources_text(input);
  if (const auto cite = dataset.about.find("cite"); cite != dataset.about.end())
    text += fmt::format("\n## How to cite\n\n```\n{}\n```\n", cite->second);
  text += fmt::format(
      "\n## How it was made\n\nBy dsbuild {}, seed {}. Every setting of its recipe follows, with "
      "files named but not where they lay: a record to compare with, no recipe that can be built. "
      "That recipe, its class files and assets make the same files again.\n\n```\n{}\n```\n\n"
      "`dsbuild verify FOLDER` compares this folder with its checksums.\n",
      dataset.dsbuild_version, dataset.seed, dataset.recipe_text);
  return text;
}

}  // namespace

void write_card(const ExportInput& input, const ExporterType& type, const std::string& lines,
                ExportFolder& to) {
  const std::vector<std::string> files = licence_files(input.dataset.licences);
  for (std::size_t i = 0; i < files.size(); ++i)
    to.write(files[i], input.dataset.licences[i].text);
  to.write("README.md", front_matter(input, lines) + "\n" + body(input, type, to));
}

}  // namespace ds
