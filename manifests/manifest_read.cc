// SPDX-License-Identifier: Apache-2.0
#include "manifests/film_facts.h"
#include "manifests/json_text.h"
#include "manifests/manifest.h"
#include "tracer/base/error.h"
#include "tracer/base/files.h"

#include <algorithm>
#include <limits>
#include <optional>

namespace ds {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

/// Takes the fields out of one JSON object; a missing one or one of another type is a finding and
/// leaves the default.
class Fields {
 public:
  Fields(const json& object, SourcePlace place, Diagnostics& diagnostics)
      : object_(object), place_(std::move(place)), diagnostics_(diagnostics) {}

  const json* find(const char* name) {
    if (const auto at = object_.find(name); at != object_.end()) return &*at;
    diagnostics_.add(place_, "{} must be there", name);
    return nullptr;
  }
  void text(const char* name, std::string& to) {
    const json* value = find(name);
    if (value == nullptr) return;
    if (value->is_string()) {
      to = value->get<std::string>();
    } else {
      wrong(name, "a text", *value);
    }
  }
  template <typename T>
  void count(const char* name, T& to) {
    const json* value = find(name);
    if (value == nullptr) return;
    if (value->is_number_unsigned() &&
        value->get<std::uint64_t>() <= std::uint64_t(std::numeric_limits<T>::max())) {
      to = value->get<T>();
    } else {
      wrong(name, "a count", *value);
    }
  }
  void number(const char* name, double& to) {
    const json* value = find(name);
    if (value == nullptr) return;
    if (value->is_number()) {
      to = value->get<double>();
    } else {
      wrong(name, "a number", *value);
    }
  }
  void optional_number(const char* name, std::optional<double>& to) {
    const json* value = find(name);
    if (value == nullptr || value->is_null()) return;
    to.emplace();
    number(name, *to);
  }
  /// An object that an older dsbuild wrote none of.
  template <typename T>
  void object(const char* name, T& to, T (*read)(const json&)) {
    const auto at = object_.find(name);
    if (at == object_.end()) return;
    try {
      to = read(*at);
    } catch (const Error& error) {
      diagnostics_.add(place_, "{}", error.what());
    }
  }
  void hash(const char* name, Hash128& to) {
    std::string hex;
    text(name, hex);
    if (const auto hash = Hash128::from_hex(hex)) {
      to = *hash;
    } else if (!hex.empty()) {
      wrong(name, "32 hexadecimal digits", hex);
    }
  }
  template <std::size_t N>
  void matrix(const char* name, std::size_t columns, std::array<double, N>& to) {
    const json* value = find(name);
    if (value == nullptr) return;
    if (!is_matrix(*value, N / columns, columns)) {
      wrong(name, "rows of numbers", *value);
      return;
    }
    for (std::size_t i = 0; i < N; ++i)
      to[i] = (*value)[i / columns][i % columns].get<double>();
  }
  void wrong(const char* name, const char* wanted, const json& found) {
    diagnostics_.add(place_, "{} must be {}, got {}", name, wanted,
                     found.dump(-1, ' ', false, json::error_handler_t::replace));
  }

 private:
  static bool is_matrix(const json& value, std::size_t rows, std::size_t columns) {
    return value.is_array() && value.size() == rows &&
           std::all_of(value.begin(), value.end(), [&](const json& row) {
             return row.is_array() && row.size() == columns &&
                    std::all_of(row.begin(), row.end(),
                                [](const json& v) { return v.is_number(); });
           });
  }

