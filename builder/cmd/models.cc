// SPDX-License-Identifier: Apache-2.0
#include "builder/cmd/help_text.h"
#include "builder/cmd/plan_text.h"
#include "builder/cmd/verbs.h"
#include "builder/recipe/recipe.h"
#include "tracer/base/streams.h"
#include "tracer/base/text_width.h"
#include "tracer/scene/mesh.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <string_view>

namespace ds {
namespace {

/// What every model has a count of; the others are named where they are not 0.
constexpr std::array k_always{"vertices", "faces", "triangles_kept"};

bool is_always_shown(const MeshReportColumn& column) {
  return std::find(k_always.begin(), k_always.end(), std::string_view(column.name)) !=
         k_always.end();
}

void print_header() {
  say(Stream::result, "{:<24} {:>9} {:>9} {:>9}  found\n", "model", "vertices", "faces",
      "triangles");
}

/// As narrow as help is: `--json` has every count by its name.
void print_row(const std::string& name, const MeshReport& report) {
  std::string line = fmt::format("{:<24}", name);
  std::vector<std::string> found;
  for (const MeshReportColumn& column : k_mesh_report_columns) {
    const std::uint64_t count = report.*column.count;
    if (is_always_shown(column))
      line += fmt::format(" {:>9}", count);
    else if (count > 0 && column.count != &MeshReport::triangles)
      found.push_back(fmt::format("{} {}", count, column.name));
  }
  if (report.has_normals) found.emplace_back("normals");
  if (report.has_uvs) found.emplace_back("uvs");
  if (report.has_colors) found.emplace_back("colours");
  constexpr std::size_t k_indent = 56;
  line += "  ";
  if (columns_of(line) > static_cast<int>(k_indent) && !found.empty())
    line += "\n" + std::string(k_indent, ' ');
  line += wrap(fmt::format("{}", fmt::join(found, ", ")), k_indent, k_indent);
  while (line.ends_with(' '))
    line.pop_back();
  say(Stream::result, "{}\n", line);
}

nlohmann::json to_json(const std::string& name, const MeshReport& report) {
  nlohmann::json object{{"model", name},
                        {"has_normals", report.has_normals},
                        {"has_uvs", report.has_uvs},
                        {"has_colors", report.has_colors}};
  for (const MeshReportColumn& column : k_mesh_report_columns)
    object[column.name] = report.*column.count;
  return object;
}

}  // namespace

int run_models(const Arguments& arguments) {
  RealDisk disk;
  const Recipe recipe = open_dataset(arguments.request(), Access::inputs, disk).recipe;
  nlohmann::json models = nlohmann::json::array();
  std::size_t failed = 0;
  if (!arguments.json) print_header();
  for (const ModelFile& model : recipe.models) {
    const std::string& name = model.name;
    try {
      const MeshReport report = read_model(model.file).report;
      if (!arguments.json) print_row(name, report);
      models.push_back(to_json(name, report));
    } catch (const Error& error) {
      ++failed;
      if (!arguments.json) say(Stream::result, "{:<24} cannot be used: {}\n", name, error.what());
      models.push_back({{"model", name}, {"error", error.what()}});
    }
  }
  if (arguments.json)
    print_json({{"models", models}, {"failed", failed}});
  else
    say(Stream::result, "{} model{}, {} cannot be used\n", recipe.models.size(),
        recipe.models.size() == 1 ? "" : "s", failed);
  return failed > 0 ? 1 : 0;
}

}  // namespace ds
