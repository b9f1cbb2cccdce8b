// SPDX-License-Identifier: Apache-2.0
#include "manifests/manifest.h"

#include "manifests/film_facts.h"
#include "manifests/json_text.h"

namespace ds {
namespace {

using nlohmann::json;

/// Row-major numbers as nested rows, which numpy.array reads as a matrix.
template <std::size_t N>
json matrix(const std::array<double, N>& values, std::size_t columns) {
  json rows = json::array();
  for (std::size_t i = 0; i < N; i += columns) {
    rows.push_back(std::vector<double>(values.begin() + static_cast<std::ptrdiff_t>(i),
                                       values.begin() + static_cast<std::ptrdiff_t>(i + columns)));
  }
  return rows;
}

json to_json_value(const FileRecord& file) {
  return {{"path", file.path},
          {"kind", file.kind},
          {"size_bytes", file.hashes.size_bytes},
          {"xxh128", file.hashes.xxh128.hex()},
          {"sha256", file.hashes.sha256},
          {"pixels_xxh128", file.pixels.hex()}};
}

template <typename Counts>
json box_of(const Counts& left, const Counts& right, const Counts& above, const Counts& below,
            const ImageRecord& image) {
  return {left, above, static_cast<std::uint64_t>(image.width) - left - right,
          static_cast<std::uint64_t>(image.height) - above - below};
}

/// Null where no pixel could show it.
void add_visible(json& to, std::uint64_t seen_pixels, std::uint64_t amodal_pixels) {
  const double of = static_cast<double>(amodal_pixels), seen = static_cast<double>(seen_pixels);
  to["visible_fraction"] = of == 0 ? json() : json(seen / of);
  to["occlusion"] = of == 0 ? json() : json((of - seen) / of);
}

/// What follows from the counts. Null where no pixel shows the model, or could.
void add_counted(json& line, const ImageRecord& image) {
  const PixelCounts& counts = image.pixel_counts;
  if (counts.left && counts.right && counts.above && counts.below)
    line["box"] = *counts.model == 0
                      ? json()
                      : box_of(*counts.left, *counts.right, *counts.above, *counts.below, image);
  if (counts.beyond)
    line["truncation"] =
        counts.whole == 0U ? json()
        : *counts.beyond == 0
            ? json(0.0)
            : json(static_cast<double>(*counts.beyond) / static_cast<double>(*counts.whole));
  if (counts.model && counts.amodal) add_visible(line, *counts.model, *counts.amodal);
}

json to_json_value(const Box& box) {
  return {{box.least.x, box.least.y, box.least.z}, {box.most.x, box.most.y, box.most.z}};
}

void add_pose(json& to, const ModelPose& pose, const ImageRecord& image) {
  const auto in_camera = model_to_camera(pose, image.camera_to_world);
  to["model_to_world"] = matrix(pose.model_to_world, 4);
  to["model_box"] = to_json_value(pose.model_box);
  to["box_m"] = to_json_value(world_box(pose));
  to["model_to_camera"] = {{"opencv", matrix(in_camera, 4)},
                           {"opengl", matrix(to_opengl(in_camera), 4)}};
}

json to_json_value(const ObjectRecord& object, const ImageRecord& image) {
  json value{{"id", object.id},
             {"model", object.model},
             {"class_path", object.class_path},
             {"class_id", object.class_id ? json(*object.class_id) : json()},
             {"material", object.material}};
  add_pose(value, object.pose, image);
  value["truncation"] = object.truncation ? json(*object.truncation) : json();
  if (!object.pixels) return value;
  const ObjectCounts& counts = *object.pixels;
  value["pixels"] = to_json_value(counts);
  value["box"] = counts.seen == 0
                     ? json()
                     : box_of(counts.left, counts.right, counts.above, counts.below, image);
  add_visible(value, counts.seen, counts.amodal);
  return value;
}

void add_objects(json& line, const ImageRecord& image) {
  for (const ObjectRecord& object : image.objects)
    line["objects"].push_back(to_json_value(object, image));
}

json to_json_value(const ImageRecord& image) {
  json files = json::array();
  for (const FileRecord& file : image.files)
    files.push_back(to_json_value(file));
  const auto& parts = image.parts;
  json line{{"id", image.id},
            {"model", image.model},
            {"class_path", image.class_path},
            {"class_id", image.class_id ? json(*image.class_id) : json()},
            {"split", image.split},
            {"material", image.material},
            {"environment", image.environment},
            {"view", image.view},
            {"files", std::move(files)},
            {"seed", image.seed},
            {"spp", image.spp},
            {"width", image.width},
            {"height", image.height},
            {"math", image.math},
            {"camera_model", image.camera_model},
            {"intrinsics", image.intrinsics ? matrix(*image.intrinsics, 3) : json()},
            {"camera_to_world", matrix(image.camera_to_world, 4)},
            {"camera_convention", "opencv"},
            {"lens_radius_m", image.lens_radius_m},
            {"focus_distance_m", image.focus_distance_m},
            {"tone_map_scale", image.tone_map_scale},
            {"rejected_samples", image.rejected_samples},
            {"relative_error", image.relative_error ? json(*image.relative_error) : json()},
            {"film", to_json_value(image.film)},
            {"pixel_counts", to_json_value(image.pixel_counts)},
            {"render_key", image.render_key.hex()},
            {"files_key", image.files_key.hex()},
            {"parts",
             {{"model", parts[0].hex()},
              {"material", parts[1].hex()},
              {"environment", parts[2].hex()},
              {"camera", parts[3].hex()},
              {"engine", parts[4].hex()}}}};
  if (image.metres_per_pixel) line["metres_per_pixel"] = *image.metres_per_pixel;
  if (image.fold) line["fold"] = *image.fold;
  if (!image.other_classes.empty()) line["classes"] = image.other_classes;
  if (image.draw_attempts) line["draw_attempts"] = *image.draw_attempts;
  if (!image.draws.empty()) line["draws"] = to_json_value(image.draws);
  add_counted(line, image);
  if (image.pose) add_pose(line, *image.pose, image);
  add_objects(line, image);
  return line;
}

json counts_object(const std::vector<std::pair<std::string, std::uint64_t>>& counts) {
  json object = json::object();
  for (const auto& [name, count] : counts)
    object[name] = count;
  return object;
}

json to_json_value(const LicenceRecord& licence) {
  return {{"spdx", licence.spdx.empty() ? json() : json(licence.spdx)},
          {"text", licence.text},
          {"assets", licence.assets}};
}

json to_json_value(const DatasetRecord& dataset) {
  json licences = json::array();
  for (const LicenceRecord& licence : dataset.licences)
    licences.push_back(to_json_value(licence));
  json object{
      {"format", k_manifest_format},
      {"name", dataset.name},
      {"licence", dataset.licence},
      {"recipe", dataset.recipe_text},
      {"dsbuild_version", dataset.dsbuild_version},
      {"seed", dataset.seed},
      {"class_paths", dataset.class_paths},
      {"counts", counts_object(dataset.counts)},
      {"licences", std::move(licences)},
      {"conventions",
       {{"world", "right-handed, z up, metres"},
        {"camera_to_world",
         "4x4, row-major, column vectors; opencv camera: x right, y down, z forward"},
        {"intrinsics",
         "3x3, row-major, pixels; origin at the top left corner, pixel centres at .5; null "
         "where rays are parallel: they start in the plane the camera stands in and run "
         "along z, and the picture, metres_per_pixel * (width, height) large, has the "
         "camera in its middle"},
        {"model_to_world",
         "4x4, row-major, column vectors; the model file's coordinates to the world, with "
         "the scale; model_to_camera likewise, to a camera of opencv axes or opengl's (x "
         "right, y up, z backward)"},
        {"truncation",
         "share of the pixels that would show the model alone on a picture without end which are "
         "outside this one; null where some of the model is not before the camera"},
        {"box", "[x, y, width, height] in whole pixels around the model in the mask"},
        {"objects",
         "things beside the model, which the plane object_id has as their id; box, "
         "visible_fraction, truncation and poses of each as those of the model, which is 1"},
        {"model_box",
         "[least, most] of the model file's coordinates; box_m around its eight corners in the "
         "world"}}}};
  if (!dataset.about.empty()) object["about"] = dataset.about;
  for (const SourceRecord& source : dataset.sources)
    object["sources"].push_back({{"url", source.url.empty() ? json() : json(source.url)},
                                 {"text", source.text},
                                 {"assets", source.assets}});
  if (!dataset.shapes.empty()) object["shapes"] = dataset.shapes;
  if (!dataset.own_materials.empty()) object["own_materials"] = dataset.own_materials;
  if (!dataset.hierarchies.empty()) object["hierarchies"] = dataset.hierarchies;
  if (!dataset.draws.empty()) object["draws"] = to_json_value(dataset.draws);
  for (const auto& [name, plane] : dataset.planes)
    object["planes"][name] = {{"encoding", plane.encoding}, {"convention", plane.convention}};
  for (const Concern& concern : dataset.concerns)
    object["concerns"][concern.name] = {
        {"count", concern.count}, {"of", concern.of}, {"examples", concern.examples}};
  for (const auto& [model, damage] : dataset.mended_models)
    object["mended_models"][model] = counts_object(damage);
  return object;
}

}  // namespace

std::string to_json_line(const ImageRecord& image) {
  return canonical_json(to_json_value(image));
}

std::string to_json(const DatasetRecord& dataset) {
  return canonical_json(to_json_value(dataset), 2);
}

}  // namespace ds