  const json& object_;
  SourcePlace place_;
  Diagnostics& diagnostics_;
};

/// Nothing (and a finding) where the text is no JSON object.
std::optional<json> parse_object(const std::string& text, const SourcePlace& place,
                                 Diagnostics& diagnostics) {
  // No field is nested this deeply; what is gets dropped, since printing it in a finding would
  // recurse.
  const auto shallow = [](int depth, json::parse_event_t, json&) { return depth <= 32; };
  try {
    json value = json::parse(text, shallow);
    if (value.is_object()) return value;
    diagnostics.add(place, "must be a JSON object, got {}", value.type_name());
  } catch (const json::exception& error) {
    diagnostics.add(place, "must be a JSON object: {}", json_fault(error));
  }
  return std::nullopt;
}

std::vector<FileRecord> files_from(const json& values, const SourcePlace& place,
                                   Diagnostics& diagnostics) {
  std::vector<FileRecord> files;
  for (const json& value : values) {
    Fields fields(value, place, diagnostics);
    if (!value.is_object()) {
      fields.wrong("files", "objects", value);
      continue;
    }
    FileRecord& file = files.emplace_back();
    fields.text("path", file.path);
    fields.text("kind", file.kind);
    fields.count("size_bytes", file.hashes.size_bytes);
    fields.hash("xxh128", file.hashes.xxh128);
    fields.text("sha256", file.hashes.sha256);
    fields.hash("pixels_xxh128", file.pixels);
  }
  return files;
}

/// An object whose members are all of one kind, into a list of pairs.
template <typename T, typename Read>
void read_members(Fields& fields, const json& owner, const SourcePlace& place,
                  Diagnostics& diagnostics, const char* name,
                  std::vector<std::pair<std::string, T>>& to, Read read) {
  if (fields.find(name) == nullptr) return;
  const json& value = owner[name];
  if (!value.is_object()) {
    fields.wrong(name, "an object", value);
    return;
  }
  Fields members(value, place, diagnostics);
  for (const auto& [key, member] : value.items()) {
    to.emplace_back(key, T{});
    read(members, key.c_str(), to.back().second);
  }
}

void read_texts(Fields& fields, const char* name, std::vector<std::string>& to) {
  const json* list = fields.find(name);
  if (list == nullptr) return;
  const bool texts = list->is_array() && std::all_of(list->begin(), list->end(),
                                                     [](const json& p) { return p.is_string(); });
  if (texts) {
    to = list->get<std::vector<std::string>>();
  } else {
    fields.wrong(name, "a list of texts", *list);
  }
}

/// What an older dsbuild wrote none of.
void read_pose(Fields& fields, const json& object, std::optional<ModelPose>& to) {
  if (!object.contains("model_to_world")) return;
  ModelPose& pose = to.emplace();
  fields.matrix("model_to_world", 4, pose.model_to_world);
  std::array<double, 6> box{};
  fields.matrix("model_box", 3, box);
  pose.model_box = {{box[0], box[1], box[2]}, {box[3], box[4], box[5]}};
}

/// Not there where an image shows its model alone.
void read_objects(const json& owner, const SourcePlace& place, Diagnostics& diagnostics,
                  std::vector<ObjectRecord>& to) {
  const auto list = owner.find("objects");
  if (list == owner.end()) return;
  Fields fields(owner, place, diagnostics);
  if (!list->is_array()) return fields.wrong("objects", "a list", *list);
  for (const json& value : *list) {
    if (!value.is_object()) return fields.wrong("objects", "objects", value);
    ObjectRecord& object = to.emplace_back();
    Fields members(value, place, diagnostics);
    members.count("id", object.id);
    members.text("model", object.model);
    members.text("class_path", object.class_path);
    if (const auto id = value.find("class_id"); id != value.end() && !id->is_null())
      members.count("class_id", object.class_id.emplace());
    members.text("material", object.material);
    std::optional<ModelPose> pose;
    if (members.find("model_to_world") != nullptr) read_pose(members, value, pose);
    object.pose = pose.value_or(ModelPose{});
    if (value.contains("truncation")) members.optional_number("truncation", object.truncation);
    const auto pixels = value.find("pixels");
    if (pixels == value.end()) continue;
    try {
      object.pixels = object_counts_from(*pixels, object.id);
    } catch (const Error& error) {
      diagnostics.add(place, "objects: {}", error.what());
    }
  }
}

void read_parts(const json& value, const SourcePlace& place, Diagnostics& diagnostics,
                ImageRecord& image) {
  Fields parts(value, place, diagnostics);
  if (!value.is_object()) {
    parts.wrong("parts", "an object", value);
    return;
  }
  static constexpr std::array k_names{"model", "material", "environment", "camera", "engine"};
  for (std::size_t i = 0; i < k_names.size(); ++i)
    parts.hash(k_names[i], image.parts[i]);
}

ImageRecord image_from(const std::string& line, const SourcePlace& place,
                       Diagnostics& diagnostics) {
  ImageRecord image;
  const auto object = parse_object(line, place, diagnostics);
  if (!object) return image;
  Fields fields(*object, place, diagnostics);
  fields.text("id", image.id);
  fields.text("model", image.model);
  fields.text("class_path", image.class_path);
  fields.text("split", image.split);
  if (const auto id = object->find("class_id"); id != object->end() && !id->is_null())
    fields.count("class_id", image.class_id.emplace());
  if (object->contains("fold")) fields.count("fold", image.fold.emplace());
  if (object->contains("classes")) {
    std::vector<std::pair<std::string, std::string>> classes;
    read_members(fields, *object, place, diagnostics, "classes", classes,
                 [](Fields& f, const char* name, std::string& to) { f.text(name, to); });
    image.other_classes = {classes.begin(), classes.end()};
  }
  fields.text("material", image.material);
  fields.text("environment", image.environment);
  fields.text("view", image.view);
  fields.object("draws", image.draws, draws_from);
  if (object->contains("draw_attempts"))
    fields.count("draw_attempts", image.draw_attempts.emplace());
  if (const json* files = fields.find("files"))
    image.files = files_from(*files, place, diagnostics);
  fields.count("seed", image.seed);
  fields.count("spp", image.spp);
  fields.count("width", image.width);
  fields.count("height", image.height);
  fields.text("math", image.math);
  if (object->contains("camera_model")) fields.text("camera_model", image.camera_model);
  if (!object->contains("metres_per_pixel"))
    fields.matrix("intrinsics", 3, image.intrinsics.emplace());
  else
    fields.number("metres_per_pixel", image.metres_per_pixel.emplace());
  fields.matrix("camera_to_world", 4, image.camera_to_world);
  fields.number("lens_radius_m", image.lens_radius_m);
  fields.number("focus_distance_m", image.focus_distance_m);
  read_pose(fields, *object, image.pose);
  read_objects(*object, place, diagnostics, image.objects);
  fields.number("tone_map_scale", image.tone_map_scale);
  fields.count("rejected_samples", image.rejected_samples);
  fields.optional_number("relative_error", image.relative_error);
  fields.object("film", image.film, film_facts_from);
  fields.object("pixel_counts", image.pixel_counts, pixel_counts_from);
  fields.hash("render_key", image.render_key);
  fields.hash("files_key", image.files_key);
  if (const json* parts = fields.find("parts")) read_parts(*parts, place, diagnostics, image);
  return image;
}

/// Before format 2: the text once for each asset.
std::vector<LicenceRecord> licences_of_format_1(Fields& fields, const json& owner,
                                                const SourcePlace& place,
                                                Diagnostics& diagnostics) {
  std::vector<std::pair<std::string, std::string>> texts;
  read_members(fields, owner, place, diagnostics, "licences", texts,
               [](Fields& f, const char* name, std::string& to) { f.text(name, to); });
  return group_licences(texts);
}

/// Calls add(members) for each object of a list that may be missing.
template <typename Add>
void read_list(Fields& fields, const char* name, const SourcePlace& place, Diagnostics& diagnostics,
               const Add& add) {
  const json* list = fields.find(name);
  if (list == nullptr) return;
  if (!list->is_array()) return fields.wrong(name, "a list", *list);
  for (const json& value : *list) {
    if (!value.is_object()) {
      fields.wrong(name, "objects", value);
      continue;
    }
    Fields members(value, place, diagnostics);
    add(members);
  }
}

/// A text, or null for none.
void read_text_or_null(Fields& fields, const char* name, std::string& to) {
  if (const json* text = fields.find(name); text != nullptr && !text->is_null())
    fields.text(name, to);
}

std::vector<LicenceRecord> licences_from(Fields& fields, const SourcePlace& place,
                                         Diagnostics& diagnostics) {
  std::vector<LicenceRecord> licences;
  read_list(fields, "licences", place, diagnostics, [&](Fields& members) {
    LicenceRecord& licence = licences.emplace_back();
    read_text_or_null(members, "spdx", licence.spdx);
    members.text("text", licence.text);
    read_texts(members, "assets", licence.assets);
  });
  return licences;
}

std::vector<SourceRecord> sources_from(Fields& fields, const SourcePlace& place,
                                       Diagnostics& diagnostics) {
  std::vector<SourceRecord> sources;
  read_list(fields, "sources", place, diagnostics, [&](Fields& members) {
    SourceRecord& source = sources.emplace_back();
    read_text_or_null(members, "url", source.url);
    members.text("text", source.text);
    read_texts(members, "assets", source.assets);
  });
  return sources;
}

/// Not there where no model was mended.
void read_mended_models(const json& owner, const SourcePlace& place, Diagnostics& diagnostics,
                        DatasetRecord& dataset) {
  if (!owner.contains("mended_models")) return;
  Fields fields(owner, place, diagnostics);
  read_members(fields, owner, place, diagnostics, "mended_models", dataset.mended_models,
               [&](Fields& models, const char* model, MendedDamage& to) {
                 read_members(
                     models, owner["mended_models"], place, diagnostics, model, to,
                     [](Fields& f, const char* name, std::uint64_t& n) { f.count(name, n); });
               });
}

/// Not there where images have no plane, or an older dsbuild wrote the manifest.
void read_planes(const json& owner, const SourcePlace& place, Diagnostics& diagnostics,
                 DatasetRecord& dataset) {
  if (!owner.contains("planes")) return;
  Fields fields(owner, place, diagnostics);
  read_members(fields, owner, place, diagnostics, "planes", dataset.planes,
               [&](Fields& planes, const char* name, PlaneRecord& to) {
                 const json* plane = planes.find(name);
                 if (plane == nullptr || !plane->is_object()) return;
                 Fields members(*plane, place, diagnostics);
                 members.text("encoding", to.encoding);
                 members.text("convention", to.convention);
               });
}

/// Not there where an older dsbuild wrote the manifest; kinds that this one does not know are left
/// out.
void read_concerns(const json& owner, const SourcePlace& place, Diagnostics& diagnostics,
                   std::vector<Concern>& to) {
  const auto all = owner.find("concerns");
  if (all == owner.end()) return;
  if (!all->is_object()) {
    diagnostics.add(place, "concerns must be an object, got {}", all->type_name());
    return;
  }
  to = no_concerns();
  for (Concern& concern : to) {
    const auto one = all->find(concern.name);
    if (one == all->end()) continue;
    if (!one->is_object()) {
      diagnostics.add(place, "concerns.{} must be an object, got {}", concern.name,
                      one->type_name());
      continue;
    }
    Fields members(*one, place, diagnostics);
    members.count("count", concern.count);
    members.count("of", concern.of);
    read_texts(members, "examples", concern.examples);
  }
}

std::string read_manifest_file(const fs::path& file) {
  std::error_code error;
  if (!fs::is_regular_file(file, error)) {
    // FOLDER/manifest/FILE: where not even the folder between is there, no dataset is meant.
    const fs::path folder = file.parent_path().parent_path();
    const bool is_dataset = fs::is_directory(file.parent_path(), error) ||
                            fs::exists(folder / ".dsbuild" / "dataset", error);
    if (!is_dataset)
      fail(ErrorKind::usage, "{}: wanted the folder of a dataset, found {}", folder.string(),
           fs::exists(folder, error) ? "one without manifest/" + file.filename().string()
                                     : "nothing there");
    fail(ErrorKind::asset, "{}: must be there: a dataset has a manifest", file.string());
  }
  return read_text_file(file);
}

}  // namespace

