// SPDX-License-Identifier: Apache-2.0
#include "builder/import/found_models.h"

#include "builder/recipe/split_folders.h"
#include "builder/recipe/value.h"
#include "manifests/licences.h"
#include "tracer/base/error.h"
#include "tracer/base/files.h"
#include "tracer/base/log.h"
#include "tracer/base/parallel.h"
#include "tracer/scene/mesh.h"
#include "tracer/scene/own_materials.h"

#include <algorithm>
#include <mutex>
#include <optional>
#include <system_error>
#include <utility>

namespace ds {
namespace {

namespace fs = std::filesystem;

std::string list_text(const std::vector<fs::path>& files) {
  std::string list;
  for (const fs::path& file : files)
    list += (list.empty() ? "" : ", ") + to_toml(fs::absolute(file).string());
  return "[" + list + "]";
}

/// Nobody gave the settings that a folder is read by: what is wrong with one is the folder's, or the file's.
std::string in_imports_words(std::string text, const fs::path& from) {
  for (const auto& [setting, words] :
       {std::pair<std::string, std::string>("--set models.dir", from.string()),
        std::pair<std::string, std::string>("--set ", "")})
    for (std::size_t at = text.find(setting); at != text.npos;
         at = text.find(setting, at + words.size()))
      text.replace(at, setting.size(), words);
  return text;
}

/// The folder as recipes read it, with the names that tell all models apart.
Recipe read_folder(const ImportRequest& request, const std::vector<ClassSource>& sources) {
  const fs::path assets = shipped_assets();
  std::vector<std::string> settings{
      "models.dir=" + to_toml(fs::absolute(request.from).string()),
      "materials.dir=" + to_toml((assets / "materials").string()),
      "environments.dir=" + to_toml((assets / "environments").string())};
  if (sources.empty()) {
    settings.push_back("classes.from=" + request.classes);
    if (!request.split_folders) settings.emplace_back("classes.split_folders=false");
  }
  std::vector<fs::path> more;
  for (const ClassSource& source : sources) {
    if (&source != &sources.front()) {
      more.insert(more.end(), source.files.begin(), source.files.end());
      continue;
    }
    if (!source.train.empty())
      settings.push_back("classes.train=" + to_toml(fs::absolute(source.train).string()));
    if (!source.test.empty())
      settings.push_back("classes.test=" + to_toml(fs::absolute(source.test).string()));
    if (source.train.empty() && source.test.empty())
      settings.push_back("classes.from=" + to_toml(fs::absolute(source.files.front()).string()));
  }
  if (!more.empty()) settings.push_back("classes.more=" + list_text(more));
  const TemporaryFolder folder;
  write_file_atomic(folder.path() / "import.toml",
                    "models.recursive = true\nmodels.names = \"path\"\n");
  try {
    return read_recipe(folder.path() / "import.toml", settings);
  } catch (const Error& error) {
    fail(error.kind(), "{}", in_imports_words(error.what(), request.from));
  }
}

/// What reading a model's file told.
struct Looked {
  std::optional<std::string> error;
  bool mended = false;
  bool own = false;                      ///< it has materials of its own
  std::optional<std::string> own_error;  ///< why they cannot be shown
};

/// Files that its own materials are in, but for its own.
std::vector<fs::path> own_files(const fs::path& model, const OwnMaterials& own) {
  std::vector<fs::path> files = own_material_files(model);
  for (const OwnImage& image : own.images)
    if (image.embedded < 0) files.push_back(image.file);
  return files;
}

void look_at_own(const fs::path& model, Looked& looked) {
  try {
    const OwnMaterials own = read_own_materials(model);
    if (own.materials.empty()) return;
    for (const fs::path& file : own_files(model, own)) {
      std::error_code error;
      if (!fs::is_regular_file(file, error))
        fail(ErrorKind::asset, "{}: wanted an image of its own materials, found no file",
             file.string());
    }
    looked.own = true;
  } catch (const Error& error) {
    looked.own_error = error.what();
  }
}

std::vector<Looked> look_at(const std::vector<const ModelFile*>& models,
                            const ImportProgress& progress, const std::atomic<bool>& stop) {
  std::vector<Looked> looked(models.size());
  std::mutex mutex;
  std::uint64_t done = 0;
  parallel_ranges(models.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (stop) fail(ErrorKind::cancelled, "stopped; nothing is written");
      try {
        const Model model = read_model(models[i]->file);
        looked[i].mended = !mended_damage(model.report).empty();
        if (model.report.unused_materials > 0 || !model.mesh.materials.empty())
          look_at_own(models[i]->file, looked[i]);
      } catch (const Error& error) {
        looked[i].error = error.what();
      }
      const std::lock_guard lock(mutex);
      progress(++done, models.size());
    }
  });
  return looked;
}

