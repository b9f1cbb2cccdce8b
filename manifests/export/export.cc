// SPDX-License-Identifier: Apache-2.0
// Two passes over the manifest: the first sees which images go out under which names, the second hands
// them to the exporter one after the other.
#include "manifests/export/export.h"

#include "manifests/export/card.h"
#include "manifests/export/exporter.h"
#include "manifests/json_text.h"
#include "manifests/manifest_glance.h"
#include "manifests/shown_assets.h"
#include "tracer/base/error.h"
#include "tracer/base/files.h"
#include "tracer/base/hash_stream.h"
#include "tracer/base/nearest.h"
#include "tracer/base/regular_file.h"

#include <algorithm>
#include <array>
#include <set>
#include <string_view>

namespace ds {
namespace {

namespace fs = std::filesystem;

constexpr const char* k_images = "manifest/images.jsonl";
constexpr std::array<std::string_view, 6> k_filter_keys{"class",       "model", "material",
                                                        "environment", "view",  "fold"};

std::string value_of(const ImageRecord& image, std::string_view key) {
  if (key == "class") return image.class_path;
  if (key == "model") return image.model;
  if (key == "material") return image.material;
  if (key == "environment") return image.environment;
  if (key == "view") return image.view;
  return image.fold ? std::to_string(*image.fold) : "";
}

/// The class itself or one above it, the model with or without its ending.
bool matches_value(const ImageRecord& image, std::string_view key, std::string_view pattern) {
  const std::string value = value_of(image, key);
  if (matches_pattern(value, pattern)) return true;
  if (key == "model") return matches_pattern(value.substr(0, value.rfind('.')), pattern);
  if (key != "class") return false;
  for (std::size_t at = value.find('/'); at != value.npos; at = value.find('/', at + 1))
    if (matches_pattern(value.substr(0, at), pattern)) return true;
  return false;
}

/// Every image of the manifest, a line at a time.
template <typename Visit>
void visit_images(const fs::path& folder, const Visit& visit) {
  const fs::path file = folder / k_images;
  std::ifstream lines = regular_stream(file);
  if (!lines) fail(ErrorKind::io, "{}: cannot be read", file.string());
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number)
    visit(image_from_json_line(line, file.string(), number));
}

/// Labels, poses and splits stand in the manifest alone: what was edited there is not to be handed on.
void check_manifest(const fs::path& folder) {
  constexpr const char* k_sums = "manifest/checksums.xxh128";
  const std::map<std::string, Hash128> sums = read_checksum_file(folder / k_sums);
  for (const char* file : {k_images, "manifest/dataset.json"})
    if (!sums.contains(file) || content_hash(folder / file) != sums.at(file))
      fail(
          ErrorKind::asset,
          "{}: is not what {} says, as after an edit, or while a build is under way; dsbuild build "
          "writes it again, dsbuild verify tells more",
          (folder / file).string(), k_sums);
}

class Export {
 public:
  explicit Export(const ExportRequest& request) : request_(request) { check_request(); }
  ExportResult run(const std::function<void(std::uint64_t, std::uint64_t)>& progress,
                   const std::atomic<bool>& stop);

 private:
  void check_request();
  void choose_classes();
  /// Every image, of the classes that were asked for.
  template <typename Visit>
  void visit(const Visit& visit) const {
    visit_images(request_.folder, [&](ImageRecord&& image) {
      if (!request_.classes.empty()) image.class_path = image.other_classes[request_.classes];
      visit(std::move(image));
    });
  }
  /// Why the image is not exported; "" where it is.
  std::string left_out(const ImageRecord& image) const;
  /// "train" where the dataset knows no splits: what readers take a dataset without any for.
  std::string split_of(const ImageRecord& image) const;
  void look();
  std::string values_of_filters() const;
  void check_found() const;
  /// Notes the model, so that keys of all images are known to differ.
  void add_key(const ImageRecord& image);
  void find_shared_names();
  std::string key_of(const ImageRecord& image) const;
  /// Says which of the dataset's files the format has no place for.
  void note_kinds(ExportFolder& to) const;
  std::string record(const ExportFolder& to) const;

