// SPDX-License-Identifier: Apache-2.0
#include "manifests/classification.h"

#include "tracer/base/error.h"
#include "tracer/base/files.h"
#include "tracer/base/nearest.h"
#include "tracer/base/text_lines.h"
#include "tracer/base/utf8.h"

#include <algorithm>
#include <charconv>
#include <map>
#include <set>
#include <utility>

namespace ds {
namespace {

/// What splits are called, and which they are.
constexpr std::pair<std::string_view, std::string_view> k_split_names[] = {
    {"train", "train"},    {"training", "train"}, {"val", "val"},   {"valid", "val"},
    {"validation", "val"}, {"dev", "val"},        {"test", "test"}, {"testing", "test"},
    {"eval", "test"},      {"evaluation", "test"}};

std::vector<std::string_view> split_words(std::string_view line) {
  constexpr std::string_view k_blank = " \t\v\f";
  std::vector<std::string_view> words;
  for (std::size_t at = line.find_first_not_of(k_blank); at != line.npos;) {
    const std::size_t end = line.find_first_of(k_blank, at);
    words.push_back(line.substr(at, end - at));
    at = line.find_first_not_of(k_blank, end);
  }
  return words;
}

/// Whether the line of several words may be a file name with blanks in it: "coffee mug.ply". The last
/// word of a class is a count.
bool is_file_name(const std::vector<std::string_view>& words) {
  const std::string_view last = words.back();
  const std::size_t dot = last.rfind('.');
  return dot != last.npos && dot + 1 < last.size() &&
         last.find_first_not_of("0123456789.+-") != last.npos;
}

/// A count: decimal digits only, nothing where it is anything else or too large for an int.
std::optional<int> parse_count(std::string_view word) {
  int value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size() || value < 0) return std::nullopt;
  return value;
}

/// Reads line by line. The number of words says what a line is (three: a class, one: a model), so a
/// wrong count is one finding and the rest of the file is still read as it was meant.
class Parser {
 public:
  explicit Parser(const std::string& file) : diagnostics_(ErrorKind::asset) { result_.file = file; }

  Classification parse(std::string_view text) {
    check_utf8(text, result_.file, diagnostics_);
    diagnostics_.throw_if_any();
    text = without_bom(text);
    while (!text.empty()) {
      ++line_;
      if (const auto words = split_words(take_line(text)); !words.empty()) read_line(words);
    }
    close_class();
    check_totals();
    diagnostics_.throw_if_any();
    return std::move(result_);
  }

 private:
  SourcePlace here() const { return {result_.file, line_, 0}; }

  void read_line(const std::vector<std::string_view>& words) {
    if (!magic_seen_) {
      read_magic(words);
    } else if (totals_line_ == 0) {
      read_totals(words);
    } else if (words.size() == 1 || is_file_name(words)) {
      add_model(fmt::format("{}", fmt::join(words, " ")));
    } else if (words.size() == 3) {
      close_class();
      open_class(words);
    } else {
      diagnostics_.add(
          here(),
          "must be a class (name parent count) or a model (one word, or a file name with "
          "its ending), got {} words: {}",
          words.size(), fmt::join(words, " "));
      // Which models are of which class is not known from here on.
      said_in_class_.reset();
      miscounted_ = lost_class_ = true;
    }
  }

  void read_magic(const std::vector<std::string_view>& words) {
    magic_seen_ = true;
    if (words.size() == 2 && words[0] == "PSB" && words[1] == "1") return;
    diagnostics_.add(here(), "must be \"PSB 1\", got \"{}\"", fmt::join(words, " "));
    diagnostics_.throw_if_any();  // another kind of file: what follows would be noise
  }

  void read_totals(const std::vector<std::string_view>& words) {
    totals_line_ = line_;
    const auto classes = words.size() == 2 ? parse_count(words[0]) : std::nullopt;
    const auto models = words.size() == 2 ? parse_count(words[1]) : std::nullopt;
    if (classes && models) {
      said_classes_ = *classes;
      said_models_ = *models;
    } else {
      diagnostics_.add(here(), "must be the number of classes and of models, got \"{}\"",
                       fmt::join(words, " "));
    }
  }