ImageRecord image_from_json_line(const std::string& line, const std::string& file,
                                 int line_number) {
  Diagnostics diagnostics(ErrorKind::asset);
  ImageRecord image = image_from(line, {file, line_number, 0}, diagnostics);
  diagnostics.throw_if_any();
  return image;
}

DatasetRecord dataset_from_json(const std::string& text, const std::string& file) {
  Diagnostics diagnostics(ErrorKind::asset);
  const SourcePlace place{file, 0, 0};
  DatasetRecord dataset;
  if (const auto object = parse_object(text, place, diagnostics)) {
    Fields fields(*object, place, diagnostics);
    int format = 0;
    fields.count("format", format);
    if (format != 0 && format != 1 && format != k_manifest_format)
      fields.wrong("format", "1 or 2", format);
    fields.text("name", dataset.name);
    fields.text("licence", dataset.licence);
    fields.text("recipe", dataset.recipe_text);
    fields.text("dsbuild_version", dataset.dsbuild_version);
    fields.count("seed", dataset.seed);
    read_texts(fields, "class_paths", dataset.class_paths);
    if (object->contains("about")) {
      std::vector<std::pair<std::string, std::string>> about;
      read_members(fields, *object, place, diagnostics, "about", about,
                   [](Fields& f, const char* name, std::string& to) { f.text(name, to); });
      dataset.about = {about.begin(), about.end()};
    }
    if (object->contains("shapes")) {
      std::vector<std::pair<std::string, std::string>> shapes;
      read_members(fields, *object, place, diagnostics, "shapes", shapes,
                   [](Fields& f, const char* name, std::string& to) { f.text(name, to); });
      dataset.shapes = {shapes.begin(), shapes.end()};
    }
    if (object->contains("own_materials")) {
      std::vector<std::pair<std::string, std::vector<std::string>>> own;
      read_members(fields, *object, place, diagnostics, "own_materials", own, read_texts);
      dataset.own_materials = {own.begin(), own.end()};
    }
    if (object->contains("hierarchies")) {
      std::vector<std::pair<std::string, std::vector<std::string>>> hierarchies;
      read_members(fields, *object, place, diagnostics, "hierarchies", hierarchies, read_texts);
      dataset.hierarchies = {hierarchies.begin(), hierarchies.end()};
    }
    read_members(fields, *object, place, diagnostics, "counts", dataset.counts,
                 [](Fields& f, const char* name, std::uint64_t& to) { f.count(name, to); });
    dataset.licences = format == 1 ? licences_of_format_1(fields, *object, place, diagnostics)
                                   : licences_from(fields, place, diagnostics);
    if (object->contains("sources")) dataset.sources = sources_from(fields, place, diagnostics);
    fields.object("draws", dataset.draws, draw_summaries_from);
    read_planes(*object, place, diagnostics, dataset);
    read_mended_models(*object, place, diagnostics, dataset);
    read_concerns(*object, place, diagnostics, dataset.concerns);
  }
  diagnostics.throw_if_any();
  return dataset;
}

std::vector<ImageRecord> read_images_manifest(const fs::path& folder) {
  const fs::path file = folder / "manifest/images.jsonl";
  const std::string text = read_manifest_file(file);
  Diagnostics diagnostics(ErrorKind::asset);
  std::vector<ImageRecord> images;
  int line_number = 0;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = text.find('\n', at);
    const SourcePlace place{file.string(), ++line_number, 0};
    if (end == text.npos) diagnostics.add(place, "must end in a line break: the file is cut off");
    images.push_back(image_from(text.substr(at, end - at), place, diagnostics));
    at = end == text.npos ? text.size() : end + 1;
  }
  diagnostics.throw_if_any();
  return images;
}

DatasetRecord read_dataset_manifest(const fs::path& folder) {
  const fs::path file = folder / "manifest/dataset.json";
  return dataset_from_json(read_manifest_file(file), file.string());
}

}  // namespace ds
