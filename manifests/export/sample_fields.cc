// SPDX-License-Identifier: Apache-2.0
#include "manifests/export/sample_fields.h"

#include <fmt/format.h>

namespace ds {
namespace {

/// Row-major numbers as nested rows.
template <std::size_t N>
nlohmann::json rows_of(const std::array<double, N>& values, std::size_t columns) {
  nlohmann::json rows = nlohmann::json::array();
  for (std::size_t i = 0; i < N; i += columns)
    rows.push_back(std::vector<double>(values.begin() + static_cast<std::ptrdiff_t>(i),
                                       values.begin() + static_cast<std::ptrdiff_t>(i + columns)));
  return rows;
}

/// A part of what is there, null of nothing.
nlohmann::json share(std::optional<std::uint64_t> part, std::optional<std::uint64_t> of) {
  if (!part || !of || *of == 0) return nullptr;
  return static_cast<double>(*part) / static_cast<double>(*of);
}

/// As the manifest's lines have them.
void add_model(nlohmann::json& fields, const ExportInput& input, const ImageRecord& record) {
  fields["model_to_world"] = nullptr;
  fields["box_m"] = nullptr;
  if (record.pose) {
    const Box box = world_box(*record.pose);
    fields["model_to_world"] = rows_of(record.pose->model_to_world, 4);
    fields["box_m"] = {{box.least.x, box.least.y, box.least.z},
                       {box.most.x, box.most.y, box.most.z}};
  }
  const PixelCounts& counts = record.pixel_counts;
  if (!input.has("mask")) return;
  fields["truncation"] = counts.beyond == 0U && counts.whole != 0U
                             ? nlohmann::json(0.0)
                             : share(counts.beyond, counts.whole);
  if (!input.has("amodal_mask")) return;
  fields["visible_fraction"] = share(counts.model, counts.amodal);
  fields["occlusion"] = counts.model && counts.amodal
                            ? share(*counts.amodal - *counts.model, counts.amodal)
                            : nlohmann::json();
}

}  // namespace

bool has_folds(const DatasetRecord& dataset) {
  return dataset.recipe_text.find("\nclasses.split.folds = ") != std::string::npos;
}

nlohmann::json sample_fields(const ExportInput& input, const ExportImage& image) {
  const ImageRecord& record = image.record;
  nlohmann::json fields{{"id", record.id},
                        {"split", image.split},
                        {"label", image.label < 0 ? nlohmann::json() : nlohmann::json(image.label)},
                        {"class_path", record.class_path},
                        {"model", record.model},
                        {"material", record.material},
                        {"environment", record.environment},
                        {"view", record.view},
                        {"seed", record.seed},
                        {"spp", record.spp},
                        {"width", record.width},
                        {"height", record.height},
                        {"camera_model", record.camera_model},
                        {"intrinsics", nullptr},
                        {"metres_per_pixel", nullptr},
                        {"camera_to_world", rows_of(record.camera_to_world, 4)},
                        {"lens_radius_m", record.lens_radius_m},
                        {"focus_distance_m", record.focus_distance_m},
                        {"tone_map_scale", record.tone_map_scale},
                        {"relative_error", nullptr}};
  if (has_folds(input.dataset))
    fields["fold"] = record.fold ? static_cast<std::int64_t>(*record.fold) : std::int64_t{-1};
  if (record.intrinsics) fields["intrinsics"] = rows_of(*record.intrinsics, 3);
  if (record.metres_per_pixel) fields["metres_per_pixel"] = *record.metres_per_pixel;
  if (record.relative_error) fields["relative_error"] = *record.relative_error;
  add_model(fields, input, record);
  if (!input.dataset.draws.empty())
    fields["draws"] = record.draws.empty() ? nlohmann::json() : to_json_value(record.draws);
  if (!input.has("mask")) return fields;
  const auto box = tight_box(read_mask(input, image));
  fields["bbox"] = box ? nlohmann::json(*box) : nlohmann::json();
  return fields;
}

std::string place_of_kind(const ExportImage& image, const std::string& kind) {
  return fmt::format("{}/{}{}", kind == "image" ? "images" : kind, image.key,
                     ending_of(file_of(image, kind)));
}

}  // namespace ds
