// SPDX-License-Identifier: Apache-2.0
#include "builder/import/import.h"

#include "builder/import/class_sources.h"
#include "builder/import/recipe_text.h"
#include "builder/recipe/recipe.h"
#include "builder/recipe/value.h"
#include "tracer/base/error.h"
#include "tracer/base/files.h"
#include "tracer/base/log.h"
#include "tracer/base/parallel.h"
#include "tracer/scene/mesh.h"
#include "tracer/scene/own_materials.h"

#include <algorithm>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <system_error>

namespace ds {
namespace {

namespace fs = std::filesystem;

/// Stands in the folder while it is filled: what lies there is then an import's own.
constexpr const char* k_begun = ".dsbuild-import";

std::string list_text(const std::vector<fs::path>& files) {
  std::string list;
  for (const fs::path& file : files)
    list += (list.empty() ? "" : ", ") + to_toml(fs::absolute(file).string());
  return "[" + list + "]";
}

/// The folder as recipes read it, with the names that tell all models apart.
Recipe read_folder(const fs::path& from, const std::string& classes,
                   const std::vector<ClassSource>& sources) {
  const fs::path assets = shipped_assets();
  std::vector<std::string> settings{
      "models.dir=" + to_toml(fs::absolute(from).string()),
      "materials.dir=" + to_toml((assets / "materials").string()),
      "environments.dir=" + to_toml((assets / "environments").string())};
  if (sources.empty()) settings.emplace_back("classes.from=" + classes);
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
  return read_recipe(folder.path() / "import.toml", settings);
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

std::vector<Looked> look_at(const std::vector<ModelFile>& models,
                            const std::function<void(std::uint64_t, std::uint64_t)>& progress,
                            const std::atomic<bool>& stop) {
  std::vector<Looked> looked(models.size());
  std::mutex mutex;
  std::uint64_t done = 0;
  parallel_ranges(models.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (stop) fail(ErrorKind::cancelled, "stopped; no recipe is written");
      try {
        const Model model = read_model(models[i].file);
        looked[i].mended = !mended_damage(model.report).empty();
        if (model.report.unused_materials > 0 || !model.mesh.materials.empty())
          look_at_own(models[i].file, looked[i]);
      } catch (const Error& error) {
        looked[i].error = error.what();
      }
      const std::lock_guard lock(mutex);
      progress(++done, models.size());
    }
  });
  return looked;
}

std::vector<std::string> missing_models(const Recipe& recipe) {
  std::set<std::size_t> used;
  for (const ModelFile& model : recipe.models)
    for (const std::size_t entry : recipe.labels.find_all(model.name))
      used.insert(entry);
  std::vector<std::string> missing;
  for (std::size_t i = 0; i < recipe.labels.size(); ++i)
    if (!used.contains(i)) missing.push_back(recipe.labels.name(i));
  return missing;
}

bool share_file_names(const std::vector<ModelFile>& models) {
  std::set<std::string> names;
  return std::any_of(models.begin(), models.end(), [&](const ModelFile& model) {
    return !names.insert(model.file.filename().string()).second;
  });
}

/// As RFC 4180 has it.
std::string field(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == text.npos) return text;
  std::string quoted = "\"";
  for (const char c : text)
    quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + '"';
}

class Import {
 public:
  Import(const ImportRequest& request, const Recipe& recipe, const std::vector<Looked>& looked,
         bool has_files)
      : request_(request), recipe_(recipe), has_files_(has_files) {
    for (std::size_t i = 0; i < recipe.models.size(); ++i) {
      const ModelFile& model = recipe.models[i];
      if (looked[i].error) {
        result_.broken.emplace_back(model.below, *looked[i].error);
        continue;
      }
      if (looked[i].mended) result_.mended.push_back(model.below);
      if (looked[i].own_error) result_.own_broken.emplace_back(model.below, *looked[i].own_error);
      if (looked[i].own) {
        result_.own.push_back(model.below);
        own_.insert(&model);
      }
      good_.push_back(&model);
    }
    if (good_.empty())
      fail(ErrorKind::asset, "{}: none of {} models can be used; the first: {}",
           request.from.string(), recipe.models.size(), *looked.front().error);
    if (has_files) result_.missing = missing_models(recipe);
    by_path_ = share_file_names(recipe.models);
  }

