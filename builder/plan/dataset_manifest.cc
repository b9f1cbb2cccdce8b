// SPDX-License-Identifier: Apache-2.0
#include "builder/plan/dataset_manifest.h"

#include "builder/plan/dataset_concerns.h"
#include "builder/plan/licence_files.h"
#include "tracer/base/files.h"
#include "tracer/scene/type_tables.h"

#include <algorithm>
#include <map>
#include <set>

#ifndef DS_VERSION
#  error "the build must define DS_VERSION"
#endif

namespace ds {
namespace {

/// Of a picture whose pixels have different numbers of samples: the mean, rounded up.
int mean_spp(const FilmFacts& facts, const ImageRecord& image) {
  const std::uint64_t pixels =
      static_cast<std::uint64_t>(image.width) * static_cast<std::uint64_t>(image.height);
  return static_cast<int>((facts.samples + pixels - 1) / pixels);
}

/// The classes that images have in each.
std::map<std::string, std::vector<std::string>> hierarchies_of(const Plan& plan) {
  std::map<std::string, std::set<std::string>> classes;
  const Shared<std::map<std::string, std::string>>* before = nullptr;
  for (const PlannedImage& image : plan.images) {
    const auto& of_image = image.spec.other_classes;
    if (before != nullptr && before->is_same(of_image)) continue;
    before = &of_image;
    for (const auto& [name, path] : *of_image) {
      std::set<std::string>& known = classes[name];
      if (!path.empty()) known.insert(path);
    }
  }
  std::map<std::string, std::vector<std::string>> hierarchies;
  for (const auto& [name, paths] : classes)
    hierarchies[name].assign(paths.begin(), paths.end());
  return hierarchies;
}

std::vector<double> numbers_of(const DrawnValue& value, const Drawn& drawn) {
  return {value.begin(),
          value.begin() + static_cast<std::ptrdiff_t>(width_of(drawn.distribution.kind))};
}

/// Until they are divided by the count, means are sums.
void add_values(DrawSummary& summary, const std::vector<double>& values) {
  if (summary.count++ == 0) {
    summary.least = summary.most = summary.mean = values;
    return;
  }
  for (std::size_t j = 0; j < values.size(); ++j) {
    summary.least[j] = std::min(summary.least[j], values[j]);
    summary.most[j] = std::max(summary.most[j], values[j]);
    summary.mean[j] += values[j];
  }
}

}  // namespace

DrawRecords draws_of(const ImageSpec& image, const Recipe& recipe) {
  DrawRecords draws;
  for (std::size_t i = 0; i < recipe.drawn.size(); ++i) {
    const Drawn& drawn = recipe.drawn[i];
    draws[drawn.key] = {numbers_of(image.variables->draws[i], drawn),
                        drawn.distribution.kind == DrawnKind::integer};
  }
  for (const Distractor& one : *image.distractors)
    for (std::size_t i = 0; i < one.draws.size(); ++i) {
      const Drawn& drawn = recipe.distractors.drawn[i];
      draws[distractor_key(one.number, drawn.key.substr(drawn.key.find('.') + 1))] = {
          numbers_of(one.draws[i], drawn), false};
    }
  return draws;
}

namespace {

/// `counts`: of its planes.
std::vector<ObjectRecord> objects_of(const ImageSpec& image, const Recipe& recipe, const Plan& plan,
                                     const PixelCounts& counts) {
  std::vector<ObjectRecord> objects;
  for (const Distractor& one : *image.distractors) {
    ObjectRecord& object = objects.emplace_back();
    object.id = one.id();
    object.model = one.model.name;
    object.class_path = one.model.class_path;
    object.class_id = class_id_of(plan, object.class_path);
    object.material = one.material_name;
    const MeshExtent& extent = plan.extents.at(one.model.file->native());
    object.pose = {model_to_world(extent, normalise_of(one, recipe), one.lowest).m, extent.box};
    const auto pixels =
        std::find_if(counts.objects.begin(), counts.objects.end(),
                     [&](const ObjectCounts& each) { return each.id == object.id; });
    if (pixels != counts.objects.end()) object.pixels = *pixels;
  }
  return objects;
}

}  // namespace

std::optional<std::uint64_t> attempts_of(const ImageSpec& image, const Recipe& recipe) {
  const bool draws = !recipe.drawn.empty() || !recipe.distractors.models.empty();
  if (!draws || !recipe.keep.any()) return std::nullopt;
  return static_cast<std::uint64_t>(image.variables->attempts) + 1;
}

DrawSummaries summaries_of(const Recipe& recipe, const std::vector<const ImageSpec*>& images) {
  DrawSummaries summaries;
  for (std::size_t i = 0; i < recipe.drawn.size(); ++i) {
    DrawSummary& summary = summaries[recipe.drawn[i].key];
    summary.distribution = recipe.drawn[i].text;
    for (const ImageSpec* image : images)
      add_values(summary, numbers_of(image->variables->draws[i], recipe.drawn[i]));
  }
  for (std::size_t i = 0; i < recipe.distractors.drawn.size(); ++i) {
    const Drawn& drawn = recipe.distractors.drawn[i];
    DrawSummary& summary = summaries[drawn.key];
    summary.distribution = drawn.text;
    for (const ImageSpec* image : images)
      for (const Distractor& one : *image->distractors)
        add_values(summary, numbers_of(one.draws[i], drawn));
  }
  for (auto& [key, summary] : summaries)
    for (double& mean : summary.mean)
      mean /= static_cast<double>(summary.count);
  return summaries;
}

std::optional<std::uint64_t> class_id_of(const Plan& plan, const std::string& class_path) {
  const auto at = plan.class_ids.find(class_path);
  return at == plan.class_ids.end() ? std::nullopt : std::optional(at->second);
}

std::string program_version() {
  return DS_VERSION;
}

ImageRecord image_record(const PlannedImage& image, const Recipe& recipe, const Plan& plan,
                         Database& database) {
  const ImageSpec& spec = image.spec;
  ImageRecord record;
  record.id = spec.id;
  record.model = spec.model_name;
  record.class_path = spec.class_path;
  record.split = spec.split;
  record.fold = spec.fold;
  record.class_id = class_id_of(plan, *spec.class_path);
  record.other_classes = spec.other_classes;
  record.draws = draws_of(spec, recipe);
  record.draw_attempts = attempts_of(spec, recipe);
  record.material = spec.material_name;
  record.environment = spec.environment_name;
  record.view = spec.view;
  record.seed = spec.engine.seed;
  record.spp = spec.engine.spp;
  record.width = spec.engine.width;
  record.height = spec.engine.height;
  record.math = spec.engine.math == MathMode::strict ? "strict" : "fast";
  const CameraType& camera = type_of(spec.camera);
  record.camera_model = camera.name;
  if (camera.host.span == kernels::CameraSpan::fov_deg)
    record.intrinsics = camera_intrinsics(spec.camera.fov_deg, record.width, record.height);
  else
    record.metres_per_pixel = spec.camera.extent_m / std::max(record.width, record.height);
  record.camera_to_world = camera_pose(spec.camera);
  record.lens_radius_m = spec.camera.lens_radius_m;
  record.focus_distance_m = spec.camera.focus_distance_m;
  if (const auto at = plan.extents.find(spec.model_file->native()); at != plan.extents.end())
    record.pose = {model_to_world(at->second, normalise_of(spec, recipe), spec.lowest).m,
                   at->second.box};
  record.render_key = image.keys.render;
  record.files_key = image.keys.files;
  std::copy_n(image.keys.parts.begin(), record.parts.size(), record.parts.begin());
  for (const OutputFile& output : image.keys.outputs) {
    const std::optional<Product> product = database.find_product(output.key);
    if (!product) fail(ErrorKind::io, "{}: the database has no record of its making", output.path);
    record.files.push_back({output.path,
                            output.kind,
                            {product->object, product->sha256, product->size_bytes},
                            product->pixels});
    add_counts(record.pixel_counts, product->pixel_counts);
    if (output.kind == "image") {
      record.tone_map_scale = product->tone_map_scale;
      record.rejected_samples = product->rejected_samples;
      record.relative_error = product->relative_error;
      record.film = product->facts;
      if (spec.engine.target) record.spp = mean_spp(product->facts, record);
    }
  }
  record.objects = objects_of(spec, recipe, plan, record.pixel_counts);
  record.pixel_counts.objects.clear();
  return record;
}

DatasetRecord dataset_record(const Recipe& recipe, const Plan& plan,
                             const std::vector<ImageFacts>& images,
                             const std::vector<const ImageSpec*>& pending) {
  DatasetRecord record;
  record.name = recipe.name;
  record.licence = recipe.licence;
  record.about = recipe.about;
  record.recipe_text = canonical_recipe(recipe);
  record.dsbuild_version = program_version();
  record.seed = recipe.seed;
  std::set<std::string_view> models, shown;
  std::map<std::string_view, std::uint64_t> splits;
  for (const ImageFacts& image : images) {
    models.insert(image.model);
    shown.insert(image.model);
    if (image.spec != nullptr)
      for (const Distractor& one : *image.spec->distractors)
        shown.insert(*one.model.name);
    if (!image.split.empty()) ++splits[image.split];
  }
  record.class_paths.resize(plan.class_ids.size());
  for (const auto& [path, id] : plan.class_ids)
    record.class_paths[id] = path;
  record.hierarchies = hierarchies_of(plan);
  std::vector<const ImageSpec*> specs;
  for (const ImageFacts& image : images)
    if (image.spec != nullptr) specs.push_back(image.spec);
  record.draws = summaries_of(recipe, specs);
  record.counts = {{"images", images.size()}, {"models", models.size()}};
  for (const auto& [split, count] : splits)
    record.counts.emplace_back(split, count);
  for (const PlaneOutput& plane : recipe.outputs.planes)
    record.planes.emplace_back(plane.type->name,
                               PlaneRecord{std::string(name_of(plane.encoding)),
                                           header_comment("planes", plane.type->name)});
  for (const auto& [model, what] : plan.mended)
    if (shown.contains(model)) record.mended_models.emplace_back(model, what.damage);
  for (const auto& [model, shape] : plan.shapes)
    if (models.contains(model)) record.shapes.emplace(model, shape);
  for (const auto& [model, names] : plan.own_materials)
    if (shown.contains(model)) record.own_materials.emplace(model, names);
  std::vector<std::pair<std::string, std::string>> texts, sources;
  for (const auto& [kind, assets] : licensed_assets(recipe)) {
    for (auto& licence : licences_beside(kind, assets))
      texts.push_back(std::move(licence));
    for (auto& source : sources_beside(kind, assets))
      sources.push_back(std::move(source));
  }
  record.licences = group_licences(texts);
  record.sources = group_sources(sources);
  record.concerns = dataset_concerns(recipe, plan.concerns, images, pending);
  return record;
}

}  // namespace ds