  const ExportRequest& request_;
  const ExporterType* type_ = nullptr;
  ExportInput input_;
  bool has_classes_ = false, has_splits_ = false;
  std::map<std::string, int> labels_;          ///< index of input_.classes
  std::set<std::string> splits_;               ///< of all images
  std::map<std::string, std::string> models_;  ///< by what their images' keys begin with
  std::set<std::string> shared_stems_;         ///< of several models
  std::set<std::string> shared_names_;         ///< models of one name, though with their endings
  AssetNames licensed_, sourced_;
  std::set<std::string> unlicensed_, unsourced_;
  std::uint64_t objects_ = 0;  ///< that images show beside their models
  ExportResult result_;
};

void Export::check_request() {
  type_ = find_exporter(request_.format);
  if (type_ == nullptr) {
    std::vector<std::string_view> known;
    for (const ExporterType& type : exporter_types())
      known.emplace_back(type.name);
    fail(ErrorKind::usage, "--format: wanted {}, got {}{}",
         fmt::format("{}", fmt::join(known, ", ")), request_.format,
         did_you_mean(request_.format, known));
  }
  for (const auto& [key, pattern] : request_.filters)
    if (std::find(k_filter_keys.begin(), k_filter_keys.end(), key) == k_filter_keys.end())
      fail(ErrorKind::usage, "--filter {}={}: wanted one of {}, got {}{}", key, pattern,
           fmt::format("{}", fmt::join(k_filter_keys, ", ")), key,
           did_you_mean(key, {k_filter_keys.begin(), k_filter_keys.end()}));
}

std::string Export::left_out(const ImageRecord& image) const {
  for (const std::string_view key : k_filter_keys) {
    bool named = false, matches = false;
    for (const auto& [wanted, pattern] : request_.filters)
      if (wanted == key) {
        named = true;
        matches = matches || matches_value(image, key, pattern);
      }
    if (named && !matches) return "filter";
  }
  if (type_->needs_labels && has_classes_ && image.class_path.empty()) return "unclassified";
  if (!has_splits_) return "";
  if (image.split.empty())
    return type_->needs_labels || !request_.splits.empty() ? "unclassified" : "";
  const auto& wanted = request_.splits;
  return wanted.empty() || std::find(wanted.begin(), wanted.end(), image.split) != wanted.end()
             ? ""
             : "split";
}

std::string Export::split_of(const ImageRecord& image) const {
  return has_splits_ ? image.split : "train";
}

/// A split names files and folders.
void check_split(const ImageRecord& image) {
  const bool known = image.split.empty() || image.split == "train" || image.split == "val" ||
                     image.split == "test";
  if (!known)
    fail(ErrorKind::asset, "the image {}: wanted the split train, val, test or none, got {:?}",
         image.id, image.split);
}

void Export::choose_classes() {
  const std::string& name = request_.classes;
  std::vector<std::string> classes = input_.dataset.class_paths;
  if (!name.empty()) {
    const auto& known = input_.dataset.hierarchies;
    const auto at = known.find(name);
    if (at == known.end()) {
      std::vector<std::string_view> names;
      for (const auto& [other, paths] : known)
        names.emplace_back(other);
      fail(ErrorKind::usage, "--classes: wanted {}, got {}{}",
           names.empty() ? "none, the recipe has no classes.more"
                         : fmt::format("{}", fmt::join(names, " or ")),
           name, did_you_mean(name, names));
    }
    classes = at->second;
  }
  has_classes_ = !classes.empty();
  input_.has_classes = has_classes_;
  input_.of_hierarchy = !name.empty();
  input_.classes = has_classes_ ? std::move(classes) : std::vector<std::string>{"object"};
  for (const std::string& path : input_.classes)
    labels_.emplace(path, static_cast<int>(labels_.size()));
}

void Export::look() {
  std::error_code error;
  if (!fs::is_regular_file(request_.folder / k_images, error))
    fail(ErrorKind::usage,
         "{}: wanted the folder of a dataset that dsbuild built, found no {} in it",
         request_.folder.string(), k_images);
  check_manifest(request_.folder);
  input_.folder = request_.folder;
  input_.mesh = request_.mesh;
  input_.object_mesh = request_.object_mesh;
  input_.dataset = read_dataset_manifest(request_.folder);
  choose_classes();
  visit([&](const ImageRecord& image) {
    check_split(image);
    if (!image.split.empty()) splits_.insert(image.split);
  });
  has_splits_ = !splits_.empty();
  for (const LicenceRecord& licence : input_.dataset.licences)
    licensed_.add(licence.assets);
  for (const SourceRecord& source : input_.dataset.sources)
    sourced_.add(source.assets);
  for (const std::string& split : request_.splits)
    if (!splits_.contains(split))
      fail(ErrorKind::usage, "--split: wanted {}, got {}",
           has_splits_ ? fmt::format("{}", fmt::join(splits_, " or "))
                       : "none, the dataset has no splits",
           split);
  std::optional<std::vector<std::string>> kinds;
  visit([&](const ImageRecord& image) {
    if (const std::string why = left_out(image); !why.empty()) {
      ++result_.left_out[why];
      return;
    }
    ++result_.images;
    ++input_.splits[split_of(image)];
    ++input_.counts[image.class_path][split_of(image)];
    const std::string size = fmt::format("{} x {}", image.width, image.height);
    objects_ += image.objects.size();
    input_.size = input_.size.empty() || input_.size == size ? size : "of several sizes";
    for (const std::string& asset : shown_assets(image, input_.dataset)) {
      if (!licensed_.has(asset)) unlicensed_.insert(asset);
      if (!sourced_.has(asset)) unsourced_.insert(asset);
    }
    add_key(image);
    std::vector<std::string> own;
    for (const FileRecord& file : image.files)
      if (!kinds || std::find(kinds->begin(), kinds->end(), file.kind) != kinds->end())
        own.push_back(file.kind);
    kinds = own;
  });
  input_.unlicensed.assign(unlicensed_.begin(), unlicensed_.end());
  input_.unsourced.assign(unsourced_.begin(), unsourced_.end());
  input_.left_out = result_.left_out;
  for (const auto& [key, pattern] : request_.filters)
    input_.filters.push_back(fmt::format("{}={}", key, pattern));
  for (const std::string& split : request_.splits)
    input_.filters.push_back("split=" + split);
  input_.kinds = kinds.value_or(std::vector<std::string>{});
  result_.splits = input_.splits;
}

/// "; class is one of car, mug", of the keys that were filtered by.
std::string Export::values_of_filters() const {
  constexpr std::size_t k_most = 8;
  std::string text;
  for (const std::string_view key : k_filter_keys) {
    if (std::none_of(request_.filters.begin(), request_.filters.end(),
                     [&](const auto& filter) { return filter.first == key; }))
      continue;
    std::set<std::string> values;
    visit([&](const ImageRecord& image) { values.emplace(value_of(image, key)); });
    const std::size_t count = values.size();
    while (values.size() > k_most)
      values.erase(std::prev(values.end()));
    text += fmt::format("; {} is one of {}{}", key, fmt::join(values, ", "),
                        count > k_most ? fmt::format(" and {} more", count - k_most) : "");
  }
  return text;
}

/// The keys of a recipe whose images have these kinds of files.
std::string keys_for(const std::vector<const char*>& kinds) {
  std::vector<std::string> keys, planes;
  for (const std::string_view kind : kinds)
    if (kind == "image")
      keys.emplace_back("outputs.image = \"png\"");
    else if (kind == "mask")
      keys.emplace_back("outputs.mask = true");
    else
      planes.push_back(fmt::format("\"{}\"", kind));
  if (!planes.empty()) keys.push_back(fmt::format("{} in outputs.planes", fmt::join(planes, ", ")));
  return fmt::format("{}", fmt::join(keys, ", "));
}

void Export::check_found() const {
  if (result_.images == 0) {
    std::string why;
    for (const auto& [what, count] : result_.left_out)
      why += fmt::format("{}{} by {}", why.empty() ? "" : ", ", count, what);
    fail(ErrorKind::usage, "{}: no image to export{}{}", request_.folder.string(),
         why.empty() ? "" : fmt::format(" (left out: {})", why), values_of_filters());
  }
  std::vector<const char*> lacking;
  for (const char* kind : type_->needs)
    if (!input_.has(kind)) lacking.push_back(kind);
  if (!lacking.empty())
    fail(ErrorKind::asset,
         "{}: the format {} needs {} of every image, and the dataset has {}; build it with {}",
         request_.folder.string(), type_->name, fmt::join(type_->needs, ", "),
         input_.kinds.empty() ? "none" : fmt::format("{}", fmt::join(input_.kinds, ", ")),
         keys_for(lacking));
}

void Export::add_key(const ImageRecord& image) {
  const std::string stem = export_key(image.model, image.model, KeyForm::stem);
  const auto [at, is_new] = models_.try_emplace(stem, image.model);
  if (!is_new && at->second != image.model) shared_stems_.insert(stem);
}

/// With their endings names of models may still be one: a "." and a "_" are. These get a hash.
void Export::find_shared_names() {
  std::map<std::string, std::string> models;
  visit([&](const ImageRecord& image) {
    if (!left_out(image).empty()) return;
    const KeyForm form = shared_stems_.contains(export_key(image.model, image.model, KeyForm::stem))
                             ? KeyForm::ending
                             : KeyForm::stem;
    const std::string name = export_key(image.model, image.model, form);
    const auto [at, is_new] = models.try_emplace(name, image.model);
    if (!is_new && at->second != image.model) shared_names_.insert({at->second, image.model});
  });
}

std::string Export::key_of(const ImageRecord& image) const {
  if (shared_names_.contains(image.model)) return export_key(image.id, image.model, KeyForm::hash);
  const bool shared = shared_stems_.contains(export_key(image.model, image.model, KeyForm::stem));
  return export_key(image.id, image.model, shared ? KeyForm::ending : KeyForm::stem);
}

void Export::note_kinds(ExportFolder& to) const {
  if (type_->takes.empty()) return;
  std::vector<std::string> without;
  for (const std::string& kind : input_.kinds)
    if (std::find(type_->takes.begin(), type_->takes.end(), kind) == type_->takes.end() &&
        !(kind == "object_id" && type_->lists_objects && objects_ > 0))
      without.push_back(kind);
  if (!without.empty())
    to.note(fmt::format("{}: left out, the format {} has no place for it", fmt::join(without, ", "),
                        type_->name));
}

std::string Export::record(const ExportFolder& to) const {
  return canonical_json({{"format", type_->name},
                         {"dataset", input_.dataset.name},
                         {"dsbuild_version", input_.dataset.dsbuild_version},
                         {"splits", input_.splits},
                         {"classes", input_.classes},
                         {"hierarchy", request_.classes},
                         {"filters", input_.filters},
                         {"images", result_.images},
                         {"left_out", result_.left_out},
                         {"notes", to.notes()}},
                        2);
}

ExportResult Export::run(const std::function<void(std::uint64_t, std::uint64_t)>& progress,
                         const std::atomic<bool>& stop) {
  look();
  check_found();
  if (!shared_stems_.empty()) find_shared_names();
  ExportFolder to(request_.folder, request_.to, request_.copy);
  const std::unique_ptr<Exporter> exporter = type_->make(input_, to);
  for (const std::string& note : request_.notes)
    to.note(note);
  note_kinds(to);
  if (objects_ > 0 && !type_->lists_objects)
    to.note(
        fmt::format("{} distractors beside the models: left out, the format {} lists models alone",
                    objects_, type_->name));
  std::set<std::string> keys;
  std::uint64_t done = 0;
  visit([&](ImageRecord&& record) {
    if (!left_out(record).empty()) return;
    if (stop) fail(ErrorKind::cancelled, "stopped; nothing is exported");
    ExportImage image{std::move(record), "", "", 0};
    image.key = key_of(image.record);
    if (!keys.insert(image.key).second)
      fail(ErrorKind::asset, "the images {} and another would both be exported as {}",
           image.record.id, image.key);
    image.split = split_of(image.record);
    if (has_classes_ && image.record.class_path.empty()) {
      image.label = -1;
    } else if (has_classes_) {
      const auto at = labels_.find(image.record.class_path);
      if (at == labels_.end())
        fail(ErrorKind::asset,
             "{}: the image {} is of the class {}, which the dataset does not have",
             (request_.folder / "manifest/dataset.json").string(), image.record.id,
             image.record.class_path);
      image.label = at->second;
    }
    exporter->add(image);
    progress(++done, result_.images);
  });
  exporter->finish();
  write_card(input_, *type_, exporter->card_lines(), to);
  to.commit(record(to));
  result_.files = to.files();
  result_.bytes = to.bytes();
  result_.notes = to.notes();
  return result_;
}

}  // namespace