  ImportResult write();

 private:
  std::string name_of(const ModelFile& model) const {
    return by_path_ ? model.below : model.file.filename().string();
  }
  fs::path place(const char* name) const { return request_.to / name; }
  void check_free() const;
  void write_classes();
  void write_hierarchies();
  void copy_own(const fs::path& model, const fs::path& to) const;
  void copy_models() const;
  void copy_assets() const;

  const ImportRequest& request_;
  const Recipe& recipe_;
  bool has_files_;  ///< classes come from class files, not from folders
  std::vector<const ModelFile*> good_;
  std::set<const ModelFile*> own_;  ///< with materials of their own
  bool by_path_ = false;
  ImportResult result_;
};

void Import::check_free() const {
  std::error_code error;
  if (fs::exists(request_.to, error) && !fs::is_directory(request_.to, error))
    fail(ErrorKind::usage, "-o {}: wanted a folder, found another file", request_.to.string());
  if (fs::exists(place(k_begun), error)) return;
  for (const char* name :
       {"recipe.toml", "classes.csv", "ids.txt", "more", "materials", "environments", "models"})
    if (fs::exists(place(name), error))
      fail(ErrorKind::usage, "-o {}: holds a {} already; give another folder{}",
           request_.to.string(), name,
           fs::exists(place("classes.csv"), error)
               ? ", or add the lines of new models to its classes.csv"
               : "");
}

void Import::write_classes() {
  std::string table = "name,class,split\n";
  std::map<std::string, std::uint64_t> classes;
  for (const ModelFile* model : good_) {
    ModelLabel label = recipe_.labels.find(model->name).value_or(ModelLabel{});
    if (!is_class_path(label.class_path))
      label.class_path = "";  // a folder "0", as the benchmark has
    table +=
        fmt::format("{},{},{}\n", field(name_of(*model)), field(label.class_path), label.split);
    ++result_.splits[label.split];
    if (label.class_path.empty())
      result_.unclassified.push_back(model->below);
    else
      ++classes[label.class_path];
  }
  for (const auto& [path, models] : classes) {
    result_.classes.push_back(path);
    if (models == 1 && !has_files_) result_.single.push_back(path);
  }
  write_file_atomic(place("classes.csv"), table);
  if (classes.empty()) return;
  std::string ids;
  for (const std::string& path : result_.classes)
    ids += path + "\n";
  write_file_atomic(place("ids.txt"), ids);
}

void Import::write_hierarchies() {
  for (const Hierarchy& hierarchy : recipe_.hierarchies) {
    std::string table = "name,class\n";
    for (const ModelFile* model : good_)
      if (const auto label = hierarchy.labels.find(model->name))
        table += fmt::format("{},{}\n", field(name_of(*model)), field(label->class_path));
    write_file_atomic(place("more") / (hierarchy.name + ".csv"), table);
    result_.hierarchies.push_back(hierarchy.name);
  }
}

/// Those beside the model or below `from`: what lies elsewhere is not part of what was handed over.
void Import::copy_own(const fs::path& model, const fs::path& to) const {
  for (const fs::path& file : own_files(model, read_own_materials(model))) {
    const fs::path beside = file.lexically_relative(model.parent_path());
    const fs::path copy = (to.parent_path() / beside).lexically_normal();
    const fs::path below = copy.lexically_relative(place("models").lexically_normal());
    if (beside.empty() || below.empty() || *below.begin() == "..")
      warn(fmt::format("{}: not copied: it lies outside of {}", file.string(),
                       request_.from.string()));
    else
      copy_file_atomic(file, copy);
  }
}

