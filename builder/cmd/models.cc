// SPDX-License-Identifier: Apache-2.0
#include "builder/cmd/plan_text.h"
#include "builder/cmd/verbs.h"
#include "builder/recipe/recipe.h"
#include "tracer/base/streams.h"
#include "tracer/scene/mesh.h"

#include <nlohmann/json.hpp>

namespace ds {
namespace {

void print_header() {
  say(Stream::result, "{:<24}", "model");
  for (const MeshReportColumn& column : k_mesh_report_columns)
    say(Stream::result, " {:>14}", column.name);
  say(Stream::result, "  stored\n");
}

void print_row(const std::string& name, const MeshReport& report) {
  say(Stream::result, "{:<24}", name);
  for (const MeshReportColumn& column : k_mesh_report_columns)
    say(Stream::result, " {:>14}", report.*column.count);
  std::vector<std::string_view> stored;
  if (report.has_normals) stored.emplace_back("normals");
  if (report.has_uvs) stored.emplace_back("uvs");
  if (report.has_colors) stored.emplace_back("colours");
  if (stored.empty()) stored.emplace_back("-");
  say(Stream::result, "  {}\n", fmt::join(stored, ", "));
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
  for (const std::filesystem::path& file : recipe.models) {
    const std::string name = file.filename().string();
    try {
      const MeshReport report = read_model(file).report;
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
    say(Stream::result, "{} models, {} cannot be used\n", recipe.models.size(), failed);
  return failed > 0 ? 1 : 0;
}

}  // namespace ds
