// SPDX-License-Identifier: Apache-2.0
#include "manifests/manifest_schema.h"

#include "manifests/film_facts.h"
#include "manifests/manifest.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

namespace ds {
namespace {

using nlohmann::json;

const json k_text{{"type", "string"}};
const json k_count{{"type", "integer"}, {"minimum", 0}};
const json k_number{{"type", "number"}};
const json k_hash{{"type", "string"}, {"pattern", "^[0-9a-f]{32}$"}};

const json k_drawn{{"type", {"number", "array"}}, {"items", k_number}};
const json k_drawn_or_null{{"type", {"number", "array", "null"}}, {"items", k_number}};

json or_null(json schema) {
  schema["type"] = {schema["type"], "null"};
  return schema;
}

json list_of(const json& items, std::size_t count) {
  return {{"type", "array"}, {"items", items}, {"minItems", count}, {"maxItems", count}};
}

json rows(std::size_t count, std::size_t columns) {
  return list_of(list_of(k_number, columns), count);
}

json said(json schema, std::string_view what) {
  schema["description"] = what;
  return schema;
}

/// An object of these fields and no others; `required` names those that are always there.
json object_of(json fields, json required) {
  return {{"type", "object"},
          {"properties", std::move(fields)},
          {"required", std::move(required)},
          {"additionalProperties", false}};
}

json map_of(const json& values) {
  return {{"type", "object"}, {"additionalProperties", values}};
}

json schema_of_value(const json& value) {
  if (value.is_boolean()) return {{"type", "boolean"}};
  if (value.is_number_integer()) return k_count;
  return value.is_null() ? or_null(k_number) : k_number;
}

/// Its fields are those that an empty one is written with.
json film_schema() {
  const json empty = to_json_value(FilmFacts{});
  json fields = json::object(), required = json::array();
  for (const auto& [name, value] : empty.items()) {
    fields[name] = schema_of_value(value);
    required.push_back(name);
  }
  return object_of(std::move(fields), std::move(required));
}

json counts_schema() {
  PixelCounts all;
  all.lit = all.white = all.model = all.frame = all.amodal = 0;
  all.left = all.right = all.above = all.below = all.beyond = all.whole = 0;
  const json counts = to_json_value(all);
  json fields = json::object();
  for (const auto& [name, value] : counts.items())
    fields[name] = k_count;
  return object_of(std::move(fields), json::array());
}

json pose_schema() {
  return {
      {"model_to_world", said(rows(4, 4), "the model file's coordinates to the world, with scale")},
      {"model_to_camera",
       object_of({{"opencv", rows(4, 4)}, {"opengl", rows(4, 4)}}, {"opencv", "opengl"})},
      {"model_box", said(rows(2, 3), "least and greatest of the model file's coordinates")},
      {"box_m", said(rows(2, 3), "around its corners in the world, metres")}};
}

json object_schema() {
  json pixels = json::object(), names = json::array();
  const json counts = to_json_value(ObjectCounts{});
  for (const auto& [name, value] : counts.items()) {
    pixels[name] = k_count;
    names.push_back(name);
  }
  json fields{{"id", said(k_count, "in the plane object_id")},
              {"model", k_text},
              {"class_path", said(k_text, "vehicle/car; empty: none")},
              {"class_id", said(or_null(k_count), "index of class_paths of dataset.json")},
              {"material", k_text},
              {"pixels", object_of(std::move(pixels), std::move(names))},
              {"box", said(or_null(list_of(k_count, 4)), "x, y, width, height, pixels")},
              {"visible_fraction", or_null(k_number)},
              {"occlusion", or_null(k_number)},
              {"truncation", or_null(k_number)}};
  json required = json::array({"id", "model", "class_path", "class_id", "material"});
  const json pose = pose_schema();
  for (const auto& [name, field] : pose.items()) {
    fields[name] = field;
    required.push_back(name);
  }
  return object_of(std::move(fields), std::move(required));
}

json file_schema() {
  return object_of({{"path", said(k_text, "relative to the dataset's folder")},
                    {"kind", said(k_text, "image, or a plane's name")},
                    {"size_bytes", k_count},
                    {"xxh128", k_hash},
                    {"sha256", {{"type", "string"}, {"pattern", "^[0-9a-f]{64}$"}}},
                    {"pixels_xxh128", said(k_hash, "of the decoded pixels")}},
                   {"path", "kind", "size_bytes", "xxh128", "sha256", "pixels_xxh128"});
}

/// The fields that a value has, but for those named.
json fields_of(const json& schema, const std::vector<std::string>& optional) {
  json required = json::array();
  for (const auto& [name, field] : schema.items())
    if (std::find(optional.begin(), optional.end(), name) == optional.end())
      required.push_back(name);
  return required;
}

json headed(json schema, const char* title) {
  schema["$schema"] = "https://json-schema.org/draft/2020-12/schema";
  schema["title"] = title;
  return schema;
}

}  // namespace

json image_schema() {
  json fields{
      {"id", said(k_text, "MODEL/VIEW, unique")},
      {"model", k_text},
      {"class_path", said(k_text, "vehicle/car; empty: none")},
      {"class_id", said(or_null(k_count), "index of class_paths of dataset.json")},
      {"classes", said(map_of(k_text), "class path by further classification")},
      {"split", {{"enum", {"train", "val", "test", ""}}}},
      {"fold", said(k_count, "of cross-validation; not of the test split")},
      {"material", k_text},
      {"draw_attempts", said(k_count, "how often they were drawn until camera.keep let them pass")},
      {"draws", said(map_of(k_drawn), "what distributions of the recipe gave, by key")},
      {"environment", k_text},
      {"view", k_text},
      {"files", {{"type", "array"}, {"items", file_schema()}}},
      {"seed", k_count},
      {"spp", k_count},
      {"width", k_count},
      {"height", k_count},
      {"math", {{"enum", {"strict", "fast"}}}},
      {"camera_model", k_text},
      {"intrinsics", said(or_null(rows(3, 3)), "K, pixel centres at .5; null of parallel rays")},
      {"metres_per_pixel", said(k_number, "of parallel rays")},
      {"camera_to_world", rows(4, 4)},
      {"camera_convention", {{"const", "opencv"}}},
      {"lens_radius_m", k_number},
      {"focus_distance_m", k_number},
      {"objects", {{"type", "array"}, {"items", object_schema()}}},
      {"box", said(or_null(list_of(k_count, 4)), "x, y, width, height in the mask, pixels")},
      {"visible_fraction", or_null(k_number)},
      {"occlusion", or_null(k_number)},
      {"truncation",
       said(or_null(k_number), "share of the model's silhouette outside the picture")},
      {"tone_map_scale", k_number},
      {"rejected_samples", k_count},
      {"relative_error", or_null(k_number)},
      {"film", film_schema()},
      {"pixel_counts", counts_schema()},
      {"render_key", k_hash},
      {"files_key", k_hash},
      {"parts", object_of({{"model", k_hash},
                           {"material", k_hash},
                           {"environment", k_hash},
                           {"camera", k_hash},
                           {"engine", k_hash}},
                          {"model", "material", "environment", "camera", "engine"})}};
  fields.update(pose_schema());
  json required =
      fields_of(fields, {"objects", "classes", "draw_attempts", "draws", "fold", "metres_per_pixel",
                         "box", "visible_fraction", "occlusion", "truncation", "model_to_world",
                         "model_to_camera", "model_box", "box_m"});
  return headed(object_of(std::move(fields), std::move(required)),
                "A line of manifest/images.jsonl of a dataset of dsbuild");
}

json dataset_schema() {
  const json texts{{"type", "array"}, {"items", k_text}};
  json fields{
      {"format", {{"const", k_manifest_format}}},
      {"name", k_text},
      {"licence", said(k_text, "of the pictures")},
      {"about", said(map_of(k_text), "description, creator, url, published, version, cite")},
      {"recipe", said(k_text, "TOML, with all defaults, without paths of the machine")},
      {"dsbuild_version", k_text},
      {"seed", k_count},
      {"class_paths", said(texts, "a class's id is its index")},
      {"hierarchies", said(map_of(texts), "classes of further classifications")},
      {"shapes", said(map_of({{"type", "string"}, {"pattern", "^[0-9a-f]{76}$"}}),
                      "of models: what is alike of copies that are turned, scaled or meshed anew")},
      {"own_materials",
       said(
           map_of(texts),
           "of models shown in the materials of their files: what these call them, in the order of "
           "the ids in the plane material_id, from 1")},
      {"counts", map_of(k_count)},
      {"licences",
       {{"type", "array"},
        {"items", object_of({{"spdx", or_null(k_text)}, {"text", k_text}, {"assets", texts}},
                            {"spdx", "text", "assets"})}}},
      {"sources",
       said({{"type", "array"},
             {"items", object_of({{"url", or_null(k_text)}, {"text", k_text}, {"assets", texts}},
                                 {"url", "text", "assets"})}},
            "where assets come from, as the SOURCE files beside them say")},
      {"conventions", map_of(k_text)},
      {"draws", map_of(object_of({{"distribution", said(k_text, "TOML")},
                                  {"count", k_count},
                                  {"min", k_drawn_or_null},
                                  {"max", k_drawn_or_null},
                                  {"mean", k_drawn_or_null}},
                                 {"distribution", "count", "min", "max", "mean"}))},
      {"planes", map_of(object_of({{"encoding", k_text}, {"convention", k_text}},
                                  {"encoding", "convention"}))},
      {"concerns", map_of(object_of({{"count", k_count}, {"of", k_count}, {"examples", texts}},
                                    {"count", "of", "examples"}))},
      {"mended_models", map_of(map_of(k_count))}};
  json required = fields_of(fields, {"about", "shapes", "own_materials", "hierarchies", "draws",
                                     "planes", "concerns", "mended_models", "sources"});
  return headed(object_of(std::move(fields), std::move(required)),
                "manifest/dataset.json of a dataset of dsbuild");
}

}  // namespace ds