  void open_class(const std::vector<std::string_view>& words) {
    class_line_ = line_;
    ModelClass added;
    added.name = words[0];
    check_name(added.name);
    if (words[1] != "0") {
      if (const auto parent = class_by_name_.find(words[1]); parent != class_by_name_.end()) {
        added.parent = parent->second;
      } else {
        miss_parent(added.name, std::string(words[1]));
      }
    }
    said_in_class_ = parse_count(words[2]);
    if (!said_in_class_) {
      diagnostics_.add(here(), "class {}: the number of models must be a count, got {}", added.name,
                       words[2]);
      miscounted_ = true;
    }
    const int index = static_cast<int>(result_.classes.size());
    twice_ = !class_by_name_.try_emplace(added.name, index).second;
    if (twice_) {
      diagnostics_.add(here(), "class {} stands twice", added.name);
    }
    result_.classes.push_back(std::move(added));
  }

  /// Once for each name, however many classes have it for a parent.
  void miss_parent(const std::string& name, const std::string& parent) {
    if (!missed_parents_.insert(parent).second) return;
    std::vector<std::string_view> known;
    for (const auto& [other, index] : class_by_name_)
      known.emplace_back(other);
    diagnostics_.add(here(), "class {}: the parent must be an earlier class or 0, got {}{}", name,
                     parent, did_you_mean(parent, known));
  }

  /// Names become parts of a path ("vehicle/car") and of folders in exported datasets.
  void check_name(const std::string& name) {
    if (!is_class_path(name) || name.find('/') != name.npos) {
      diagnostics_.add(here(),
                       "a class name must hold no / and no control character and be none of 0 . "
                       ".., got {:?}",
                       name);
    }
  }

  void add_model(const std::string& model) {
    if (result_.classes.empty()) {
      if (!lost_class_) diagnostics_.add(here(), "model {} stands before the first class", model);
      return;
    }
    ModelClass& owner = result_.classes.back();
    const auto [first, is_new] = seen_.try_emplace(model, owner.name, line_);
    if (!is_new && !(twice_ && first->second.first == owner.name)) {
      diagnostics_.add(here(), "model {} stands in class {} and already in class {} (line {})",
                       model, owner.name, first->second.first, first->second.second);
    }
    owner.models.push_back(model);
    owner.model_lines.push_back(line_);
    ++result_.model_count;
  }

  void close_class() {
    if (result_.classes.empty() || !said_in_class_) return;
    const ModelClass& done = result_.classes.back();
    if (done.models.size() != static_cast<std::size_t>(*said_in_class_)) {
      diagnostics_.add({result_.file, class_line_, 0},
                       "class {} must hold {} models as it says, found {}", done.name,
                       *said_in_class_, done.models.size());
      miscounted_ = true;
    }
  }

  void check_totals() {
    if (totals_line_ == 0) {
      diagnostics_.add({result_.file, 0, 0},
                       "must start with \"PSB 1\" and the number of classes and models, found "
                       "the end of the file");
      return;
    }
    const SourcePlace place{result_.file, totals_line_, 0};
    if (!lost_class_ && said_classes_ &&
        *said_classes_ != static_cast<int>(result_.classes.size())) {
      diagnostics_.add(place, "must hold {} classes as it says, found {}", *said_classes_,
                       result_.classes.size());
    }
    // The sum of what is miscounted is no finding of its own.
    if (!miscounted_ && said_models_ && *said_models_ != result_.model_count) {
      diagnostics_.add(place, "must hold {} models as it says, found {}", *said_models_,
                       result_.model_count);
    }
  }

