// SPDX-License-Identifier: Apache-2.0
// Croissant 1.1 (MLCommons): croissant.json, which tells readers such as mlcroissant what the Parquet files
// beside it hold, who made them, how, and under which licence.
#include "manifests/export/parquet_export.h"
#include "manifests/json_text.h"
#include "manifests/licences.h"

#include <fmt/format.h>

#include <utility>

namespace ds {
namespace {

using nlohmann::json;

constexpr const char* k_files = "parquet-files";

/// What the words of the file mean; of the specification, but for https:// where it has http://, which
/// readers take for another vocabulary.
json context() {
  json object{{"@language", "en"},
              {"@vocab", "https://schema.org/"},
              {"sc", "https://schema.org/"},
              {"cr", "http://mlcommons.org/croissant/"},
              {"rai", "http://mlcommons.org/croissant/RAI/"},
              {"dct", "http://purl.org/dc/terms/"},
              {"prov", "http://www.w3.org/ns/prov#"},
              {"conformsTo", "dct:conformsTo"},
              {"data", {{"@id", "cr:data"}, {"@type", "@json"}}},
              {"examples", {{"@id", "cr:examples"}, {"@type", "@json"}}},
              {"dataType", {{"@id", "cr:dataType"}, {"@type", "@vocab"}}}};
  for (const char* word :
       {"arrayShape", "citeAs",   "column",      "containedIn",   "equivalentProperty",
        "extract",    "field",    "fileObject",  "fileProperty",  "fileSet",
        "format",     "includes", "isArray",     "isLiveDataset", "jsonPath",
        "key",        "md5",      "parentField", "path",          "recordSet",
        "references", "regex",    "repeated",    "replace",       "samplingRate",
        "separator",  "source",   "subField",    "transform"})
    object[word] = std::string("cr:") + word;
  return object;
}

json text_of(const DatasetRecord& dataset, const char* name, const std::string& otherwise) {
  const auto at = dataset.about.find(name);
  return at == dataset.about.end() ? otherwise : at->second;
}

/// A column of the files as a field of the records.
json field_of(const ParquetFile::Column& column, const DatasetRecord& dataset) {
  json source{{"fileSet", {{"@id", k_files}}}, {"extract", {{"column", column.name}}}};
  json field{
      {"@type", "cr:Field"}, {"@id", std::string("images/") + column.name}, {"name", column.name}};
  switch (column.type) {
    case ParquetType::text:
      field["dataType"] = "sc:Text";
      break;
    case ParquetType::int64:
      field["dataType"] = "sc:Integer";
      break;
    case ParquetType::float64:
      field["dataType"] = "sc:Float";
      break;
    case ParquetType::image:
      field["dataType"] = "sc:ImageObject";
      source["transform"] = {{"jsonPath", "bytes"}};
      break;
    case ParquetType::int64_list:
      field["dataType"] = "sc:Integer";
      field["isArray"] = true;
      field["arrayShape"] = "4";
      break;
    case ParquetType::float64_list: {
      const auto at = dataset.draws.find(column.name.substr(column.name.find('.') + 1));
      field["dataType"] = "sc:Float";
      field["isArray"] = true;
      field["arrayShape"] = std::to_string(at->second.least.size());
      break;
    }
    case ParquetType::float64_matrix:
      field["dataType"] = "sc:Float";
      field["isArray"] = true;
      field["arrayShape"] = column.name == "intrinsics" ? "3,3"
                            : column.name == "box_m"    ? "2,3"
                                                        : "4,4";
      break;
  }
  field["source"] = std::move(source);
  return field;
}

/// Readers make a pattern of files of this for one split: they know no more than (a|b) and .* of it.
json split_field(const ExportInput& input) {
  std::vector<std::string> splits;
  for (const auto& [split, count] : input.splits)
    splits.push_back(split);
  const std::string regex = fmt::format(R"(data/({})-.*\.parquet$)", fmt::join(splits, "|"));
  return {{"@type", "cr:Field"},
          {"@id", "images/split"},
          {"name", "split"},
          {"dataType", "sc:Text"},
          {"source",
           {{"fileSet", {{"@id", k_files}}},
            {"extract", {{"fileProperty", "fullpath"}}},
            {"transform", {{"regex", regex}}}}},
          {"references", {{"field", {{"@id", "splits/name"}}}}}};
}

/// The splits, with what they are for.
json split_set(const ExportInput& input) {
  json rows = json::array();
  for (const auto& [split, count] : input.splits)
    rows.push_back({{"splits/name", split},
                    {"splits/url", split == "test"  ? "cr:TestSplit"
                                   : split == "val" ? "cr:ValidationSplit"
                                                    : "cr:TrainingSplit"}});
  const auto field = [](const char* name, const char* type) {
    return json{{"@type", "cr:Field"},
                {"@id", std::string("splits/") + name},
                {"name", name},
                {"dataType", type}};
  };
  return {{"@type", "cr:RecordSet"}, {"@id", "splits"},
          {"name", "splits"},        {"key", {{"@id", "splits/name"}}},
          {"dataType", "cr:Split"},  {"field", {field("name", "sc:Text"), field("url", "sc:URL")}},
          {"data", std::move(rows)}};
}

/// What the responsible use of data asks for (RAI), and where it came from (PROV).
void add_making(json& object, const ExportInput& input) {
  const DatasetRecord& dataset = input.dataset;
  const std::string maker = "dsbuild " + dataset.dsbuild_version;
  object["rai:dataCollection"] =
      "Pictures of 3D models in lit environments, path-traced; nothing was photographed.";
  object["rai:dataCollectionType"] = "Software Collection";
  object["rai:dataPreprocessingProtocol"] =
      "Models are turned, scaled and placed as the recipe says, and damaged faces of their files "
      "mended; README.md has the recipe.";
  object["rai:machineAnnotationTools"] = maker;
  object["rai:dataAnnotationProtocol"] =
      "Masks, boxes and poses are computed from the scene; classes are those of the recipe.";
  object["rai:dataBiases"] =
      "Models, materials, environments and views are those of the recipe, and no others.";
  object["rai:dataLimitations"] = "Synthetic: whatever a real camera and place add is missing.";
  object["rai:dataUseCases"] = "Training and testing of programs that look at pictures of objects.";
  object["rai:personalSensitiveInformation"] = "none";
  object["prov:wasGeneratedBy"] = {
      {"@type", "prov:Activity"},
      {"prov:label", maker + " with the recipe of xxh128 " + hash_text(dataset.recipe_text).hex()}};
}

/// What the pictures were made from.
void add_sources(json& object, const DatasetRecord& dataset) {
  for (const SourceRecord& source : dataset.sources) {
    json work{{"@type", "sc:CreativeWork"},
              {"name", fmt::format("{}", fmt::join(source.assets, ", "))},
              {"description", source.text}};
    if (!source.url.empty()) work["url"] = source.url;
    object["isBasedOn"].push_back(std::move(work));
  }
}

class Croissant : public Exporter {
 public:
  Croissant(const ExportInput& input, ExportFolder& to)
      : input_(input), to_(to), parquet_(input, to) {}

