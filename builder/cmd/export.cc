// SPDX-License-Identifier: Apache-2.0
#include "manifests/export/export.h"

#include "builder/cmd/from_manifest.h"
#include "builder/cmd/plan_text.h"
#include "builder/cmd/stop_signal.h"
#include "builder/cmd/verbs.h"
#include "builder/cmd/work_progress.h"
#include "manifests/whole_folder.h"
#include "tracer/base/error.h"
#include "tracer/base/log.h"
#include "tracer/base/regular_file.h"
#include "tracer/base/streams.h"
#include "tracer/scene/mesh.h"

#include <filesystem>
#include <functional>
#include <map>

namespace ds {
namespace {

std::vector<std::pair<std::string, std::string>> filters_of(const Arguments& arguments) {
  std::vector<std::pair<std::string, std::string>> filters;
  for (const std::string& filter : arguments.filters) {
    const std::size_t equals = filter.find('=');
    if (equals == filter.npos)
      fail(ErrorKind::usage, "--filter: wanted KEY=PATTERN, as class=vehicle/*, got {}", filter);
    filters.emplace_back(filter.substr(0, equals), filter.substr(equals + 1));
  }
  return filters;
}

/// Files of models by name.
using ModelFiles = std::map<std::string, std::filesystem::path>;

FileMesh read_shown(const ModelFiles& files, const std::string& model, const ModelPose* pose) {
  const auto at = files.find(model);
  if (at == files.end()) fail(ErrorKind::asset, "{}: the recipe has no such model any more", model);
  FileMesh mesh = read_model(at->second).mesh;
  if (pose != nullptr && bounds_of(mesh) != pose->model_box)
    fail(ErrorKind::asset,
         "{}: is no longer the model of the pictures; dsbuild build makes them anew",
         at->second.string());
  return mesh;
}

/// Reads models where the recipe names them; nothing where it cannot be read.
void add_mesh_readers(const Arguments& arguments, ExportRequest& request) {
  ModelFiles models, distractors;
  try {
    RealDisk disk;
    const Recipe recipe = open_dataset(arguments.request(), Access::look, disk).recipe;
    for (const ModelFile& model : recipe.models)
      models.emplace(model.name, model.file);
    for (const DistractorModel& model : recipe.distractors.models)
      distractors.emplace(*model.name, *model.file);
  } catch (const Error&) {
    return;
  }
  request.mesh = [models = std::move(models)](const ImageRecord& image) {
    return read_shown(models, image.model, image.pose ? &*image.pose : nullptr);
  };
  request.object_mesh = [distractors = std::move(distractors)](const ObjectRecord& object) {
    return read_shown(distractors, object.model, &object.pose);
  };
}

/// Of one that stands there; "" where none does.
std::string format_of_export(const std::filesystem::path& folder) {
  std::ifstream file = regular_stream(folder / k_export_folder.record);
  if (!file) return "";
  const nlohmann::json record = nlohmann::json::parse(file, nullptr, false);
  return record.is_object() ? record.value("format", "") : "";
}

ExportResult run(const ExportRequest& request) {
  const std::atomic<bool>& stop = stop_on_signal();
  WorkProgress progress("images exported");
  return export_dataset(
      request, [&](std::uint64_t done, std::uint64_t all) { progress(done, all); }, stop);
}

}  // namespace

int run_export(const Arguments& arguments) {
  const std::filesystem::path folder = dataset_folder(arguments.request());
  ExportRequest request{folder,
                        arguments.export_folder,
                        arguments.format,
                        arguments.splits,
                        filters_of(arguments),
                        arguments.hierarchy,
                        arguments.copy,
                        {},
                        {},
                        {}};
  add_mesh_readers(arguments, request);
  const BehindRecipe behind = behind_recipe(arguments, "exported is what the manifest lists");
  if (behind.unmade > 0 && !arguments.partial)
    fail(ErrorKind::asset,
         "{}: {} of {} images are not made; dsbuild build makes them, and --partial exports the "
         "others without them",
         folder.string(), behind.unmade, behind.images);
  if (!behind.text.empty()) request.notes.push_back(behind.text);
  const std::string before = format_of_export(request.to);
  const ExportResult result = run(request);
  for (const std::string& note : result.notes)
    warn(note);
  if (!before.empty() && before != arguments.format)
    warn(fmt::format("{}: the export as {} that stood there is replaced", arguments.export_folder,
                     before));
  if (arguments.json) {
    print_json({{"format", arguments.format},
                {"folder", arguments.export_folder},
                {"images", result.images},
                {"files", result.files},
                {"bytes", result.bytes},
                {"splits", result.splits},
                {"left_out", result.left_out},
                {"notes", result.notes}});
    return 0;
  }
  std::string left_out;
  for (const auto& [why, count] : result.left_out)
    left_out += fmt::format("; {} left out ({})", count,
                            why == "unclassified" ? "without a class or split"
                            : why == "split"      ? "of another split"
                                                  : "by --filter");
  say(Stream::report, "{}: {} images, {} files, {:.1f} MB{}\n", arguments.export_folder,
      result.images, result.files, static_cast<double>(result.bytes) / 1e6, left_out);
  return 0;
}

}  // namespace ds