  Classification result_;
  Diagnostics diagnostics_;
  int line_ = 0;
  bool magic_seen_ = false;
  int totals_line_ = 0;  // 0: not read yet
  std::optional<int> said_classes_, said_models_;
  bool miscounted_ = false;  // a class of its own count, or unknown
  bool lost_class_ = false;  // a line that may have been a class
  bool twice_ = false;       // the class that is read has a name that is taken
  std::set<std::string> missed_parents_;
  int class_line_ = 0;
  std::optional<int> said_in_class_;
  std::map<std::string, int, std::less<>> class_by_name_;
  std::map<std::string, std::pair<std::string, int>> seen_;  // model -> class and line
};

bool has_control(std::string_view text) {
  return std::any_of(text.begin(), text.end(),
                     [](char c) { return static_cast<unsigned char>(c) < ' ' || c == '\x7f'; });
}

bool all_digits(std::string_view text) {
  return !text.empty() && text.find_first_not_of("0123456789") == text.npos;
}

void check_disjoint(const Classification& train, const Classification& test) {
  std::map<std::string_view, int> lines;
  for (const ModelClass& c : train.classes) {
    for (std::size_t i = 0; i < c.models.size(); ++i)
      lines.emplace(c.models[i], c.model_lines[i]);
  }
  std::size_t found = 0;
  SourcePlace place;
  std::string first;
  for (const ModelClass& c : test.classes) {
    for (std::size_t i = 0; i < c.models.size(); ++i) {
      const auto other = lines.find(c.models[i]);
      if (other == lines.end() || ++found > 1) continue;
      place = {test.file, c.model_lines[i], 0};
      first = fmt::format("model {} must not be in train and test, found in {}:{} too", c.models[i],
                          train.file, other->second);
    }
  }
  if (found == 0) return;
  // One file given for both says it of every model.
  const std::string more = found > 1 ? fmt::format("; and {} more models", found - 1) : "";
  fail(ErrorKind::asset, "{}: {}{}", to_string(place), first, more);
}

}  // namespace

