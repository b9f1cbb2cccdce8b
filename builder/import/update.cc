// SPDX-License-Identifier: Apache-2.0
#include "builder/import/update.h"

#include "tracer/base/error.h"
#include "tracer/base/files.h"
#include "tracer/base/text_lines.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <system_error>
#include <utility>

namespace ds {
namespace {

namespace fs = std::filesystem;

/// Text that ends with a line's end, so that lines can follow.
std::string whole_lines(const fs::path& file) {
  std::string text = read_text_file(file);
  if (!text.empty() && text.back() != '\n') text += '\n';
  return text;
}

/// Of a table, whose order of columns may be another by now.
std::vector<std::string> columns_of(const fs::path& file, std::string_view table) {
  std::string_view rest = without_bom(table);
  std::string_view line = take_line(rest);
  std::vector<std::string> columns;
  for (bool more = true; more;) {
    const std::size_t end = line.find(',');
    columns.emplace_back(line.substr(0, end));
    more = end != line.npos;
    if (more) line.remove_prefix(end + 1);
  }
  for (const char* wanted : {"name", "class"})
    if (std::find(columns.begin(), columns.end(), wanted) == columns.end())
      fail(ErrorKind::usage, "{}: --update wants the columns name and class, not in quotes",
           file.string());
  return columns;
}

std::string row_of(const std::vector<std::string>& columns, const std::string& name,
                   const ModelLabel& label) {
  std::string row;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (i > 0) row += ',';
    if (columns[i] == "name") row += csv_field(name);
    if (columns[i] == "class") row += csv_field(label.class_path);
    if (columns[i] == "split") row += label.split;
  }
  return row + "\n";
}

/// As after an update that was cut short.
bool lists(const Recipe& recipe, const std::string& hierarchy, const std::string& model) {
  return std::any_of(recipe.hierarchies.begin(), recipe.hierarchies.end(),
                     [&](const Hierarchy& one) {
                       return one.name == hierarchy && one.labels.find(model).has_value();
                     });
}

class Update {
 public:
  explicit Update(const ImportRequest& request);
  ImportResult run(const ImportProgress& progress, const std::atomic<bool>& stop);

 private:
  fs::path place(const char* name) const { return request_.to / name; }
  std::string name_of(const ModelFile& model) const {
    return by_path_ ? model.below : model.file.filename().string();
  }
  void check_names() const;
  void check_reachable(const ModelFile& model) const;
  void find_gone();
  /// Those that no line lists, and that nobody took out.
  std::vector<const ModelFile*> new_models();
  void write_classes();
  void write_ids();
  void write_hierarchies();
  void write_imported();