void Import::copy_models() const {
  std::set<fs::path> folders;
  for (const ModelFile* model : good_) {
    const fs::path to = place("models") / model->below;
    copy_file_atomic(model->file, to);
    for (const fs::path& part : model_parts(model->file))
      copy_file_atomic(part, to.parent_path() / part.lexically_relative(model->file.parent_path()));
    if (own_.contains(model)) copy_own(model->file, to);
    // What a licence or source beside it says holds of the copy too.
    if (!folders.insert(model->file.parent_path()).second) continue;
    std::error_code error;
    for (fs::directory_iterator at(model->file.parent_path(), error), end; !error && at != end;
         at.increment(error)) {
      const std::string name = at->path().filename().string();
      std::error_code ignored;
      if ((name.starts_with("LICEN") || name.starts_with("COPYING") ||
           name.starts_with("SOURCE")) &&
          fs::is_regular_file(at->path(), ignored))
        copy_file_atomic(at->path(), to.parent_path() / name);
    }
  }
}

void Import::copy_assets() const {
  const fs::path assets = shipped_assets();
  for (const char* kind : {"materials", "environments"}) {
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(assets / kind))
      if (entry.is_regular_file())
        copy_file_atomic(entry.path(),
                         place(kind) / entry.path().lexically_relative(assets / kind));
    for (const char* text : {"LICENSE", "SOURCE"})
      copy_file_atomic(assets / text, place(kind) / text);
  }
}

/// Of the folder's name what dataset.name may hold.
std::string dataset_name(const fs::path& folder) {
  std::string name = fs::absolute(folder).lexically_normal().filename().string();
  if (name.empty())
    name = fs::absolute(folder).lexically_normal().parent_path().filename().string();
  for (char& c : name) {
    const auto byte = static_cast<unsigned char>(c);
    const bool fits = byte < 0x80 && (std::isalnum(byte) != 0 || c == '.' || c == '_' || c == '-');
    if (!fits) c = '_';
  }
  return name.empty() || name.front() == '.' ? "dataset" : name;
}

ImportResult Import::write() {
  check_free();
  write_file_atomic(place(k_begun), "");
  write_classes();
  write_hierarchies();
  copy_assets();
  if (request_.copy) copy_models();
  RecipeFacts facts{
      dataset_name(request_.to),
      request_.from.filename().empty() ? request_.from.parent_path().filename().string()
                                       : request_.from.filename().string(),
      request_.copy ? "models" : fs::canonical(request_.from).string(),
      by_path_,
      !result_.classes.empty(),
      result_.splits.size() > 1 || !result_.splits.contains(""),
      {},
      own_.empty()                  ? ""
      : own_.size() == good_.size() ? "The models"
                                    : fmt::format("{} of {} models", own_.size(), good_.size())};
  for (const std::string& name : result_.hierarchies)
    facts.more.push_back("more/" + name + ".csv");
  result_.models = good_.size();
  result_.recipe = place("recipe.toml");
  write_file_atomic(result_.recipe, recipe_text(facts));
  fs::remove(place(k_begun));
  return std::move(result_);
}

}  // namespace

ImportResult import_models(const ImportRequest& request,
                           const std::function<void(std::uint64_t, std::uint64_t)>& progress,
                           const std::atomic<bool>& stop) {
  std::error_code error;
  if (!fs::is_directory(request.from, error))
    fail(ErrorKind::usage, "{}: wanted a folder of models, found none", request.from.string());
  const std::vector<ClassSource> sources = find_class_sources(request.from);
  const Recipe recipe = read_folder(request.from, request.classes, sources);
  const std::vector<Looked> looked = look_at(recipe.models, progress, stop);
  return Import(request, recipe, looked, !sources.empty()).write();
}

}  // namespace ds