std::string_view split_named(std::string_view name) {
  std::string lower(name);
  std::transform(lower.begin(), lower.end(), lower.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  for (const auto& [called, split] : k_split_names)
    if (lower == called) return split;
  return "";
}

std::string split_names_text() {
  std::string text;
  for (const auto& [called, split] : k_split_names)
    text += fmt::format("{}{}", text.empty() ? "" : ", ", called);
  return text.replace(text.rfind(", "), 2, " or ");
}

bool is_class_path(std::string_view path) {
  if (path.empty()) return true;
  for (;;) {
    const std::string_view part = path.substr(0, path.find('/'));
    if (part.empty() || part == "0" || part == "." || part == ".." || has_control(part))
      return false;
    if (part.size() == path.size()) return true;
    path.remove_prefix(part.size() + 1);
  }
}

std::string Classification::path(int class_index) const {
  std::string path;
  for (int i = class_index; i >= 0; i = classes[static_cast<std::size_t>(i)].parent) {
    const std::string& name = classes.at(static_cast<std::size_t>(i)).name;
    path.insert(0, path.empty() ? name : name + "/");
  }
  return path;
}

int Classification::leaf_count() const {
  return static_cast<int>(std::count_if(classes.begin(), classes.end(),
                                        [](const ModelClass& c) { return !c.models.empty(); }));
}

Classification parse_classification(std::string_view text, const std::string& name) {
  return Parser(name).parse(text);
}

Classification read_classification(const std::filesystem::path& file) {
  return parse_classification(read_text_file(file), file.string());
}

std::vector<LabelledModel> labelled_models(const Classification& from, const std::string& split) {
  std::vector<LabelledModel> models;
  for (std::size_t i = 0; i < from.classes.size(); ++i) {
    const std::string path = from.path(static_cast<int>(i));
    const ModelClass& owner = from.classes[i];
    for (std::size_t m = 0; m < owner.models.size(); ++m)
      models.push_back({owner.models[m], {path, split}, {from.file, owner.model_lines[m], 0}});
  }
  return models;
}

Labels::Labels(const std::optional<Classification>& train,
               const std::optional<Classification>& test) {
  if (train && test) check_disjoint(*train, *test);
  if (train) add(labelled_models(*train, "train"));
  if (test) add(labelled_models(*test, "test"));
}

Labels::Labels(const std::vector<LabelledModel>& models) {
  add(models);
}

bool Labels::has_splits() const {
  return std::any_of(sorted_.begin(), sorted_.end(),
                     [](const auto& entry) { return !entry.label.split.empty(); });
}

std::vector<std::string> Labels::class_paths() const {
  std::set<std::string> paths;
  for (const LabelledModel& entry : sorted_)
    for (std::string path = entry.label.class_path; !path.empty() && paths.insert(path).second;)
      path.resize(path.rfind('/') == path.npos ? 0 : path.rfind('/'));
  return {paths.begin(), paths.end()};
}

void Labels::add(const std::vector<LabelledModel>& models) {
  sorted_.insert(sorted_.end(), models.begin(), models.end());
  std::sort(sorted_.begin(), sorted_.end(),
            [](const auto& a, const auto& b) { return a.model < b.model; });
}

std::optional<std::size_t> Labels::index_of(std::string_view key) const {
  const auto at =
      std::lower_bound(sorted_.begin(), sorted_.end(), key,
                       [](const auto& entry, std::string_view k) { return entry.model < k; });
  if (at == sorted_.end() || at->model != key) return std::nullopt;
  return static_cast<std::size_t>(at - sorted_.begin());
}

std::vector<std::size_t> Labels::find_all(std::string_view model_name) const {
  std::vector<std::size_t> found;
  const auto add = [&](std::string_view key) {
    const auto index = index_of(key);
    if (index && std::find(found.begin(), found.end(), *index) == found.end())
      found.push_back(*index);
  };
  const std::string_view file = model_name.substr(model_name.rfind('/') + 1);  // npos + 1 is 0
  const std::string_view stem = file.substr(0, file.rfind('.'));
  add(model_name);
  add(model_name.substr(0, model_name.size() - file.size() + stem.size()));
  add(file);
  add(stem);
  if (stem.starts_with('m') && all_digits(stem.substr(1))) add(stem.substr(1));
  return found;
}

std::optional<std::size_t> Labels::find_index(std::string_view model_name) const {
  const std::vector<std::size_t> found = find_all(model_name);
  return found.empty() ? std::nullopt : std::optional(found.front());
}

std::optional<ModelLabel> Labels::find(std::string_view model_name) const {
  const auto index = find_index(model_name);
  return index ? std::optional(label(*index)) : std::nullopt;
}

UnsharedClasses unshared_classes(const std::optional<Classification>& train,
                                 const std::optional<Classification>& test) {
  if (!train || !test) return {};
  const auto with_models = [](const Classification& from) {
    std::set<std::string> paths;
    for (std::size_t i = 0; i < from.classes.size(); ++i)
      if (!from.classes[i].models.empty()) paths.insert(from.path(static_cast<int>(i)));
    return paths;
  };
  const std::set<std::string> in_train = with_models(*train), in_test = with_models(*test);
  UnsharedClasses unshared;
  for (const std::string& path : in_train)
    if (!in_test.contains(path)) unshared.classes.push_back(path + " (train)");
  unshared.of = in_train.size();
  for (const std::string& path : in_test) {
    if (in_train.contains(path)) continue;
    unshared.classes.push_back(path + " (test)");
    ++unshared.of;
  }
  std::sort(unshared.classes.begin(), unshared.classes.end());
  return unshared;
}

std::vector<std::string> class_paths(const std::optional<Classification>& train,
                                     const std::optional<Classification>& test) {
  std::vector<std::string> paths;
  for (const auto* from : {&train, &test}) {
    if (!*from) continue;
    for (std::size_t i = 0; i < (*from)->classes.size(); ++i)
      paths.push_back((*from)->path(static_cast<int>(i)));
  }
  std::sort(paths.begin(), paths.end());
  paths.erase(std::unique(paths.begin(), paths.end()), paths.end());
  return paths;
}

}  // namespace ds
