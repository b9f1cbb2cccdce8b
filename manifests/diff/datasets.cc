// SPDX-License-Identifier: Apache-2.0
#include "manifests/diff/datasets.h"

#include "manifests/diff/manifest_lines.h"
#include "manifests/json_text.h"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <string_view>
#include <utility>

namespace ds {
namespace {

using nlohmann::json;

constexpr std::array k_parts{"model", "material", "environment", "camera", "engine"};

/// Keys, files and parts are compared by themselves; what is counted in a picture follows from it.
bool is_of_files(const std::string& field) {
  static const std::set<std::string, std::less<>> names{
      "box",          "files", "files_key",      "film",
      "occlusion",    "parts", "relative_error", "rejected_samples",
      "pixel_counts", "id",    "render_key",     "visible_fraction",
      "truncation"};
  return names.contains(field);
}

/// Names of fields of two objects that are not in both with one value.
std::vector<std::string> differing_fields(const json& a, const json& b,
                                          bool (*leave_out)(const std::string&)) {
  std::set<std::string> names;
  for (const auto& [x, y] : {std::pair(&a, &b), std::pair(&b, &a)})
    for (const auto& [name, value] : x->items())
      if (const auto at = y->find(name); at == y->end() || *at != value) names.insert(name);
  std::erase_if(names, leave_out);
  return {names.begin(), names.end()};
}

std::vector<ChangedFile> changed_files(const ImageRecord& a, const ImageRecord& b) {
  std::map<std::string_view, ChangedFile> by_kind;
  for (const FileRecord& file : a.files)
    by_kind[file.kind].a = file;
  for (const FileRecord& file : b.files)
    by_kind[file.kind].b = file;
  std::vector<ChangedFile> changed;
  for (auto& [kind, files] : by_kind)
    if (!files.a || !files.b || files.a->hashes.xxh128 != files.b->hashes.xxh128)
      changed.push_back(std::move(files));
  return changed;
}

/// The lines of a recipe's text whose keys begin so.
std::vector<std::string_view> lines_of(std::string_view recipe, std::string_view beginning) {
  // Of the engine, but in no key: what is kept, and what is refused.
  constexpr std::array<std::string_view, 2> k_in_no_key{"engine.keep_sums ",
                                                        "engine.rejected_limit "};
  std::vector<std::string_view> lines;
  for (std::size_t at = 0; at < recipe.size();) {
    const std::size_t end = std::min(recipe.find('\n', at), recipe.size());
    const std::string_view line = recipe.substr(at, end - at);
    at = end + 1;
    const auto begins = [&](std::string_view key) { return line.starts_with(key); };
    if (begins(beginning) && std::none_of(k_in_no_key.begin(), k_in_no_key.end(), begins))
      lines.push_back(line);
  }
  return lines;
}

/// What two recipes have in common for all images.
struct Common {
  bool engine = false;   ///< the program, and what the recipe says of the engine
  bool target = false;   ///< samples are taken until an error is reached: each image's spp follows
  bool normals = false;  ///< how models are shaded
};

Common common_of(const DatasetRecord& a, const DatasetRecord& b) {
  const auto same = [&](std::string_view beginning) {
    return lines_of(a.recipe_text, beginning) == lines_of(b.recipe_text, beginning);
  };
  Common common;
  common.target = !lines_of(a.recipe_text, "engine.max_spp ").empty();
  // Where samples go is decided by the picture as it is developed.
  common.engine = a.dsbuild_version == b.dsbuild_version && same("engine.") &&
                  (!common.target || same("outputs.tone_map"));
  common.normals = same("models.normals ") && same("models.crease_deg ");
  return common;
}

/// The parts that differ by themselves. The engine's has the program, whose parts follow from what
/// the scene and the lens need of it; the model's has what of its file the material reads.
std::vector<std::string> differing_parts(const ImageRecord& a, const ImageRecord& b,
                                         const Common& common, bool same_shape) {
  std::array<bool, k_parts.size()> differs{};
  for (std::size_t i = 0; i < k_parts.size(); ++i)
    differs[i] = a.parts[i] != b.parts[i];
  const auto [model, material, environment, camera, engine] = differs;
  const bool same_engine = common.engine && a.seed == b.seed && a.width == b.width &&
                           a.height == b.height && a.math == b.math &&
                           (common.target || a.spp == b.spp);
  if (engine && same_engine && (material || environment || camera)) differs[4] = false;
  const bool same_model =
      common.normals && same_shape && a.model == b.model && a.pose && a.pose == b.pose;
  if (model && same_model && material) differs[0] = false;
  std::vector<std::string> parts;
  for (std::size_t i = 0; i < k_parts.size(); ++i)
    if (differs[i]) parts.emplace_back(k_parts[i]);
  return parts;
}

/// Whether both datasets tell of the same shape of a model.
bool is_same_shape(const DatasetRecord& a, const DatasetRecord& b, const std::string& model) {
  const auto in_a = a.shapes.find(model), in_b = b.shapes.find(model);
  return in_a != a.shapes.end() && in_b != b.shapes.end() && in_a->second == in_b->second;
}

ChangedImage compare(const ImageRecord& a, const ImageRecord& b, const Common& common,
                     bool same_shape) {
  ChangedImage found{a.id, differing_parts(a, b, common, same_shape), {}, changed_files(a, b)};
  const std::string line_a = to_json_line(a), line_b = to_json_line(b);
  if (line_a != line_b)
    found.fields = differing_fields(json::parse(line_a), json::parse(line_b), is_of_files);
  return found;
}

/// Both records and what both say of all images.
struct Records {
  Records(const std::filesystem::path& folder_a, const std::filesystem::path& folder_b)
      : a(read_dataset_manifest(folder_a)),
        b(read_dataset_manifest(folder_b)),
        common(common_of(a, b)) {}
  DatasetRecord a, b;
  Common common;
};

void compare(const ManifestLines& x, const ManifestLines& y, const Records& records,
             DatasetDifference& found) {
  const ImageRecord a = x.record(), b = y.record();
  ChangedImage image = compare(a, b, records.common, is_same_shape(records.a, records.b, a.model));
  if (image.parts.empty() && image.fields.empty() && image.files.empty())
    ++found.same;
  else
    found.changed.push_back(std::move(image));
}

}  // namespace

DatasetDifference compare_datasets(const std::filesystem::path& a, const std::filesystem::path& b) {
  DatasetDifference found;
  ManifestLines x(a), y(b);
  const Records records(a, b);
  while (!x.at_end() || !y.at_end()) {
    if (y.at_end() || (!x.at_end() && x.id() < y.id())) {
      found.only_a.push_back(x.id());
      x.next();
    } else if (x.at_end() || y.id() < x.id()) {
      found.only_b.push_back(y.id());
      y.next();
    } else {
      if (x.text() == y.text())
        ++found.same;
      else
        compare(x, y, records, found);
      x.next();
      y.next();
    }
  }
  found.dataset_fields = differing_fields(
      json::parse(to_json(records.a)), json::parse(to_json(records.b)),
      [](const std::string& name) { return name == "concerns" || name == "counts"; });
  return found;
}

}  // namespace ds