  ImportRequest request_;
  Recipe there_;  ///< as it is
  bool by_path_ = false;
  std::set<std::string> imported_;  ///< as k_imported has them
  FoundModels found_;
  ImportResult result_;
};

Update::Update(const ImportRequest& request) : request_(request) {
  std::error_code error;
  for (const char* name : {"recipe.toml", "classes.csv"})
    if (!fs::is_regular_file(place(name), error))
      fail(ErrorKind::usage, "-o {}: --update wants the folder of an import, found no {} in it",
           request_.to.string(), name);
  if (fs::exists(place(k_import_begun), error))
    fail(ErrorKind::usage, "-o {}: its import was cut short; import again without --update",
         request_.to.string());
  there_ = read_recipe(place("recipe.toml"), {"classes.unlisted=\"keep\""});
  if (!there_.class_table || !fs::equivalent(*there_.class_table, place("classes.csv"), error))
    fail(ErrorKind::usage,
         "-o {}: --update adds to its classes.csv, from which its recipe takes no classes any more "
         "(classes.from)",
         request_.to.string());
  by_path_ = std::find(there_.settings.begin(), there_.settings.end(),
                       std::pair<std::string, std::string>("models.names", "\"path\"")) !=
             there_.settings.end();
  request_.copy = request_.copy || fs::is_directory(place("models"), error);
  if (!fs::is_regular_file(place(k_imported), error)) return;
  const std::string names = read_text_file(place(k_imported));
  for (std::string_view rest = names; !rest.empty();)
    imported_.emplace(take_line(rest));
}

void Update::check_names() const {
  std::map<std::string, const ModelFile*> names;
  for (const ModelFile& model : found_.recipe.models) {
    const auto [first, is_new] = names.emplace(name_of(model), &model);
    if (!is_new)
      fail(ErrorKind::usage,
           "{} and {} have one name: models.names = \"path\" in {} and paths in its classes.csv "
           "tell them apart",
           first->second->below, model.below, place("recipe.toml").string());
  }
}

/// A line for a model that the recipe does not find would do nothing.
void Update::check_reachable(const ModelFile& model) const {
  if (request_.copy) return;
  std::error_code error;
  const std::string name = name_of(model);
  const auto at = std::lower_bound(
      there_.models.begin(), there_.models.end(), name,
      [](const ModelFile& one, const std::string& wanted) { return one.name < wanted; });
  if (at == there_.models.end() || at->name != name || !fs::equivalent(at->file, model.file, error))
    fail(ErrorKind::usage,
         "{}: {} takes its models from another folder (models.dir), and would not find it",
         model.file.string(), place("recipe.toml").string());
}

void Update::find_gone() {
  std::set<std::size_t> used;
  for (const ModelFile& model : there_.models)
    for (const std::size_t entry : there_.labels.find_all(model.name))
      used.insert(entry);
  for (std::size_t i = 0; i < there_.labels.size(); ++i)
    if (!used.contains(i)) result_.gone.push_back(there_.labels.name(i));
}

std::vector<const ModelFile*> Update::new_models() {
  std::vector<const ModelFile*> added;
  for (const ModelFile& model : found_.recipe.models) {
    const std::string name = name_of(model);
    if (!there_.labels.find_all(name).empty()) {
      ++result_.kept;
    } else if (imported_.contains(name)) {
      result_.taken_out.push_back(model.below);
    } else {
      check_reachable(model);
      added.push_back(&model);
    }
  }
  return added;
}

void Update::write_classes() {
  std::string table = whole_lines(place("classes.csv"));
  const std::vector<std::string> columns = columns_of(place("classes.csv"), table);
  // Else the recipe says what is test, of all models.
  const bool has_splits = there_.labels.has_splits();
  std::set<std::string> classes;
  for (const ModelFile* model : found_.good) {
    ModelLabel label = label_of(found_, *model);
    if (!has_splits) label.split = "";
    table += row_of(columns, name_of(*model), label);
    ++result_.splits[label.split];
    if (has_splits && label.split.empty()) result_.unsplit.push_back(model->below);
    if (label.class_path.empty())
      result_.unclassified.push_back(model->below);
    else
      classes.insert(label.class_path);
  }
  result_.classes.assign(classes.begin(), classes.end());
  std::set_difference(classes.begin(), classes.end(), there_.class_paths.begin(),
                      there_.class_paths.end(), std::back_inserter(result_.new_classes));
  write_ids();
  write_file_atomic(place("classes.csv"), table);
}

void Update::write_ids() {
  std::error_code error;
  if (!fs::is_regular_file(place("ids.txt"), error)) return;
  std::string ids = whole_lines(place("ids.txt"));
  const std::vector<std::string>& known = there_.class_ids;
  for (const std::string& path : result_.classes)
    if (std::find(known.begin(), known.end(), path) == known.end()) ids += path + "\n";
  write_file_atomic(place("ids.txt"), ids);
}

void Update::write_hierarchies() {
  for (const Hierarchy& hierarchy : found_.recipe.hierarchies) {
    const fs::path file = place("more") / (hierarchy.name + ".csv");
    std::error_code error;
    if (!fs::is_regular_file(file, error)) continue;
    std::string table = whole_lines(file);
    const std::vector<std::string> columns = columns_of(file, table);
    for (const ModelFile* model : found_.good)
      if (const auto label = hierarchy.labels.find(model->name);
          label && !lists(there_, hierarchy.name, name_of(*model)))
        table += row_of(columns, name_of(*model), {label->class_path, ""});
    write_file_atomic(file, table);
    result_.hierarchies.push_back(hierarchy.name);
  }
}

void Update::write_imported() {
  for (std::size_t i = 0; i < there_.labels.size(); ++i)
    imported_.insert(there_.labels.name(i));
  for (const ModelFile* model : found_.good)
    imported_.insert(name_of(*model));
  std::string names;
  for (const std::string& name : imported_)
    names += name + "\n";
  write_file_atomic(place(k_imported), names);
}

ImportResult Update::run(const ImportProgress& progress, const std::atomic<bool>& stop) {
  found_ = find_models_to_import(request_);
  check_names();
  find_gone();
  look_at_models(found_, new_models(), progress, stop, result_);
  if (!found_.good.empty()) {
    tell_split_folders(found_, request_, result_);
    if (request_.copy) copy_models(request_, found_);
    write_hierarchies();
    write_classes();
  }
  write_imported();
  result_.updated = true;
  result_.models = found_.good.size();
  result_.recipe = place("recipe.toml");
  return std::move(result_);
}

}  // namespace

ImportResult update_import(const ImportRequest& request, const ImportProgress& progress,
                           const std::atomic<bool>& stop) {
  return Update(request).run(progress, stop);
}

}  // namespace ds
