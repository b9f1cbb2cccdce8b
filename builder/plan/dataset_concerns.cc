// SPDX-License-Identifier: Apache-2.0
#include "builder/plan/dataset_concerns.h"

#include "manifests/truncation.h"
#include "tracer/base/error.h"
#include "tracer/base/log.h"
#include "tracer/render/image_files.h"

#include <algorithm>
#include <set>
#include <span>
#include <utility>

namespace ds {
namespace {

/// Counts the image among those looked at, and among those concerned where it is one.
void look(std::vector<Concern>& concerns, const char* name, const ImageFacts& image,
          bool is_concerned) {
  Concern& one = concern(concerns, name);
  ++one.of;
  if (is_concerned) add_example(one, std::string(image.id));
}

void look_at_image(std::vector<Concern>& concerns, const ImageFacts& image) {
  const std::uint64_t pixels = image.pixels;
  const PixelCounts& counts = image.counts;
  if (counts.model) {
    look(concerns, "mask_empty", image, *counts.model == 0);
    look(concerns, "mask_at_frame", image, counts.frame.value_or(0) > 0);
    look(concerns, "mask_small", image, *counts.model > 0 && *counts.model * 100 < pixels);
  }
  if (counts.lit) {
    // Under so few lit pixels: what noise leaves of a room without light.
    look(concerns, "picture_black", image, *counts.lit * 1000 < pixels);
  }
  if (counts.white) look(concerns, "picture_white", image, *counts.white * 4 > pixels);
}

/// Of the class files, which the recipe has read.
void look_at_labels(std::vector<Concern>& concerns, const Recipe& recipe,
                    const std::vector<ImageFacts>& images,
                    const std::vector<const ImageSpec*>& pending) {
  Concern& absent = concern(concerns, "models_absent");
  absent = {absent.name, recipe.coverage.missing, recipe.coverage.listed,
            recipe.coverage.missing_examples};
  Concern& unlisted = concern(concerns, "models_unlisted");
  unlisted = {unlisted.name, recipe.coverage.unlisted, recipe.coverage.files,
              recipe.coverage.unlisted_examples};
  Concern& ambiguous = concern(concerns, "entries_ambiguous");
  ambiguous = {ambiguous.name, recipe.coverage.ambiguous, recipe.coverage.listed,
               recipe.coverage.ambiguous_examples};
  const UnsharedClasses& found = recipe.coverage.unshared;
  Concern& unshared = concern(concerns, "classes_unshared");
  unshared.of = found.of;
  for (const std::string& path : found.classes)
    add_example(unshared, path);
  // An image is of its class and of those above it.
  std::set<std::string, std::less<>> seen;
  const auto see = [&](std::string_view path) {
    while (!path.empty() && seen.emplace(path).second)
      path = path.substr(0, path.rfind('/') == path.npos ? 0 : path.rfind('/'));
  };
  for (const ImageFacts& image : images)
    see(image.class_path);
  for (const ImageSpec* image : pending)
    see(*image->class_path);
  Concern& empty = concern(concerns, "classes_empty");
  empty.of = recipe.class_paths.size();
  for (const std::string& path : recipe.class_paths)
    if (!seen.contains(path)) add_example(empty, path);
}

void look_at_splits(std::vector<Concern>& concerns, const Recipe& recipe,
                    const std::vector<ImageFacts>& images,
                    const std::vector<const ImageSpec*>& pending) {
  const SplitSettings& asked = recipe.split;
  const bool by_name = !asked.held_out.empty() || !asked.held_out_val.empty();
  const bool by_share = asked.test || asked.val;
  const bool by_table = !recipe.classes_from.empty() && recipe.labels.has_splits();
  Concern& empty = concern(concerns, "splits_empty");
  const auto look_at = [&](const char* split, bool wanted) {
    if (!wanted) return;
    ++empty.of;
    const auto is_made = [&](const ImageFacts& image) { return image.split == split; };
    const auto is_to_come = [&](const ImageSpec* image) { return *image->split == split; };
    if (std::none_of(images.begin(), images.end(), is_made) &&
        std::none_of(pending.begin(), pending.end(), is_to_come))
      add_example(empty, split);
  };
  const bool val_by_table =
      by_table && std::any_of(recipe.models.begin(), recipe.models.end(), [&](const auto& model) {
        return recipe.labels.find(model.name).value_or(ModelLabel{}).split == "val";
      });
  look_at("train", by_share || by_name || recipe.train_classes || by_table);
  look_at("val", asked.val || !asked.held_out_val.empty() || val_by_table);
  look_at("test", asked.test || !asked.held_out.empty() || recipe.test_classes || by_table);
}

PixelCounts count_file(const std::filesystem::path& file, const std::string& kind) {
  const std::string bytes = read_image_file(file);
  const DecodedImage image = decode_image_bytes(bytes_of(bytes), file.string(), Halves::keep);
  if (image.type != SampleType::uint8) return {};
  const std::span samples(reinterpret_cast<const std::uint8_t*>(image.samples.data()),
                          image.samples.size());
  if (kind == "image") return count_picture(samples, image.channels);
  return image.channels == 1 ? count_mask(samples, image.width, image.height) : PixelCounts{};
}

}  // namespace

std::vector<Concern> dataset_concerns(const Recipe& recipe, const std::vector<Concern>& planned,
                                      const std::vector<ImageFacts>& images,
                                      const std::vector<const ImageSpec*>& pending) {
  std::vector<Concern> concerns = no_concerns();
  for (const ImageFacts& image : images)
    look_at_image(concerns, image);
  look_at_labels(concerns, recipe, images, pending);
  look_at_splits(concerns, recipe, images, pending);
  for (const Concern& one : planned)
    concern(concerns, one.name.c_str()) = one;
  return concerns;
}

void count_older_pixels(ImageRecord& record, const PlannedImage& image,
                        const std::filesystem::path& folder, Database& database) {
  for (const OutputFile& output : image.keys.outputs) {
    const bool counted = output.kind == "image"  ? record.pixel_counts.lit.has_value()
                         : output.kind == "mask" ? record.pixel_counts.left.has_value()
                                                 : true;
    if (counted) continue;
    try {
      const PixelCounts counts = count_file(folder / output.path, output.kind);
      add_counts(record.pixel_counts, counts);
      database.add_pixel_counts(output.key, counts);
    } catch (const DamagedDatabase&) {
      throw;
    } catch (const Error&) {  // it stands as it was placed, and is not for dsbuild to read then
    }
  }
}

const FileMesh& BeyondCounter::mesh_of(const ModelPose& pose, const std::filesystem::path& file) {
  last_ = meshes_.get(hash_text(file.native()), [&] { return ReadMesh{read_model(file).mesh}; });
  if (bounds_of(last_->mesh) != pose.model_box)
    fail(ErrorKind::asset, "{}: is no longer the model of the pictures", file.string());
  return last_->mesh;
}

void BeyondCounter::tell_objects(ImageRecord& record, const ImageSpec& image) {
  for (const Distractor& one : *image.distractors)
    for (ObjectRecord& object : record.objects) {
      if (object.id != one.id()) continue;
      try {
        const PixelCounts counts = count_beyond(record, object.pose, [&]() -> const FileMesh& {
          return mesh_of(object.pose, one.model.file);
        });
        if (counts.beyond == 0U && !counts.whole)
          object.truncation = 0;
        else if (*counts.whole != 0)
          object.truncation =
              static_cast<double>(*counts.beyond) / static_cast<double>(*counts.whole);
      } catch (const Error& error) {
        warn(fmt::format("{}; the manifest does not say what of it is cut off", error.what()));
      }
    }
}

void BeyondCounter::count(ImageRecord& record, const PlannedImage& image) {
  tell_objects(record, image.spec);
  if (record.pixel_counts.beyond) return;
  bool read = false;
  try {
    const auto counts = count_beyond(record, [&]() -> const FileMesh& {
      read = true;
      return mesh_of(*record.pose, image.spec.model_file);
    });
    if (!counts) return;
    add_counts(record.pixel_counts, *counts);
    if (read && !image.keys.outputs.empty())
      found_.emplace_back(image.keys.outputs.front().key, *counts);
  } catch (const Error& error) {
    warn(fmt::format("{}; the manifest does not say what of it is cut off", error.what()));
  }
}

void BeyondCounter::remember(Database& database) {
  if (found_.empty()) return;
  Transaction transaction(database.connection());
  for (const auto& [product, counts] : found_)
    database.add_pixel_counts(product, counts);
  transaction.commit();
  found_.clear();
}

}  // namespace ds
