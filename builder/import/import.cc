// SPDX-License-Identifier: Apache-2.0
#include "builder/import/import.h"

#include "builder/import/found_models.h"
#include "builder/import/recipe_text.h"
#include "builder/import/update.h"
#include "tracer/base/error.h"
#include "tracer/base/files.h"

#include <algorithm>
#include <map>
#include <set>
#include <system_error>

namespace ds {
namespace {

namespace fs = std::filesystem;

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

/// Another folder, or an update of what an import wrote there.
void check_free(const ImportRequest& request) {
  std::error_code error;
  const auto place = [&](const char* name) { return request.to / name; };
  if (fs::exists(request.to, error) && !fs::is_directory(request.to, error))
    fail(ErrorKind::usage, "-o {}: wanted a folder, found another file", request.to.string());
  if (fs::exists(place(k_import_begun), error)) return;
  for (const char* name :
       {"recipe.toml", "classes.csv", "ids.txt", "more", "materials", "environments", "models"})
    if (fs::exists(place(name), error))
      fail(ErrorKind::usage, "-o {}: holds a {} already; give another folder{}",
           request.to.string(), name,
           fs::exists(place("classes.csv"), error)
               ? ", or --update, which adds new models to its classes.csv and leaves the rest as "
                 "it is"
               : "");
}

class Import {
 public:
  Import(const ImportRequest& request, const FoundModels& found, ImportResult result)
      : request_(request), found_(found), result_(std::move(result)) {
    const Recipe& recipe = found.recipe;
    if (found.good.empty())
      fail(ErrorKind::asset, "{}: none of {} models can be used; the first: {}",
           request.from.string(), recipe.models.size(), result_.broken.front().second);
    tell_split_folders(found, request, result_);
    if (found.has_files) result_.missing = missing_models(recipe);
    by_path_ = share_file_names(recipe.models);
  }

  ImportResult write();

 private:
  std::string name_of(const ModelFile& model) const {
    return by_path_ ? model.below : model.file.filename().string();
  }
  fs::path place(const char* name) const { return request_.to / name; }
  void write_classes();
  void write_hierarchies();
  void copy_assets() const;

  const ImportRequest& request_;
  const FoundModels& found_;
  bool by_path_ = false;
  ImportResult result_;
};

void Import::write_classes() {
  std::string table = "name,class,split\n";
  std::map<std::string, std::uint64_t> classes;
  std::string names;
  for (const ModelFile* model : found_.good) {
    const ModelLabel label = label_of(found_, *model);
    table += fmt::format("{},{},{}\n", csv_field(name_of(*model)), csv_field(label.class_path),
                         label.split);
    names += name_of(*model) + "\n";
    ++result_.splits[label.split];
    if (label.class_path.empty())
      result_.unclassified.push_back(model->below);
    else
      ++classes[label.class_path];
  }
  for (const auto& [path, models] : classes) {
    result_.classes.push_back(path);
    if (models == 1 && !found_.has_files) result_.single.push_back(path);
  }
  write_file_atomic(place("classes.csv"), table);
  write_file_atomic(place(k_imported), names);
  if (classes.empty()) return;
  std::string ids;
  for (const std::string& path : result_.classes)
    ids += path + "\n";
  write_file_atomic(place("ids.txt"), ids);
}

void Import::write_hierarchies() {
  for (const Hierarchy& hierarchy : found_.recipe.hierarchies) {
    std::string table = "name,class\n";
    for (const ModelFile* model : found_.good)
      if (const auto label = hierarchy.labels.find(model->name))
        table += fmt::format("{},{}\n", csv_field(name_of(*model)), csv_field(label->class_path));
    write_file_atomic(place("more") / (hierarchy.name + ".csv"), table);
    result_.hierarchies.push_back(hierarchy.name);
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
  write_file_atomic(place(k_import_begun), "");
  write_classes();
  write_hierarchies();
  copy_assets();
  if (request_.copy) copy_models(request_, found_);
  RecipeFacts facts{dataset_name(request_.to),
                    request_.from.filename().empty()
                        ? request_.from.parent_path().filename().string()
                        : request_.from.filename().string(),
                    request_.copy ? "models" : fs::canonical(request_.from).string(),
                    by_path_,
                    !result_.classes.empty(),
                    result_.splits.size() > 1 || !result_.splits.contains(""),
                    {},
                    found_.own.empty() ? ""
                    : found_.own.size() == found_.good.size()
                        ? "The models"
                        : fmt::format("{} of {} models", found_.own.size(), found_.good.size())};
  for (const std::string& name : result_.hierarchies)
    facts.more.push_back("more/" + name + ".csv");
  result_.models = found_.good.size();
  result_.recipe = place("recipe.toml");
  write_file_atomic(result_.recipe, recipe_text(facts));
  fs::remove(place(k_import_begun));
  return std::move(result_);
}

}  // namespace

ImportResult import_models(const ImportRequest& request,
                           const std::function<void(std::uint64_t, std::uint64_t)>& progress,
                           const std::atomic<bool>& stop) {
  if (request.update) return update_import(request, progress, stop);
  check_free(request);
  FoundModels found = find_models_to_import(request);
  std::vector<const ModelFile*> models;
  for (const ModelFile& model : found.recipe.models)
    models.push_back(&model);
  ImportResult result;
  look_at_models(found, models, progress, stop, result);
  return Import(request, found, std::move(result)).write();
}

}  // namespace ds