fs::path models_of(const ImportRequest& request) {
  return request.to / "models";
}

/// Those beside the model or below `from`: what lies elsewhere is not part of what was handed over.
void copy_own(const ImportRequest& request, const fs::path& model, const fs::path& to) {
  for (const fs::path& file : own_files(model, read_own_materials(model))) {
    const fs::path beside = file.lexically_relative(model.parent_path());
    const fs::path copy = (to.parent_path() / beside).lexically_normal();
    const fs::path below = copy.lexically_relative(models_of(request).lexically_normal());
    if (beside.empty() || below.empty() || *below.begin() == "..")
      warn(fmt::format("{}: not copied: it lies outside of {}", file.string(),
                       request.from.string()));
    else
      copy_file_atomic(file, copy);
  }
}

/// What a licence or source beside models says holds of their copies too.
void copy_texts(const fs::path& from, const fs::path& to) {
  std::error_code error;
  for (fs::directory_iterator at(from, error), end; !error && at != end; at.increment(error)) {
    const std::string name = at->path().filename().string();
    std::error_code ignored;
    if ((is_licence_name(name) || is_source_name(name)) && fs::is_regular_file(at->path(), ignored))
      copy_file_atomic(at->path(), to / name);
    if (!is_licence_folder_name(name) || !fs::is_directory(at->path(), ignored)) continue;
    for (const fs::directory_entry& licence : fs::directory_iterator(at->path(), ignored))
      if (licence.is_regular_file(ignored))
        copy_file_atomic(licence.path(), to / name / licence.path().filename());
  }
}

}  // namespace

FoundModels find_models_to_import(const ImportRequest& request) {
  std::error_code error;
  if (!fs::is_directory(request.from, error))
    fail(ErrorKind::usage, "{}: wanted a folder of models, found none", request.from.string());
  const std::vector<ClassSource> sources = find_class_sources(request.from);
  FoundModels found;
  found.has_files = !sources.empty();
  found.recipe = read_folder(request, sources);
  return found;
}

void look_at_models(FoundModels& found, const std::vector<const ModelFile*>& models,
                    const ImportProgress& progress, const std::atomic<bool>& stop,
                    ImportResult& result) {
  const std::vector<Looked> looked = look_at(models, progress, stop);
  for (std::size_t i = 0; i < models.size(); ++i) {
    const ModelFile& model = *models[i];
    if (looked[i].error) {
      result.broken.emplace_back(model.below, *looked[i].error);
      continue;
    }
    if (looked[i].mended) result.mended.push_back(model.below);
    if (looked[i].own_error) result.own_broken.emplace_back(model.below, *looked[i].own_error);
    if (looked[i].own) {
      result.own.push_back(model.below);
      found.own.insert(&model);
    }
    found.good.push_back(&model);
  }
}

void tell_split_folders(const FoundModels& found, const ImportRequest& request,
                        ImportResult& result) {
  if (found.has_files) return;
  const SplitFolders folders(found.recipe.models);
  result.class_folders = folders.not_telling();
  if (request.split_folders)
    result.split_folders = folders.telling();
  else
    for (const auto& [folder, split] : folders.telling())
      result.class_folders.insert(folder);
}

ModelLabel label_of(const FoundModels& found, const ModelFile& model) {
  ModelLabel label = found.recipe.labels.find(model.name).value_or(ModelLabel{});
  if (!is_class_path(label.class_path))
    label.class_path = "";  // a folder "0", as the benchmark has
  return label;
}

std::string csv_field(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == text.npos) return text;
  std::string quoted = "\"";
  for (const char c : text)
    quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + '"';
}

bool share_file_names(const std::vector<ModelFile>& models) {
  std::set<std::string> names;
  return std::any_of(models.begin(), models.end(), [&](const ModelFile& model) {
    return !names.insert(model.file.filename().string()).second;
  });
}

void copy_models(const ImportRequest& request, const FoundModels& found) {
  std::set<fs::path> folders;
  for (const ModelFile* model : found.good) {
    const fs::path to = models_of(request) / model->below;
    const fs::path folder = model->file.parent_path();
    copy_file_atomic(model->file, to);
    for (const fs::path& part : model_parts(model->file))
      copy_file_atomic(part, to.parent_path() / part.lexically_relative(folder));
    if (found.own.contains(model)) copy_own(request, model->file, to);
    if (folders.insert(folder).second) copy_texts(folder, to.parent_path());
  }
}

}  // namespace ds