std::string export_key(std::string_view id, std::string_view model, KeyForm form) {
  constexpr std::size_t k_most_bytes = 64;  // more of it stands behind, and tar takes 100
  const std::size_t dot = model.rfind('.');
  const bool has_ending = dot != model.npos && dot > model.rfind('/') + 1;
  std::string key(has_ending && form == KeyForm::stem ? model.substr(0, dot) : model);
  if (form == KeyForm::hash || key.size() > k_most_bytes) {
    std::size_t end = std::min(key.size(), k_most_bytes - 9);
    while (end > 0 && end < key.size() && (static_cast<unsigned char>(key[end]) & 0xc0U) == 0x80)
      --end;  // no character is torn
    key = fmt::format("{}_{}", key.substr(0, end), hash_text(model).hex().substr(0, 8));
  }
  key += id.substr(std::min(id.size(), model.size()));
  for (char& c : key) {
    const auto code = static_cast<unsigned char>(c);
    if (c == '/')
      c = '-';
    else if (code <= ' ' || code == 0x7f || c == '.' || c == '\\')
      c = '_';
  }
  return key;
}

bool matches_pattern(std::string_view text, std::string_view pattern) {
  std::size_t star = pattern.npos, from = 0, t = 0, p = 0;
  while (t < text.size()) {
    if (p < pattern.size() && pattern[p] == '*') {
      star = p++;
      from = t;
    } else if (p < pattern.size() && (pattern[p] == '?' || pattern[p] == text[t])) {
      ++p;
      ++t;
    } else if (star != pattern.npos) {
      p = star + 1;
      t = ++from;
    } else {
      return false;
    }
  }
  while (p < pattern.size() && pattern[p] == '*')
    ++p;
  return p == pattern.size();
}

ExportResult export_dataset(const ExportRequest& request,
                            const std::function<void(std::uint64_t, std::uint64_t)>& progress,
                            const std::atomic<bool>& stop) {
  return Export(request).run(progress, stop);
}

}  // namespace ds