  void add(const ExportImage& image) override { parquet_.add(image); }

  void finish() override {
    parquet_.finish();
    const DatasetRecord& dataset = input_.dataset;
    for (const char* name : {"cite", "creator", "published", "url"})
      if (!dataset.about.contains(name))
        to_.note(fmt::format("croissant.json lacks what dataset.{} of the recipe would say", name));
    json fields = json::array({split_field(input_)});
    for (const ParquetFile::Column& column : parquet_.columns())
      fields.push_back(field_of(column, dataset));
    json object{{"@context", context()},
                {"@type", "sc:Dataset"},
                {"conformsTo",
                 {"http://mlcommons.org/croissant/1.1", "http://mlcommons.org/croissant/RAI/1.0"}},
                {"name", dataset.name},
                {"description",
                 text_of(dataset, "description", "Pictures of 3D models, path-traced by dsbuild.")},
                {"license", licence_url(dataset.licence)},
                {"version", text_of(dataset, "version", "1.0.0")},
                {"distribution",
                 {{{"@type", "cr:FileSet"},
                   {"@id", k_files},
                   {"name", k_files},
                   {"encodingFormat", "application/x-parquet"},
                   {"includes", "data/*.parquet"}}}},
                {"recordSet",
                 {split_set(input_),
                  {{"@type", "cr:RecordSet"},
                   {"@id", "images"},
                   {"name", "images"},
                   {"description", "A row an image, with its picture and masks."},
                   {"key", {{"@id", "images/id"}}},
                   {"field", std::move(fields)}}}}};
    const auto optional = [&](const char* name, const char* as) {
      if (const auto at = dataset.about.find(name); at != dataset.about.end())
        object[as] = at->second;
    };
    optional("url", "url");
    optional("published", "datePublished");
    optional("cite", "citeAs");
    if (const auto at = dataset.about.find("creator"); at != dataset.about.end())
      object["creator"] = {{"@type", "sc:Organization"}, {"name", at->second}};
    add_making(object, input_);
    add_sources(object, dataset);
    to_.write("croissant.json", canonical_json(object, 1));
  }

 private:
  /// Of an SPDX id its page; else the text as it is.
  static std::string licence_url(const std::string& licence) {
    if (licence.empty()) return "not stated";
    const bool is_id = licence.find_first_of(" /:") == licence.npos;
    return is_id ? "https://spdx.org/licenses/" + licence + ".html" : licence;
  }

  const ExportInput& input_;
  ExportFolder& to_;
  Parquet parquet_;
};

}  // namespace

ExporterType croissant_exporter() {
  return {"croissant", "Croissant 1.1 (mlcroissant): croissant.json over the files of parquet",
          {"image"},   {},
          true,        make_exporter<Croissant>};
}

}  // namespace ds
