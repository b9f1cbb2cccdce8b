// SPDX-License-Identifier: Apache-2.0
#include "builder/make/manifest_lines.h"

#include "builder/make/older_lines.h"
#include "builder/plan/dataset_concerns.h"
#include "builder/plan/dataset_manifest.h"
#include "manifests/json_text.h"
#include "manifests/manifest_writer.h"
#include "tracer/base/disk_error.h"
#include "tracer/base/error.h"

#include <algorithm>
#include <deque>

namespace ds {
namespace {

/// An image of the plan, and which of the made ones it is.
struct Wanted {
  const PlannedImage* image;
  std::size_t made;
};
constexpr std::size_t k_not_made = static_cast<std::size_t>(-1);

std::vector<Wanted> wanted_by_id(const ListedImages& images) {
  std::vector<Wanted> wanted;
  wanted.reserve(images.made.size() + images.lacking.size());
  for (std::size_t i = 0; i < images.made.size(); ++i)
    wanted.push_back({images.made[i], i});
  for (const PlannedImage* image : images.lacking)
    wanted.push_back({image, k_not_made});
  std::sort(wanted.begin(), wanted.end(),
            [](const Wanted& a, const Wanted& b) { return a.image->spec.id < b.image->spec.id; });
  return wanted;
}

class Lines {
 public:
  Lines(Dataset& dataset, const Plan& plan, PlacedFiles& placed, const ManifestWork& work)
      : dataset_(dataset),
        plan_(plan),
        placed_(placed),
        work_(work),
        writer_(dataset.folder),
        made_(work.images.made.size()) {}

  WrittenManifest write();

 private:
  bool is_labelled(const LineGlance& line, const ImageSpec& spec) const;
  bool still_holds(const LineGlance& line, const Wanted& wanted) const;
  bool in_place(const LineGlance& line) const;
  bool has_other_files(const LineGlance& line) const;
  void add_made(const Wanted& wanted);
  void take_made(const OlderLine& line, const Wanted& wanted);
  void take_older(const OlderLine& line, bool of_plan);
  void take_older_of_plan(const OlderLine& line, const PlannedImage& image);

  Dataset& dataset_;
  const Plan& plan_;
  PlacedFiles& placed_;
  const ManifestWork& work_;
  ManifestWriter writer_;
  BeyondCounter beyond_;
  std::vector<ImageFacts> made_;  ///< in the plan's order
  std::vector<ImageFacts> older_;
  std::deque<std::string> texts_;  ///< what `older_` views
  bool left_over_ = false;
};

ImageFacts facts_of(const ImageSpec& spec, const PixelCounts& counts) {
  return {spec.id,
          *spec.model_name,
          *spec.class_path,
          *spec.split,
          static_cast<std::uint64_t>(spec.engine.width) *
              static_cast<std::uint64_t>(spec.engine.height),
          counts,
          &spec};
}

std::string draws_text(const ImageSpec& spec, const Recipe& recipe) {
  return draws_text(attempts_of(spec, recipe), draws_of(spec, recipe));
}

/// Whether the line labels the image as the plan does.
bool Lines::is_labelled(const LineGlance& line, const ImageSpec& spec) const {
  return line.class_path == *spec.class_path && line.split == *spec.split &&
         line.fold == spec.fold && line.class_id == class_id_of(plan_, *spec.class_path) &&
         line.other_classes ==
             (spec.other_classes->empty() ? "" : canonical_json(*spec.other_classes));
}

/// Whether the line of a made image is what would be written of it now. Its cameras and settings are
/// in its keys, and what is known of its files goes with their bytes.
bool Lines::still_holds(const LineGlance& line, const Wanted& wanted) const {
  const PlannedImage& image = *wanted.image;
  if (!work_.lines_hold || work_.is_new(image)) return false;
  // What a line says of distractors is not seen at a glance.
  if (!image.spec.distractors->empty()) return false;
  const ImageSpec& spec = image.spec;
  const ImageKeys& keys = image.keys;
  if (line.render_key != keys.render || line.files_key != keys.files || !is_labelled(line, spec) ||
      line.draws != draws_text(spec, dataset_.recipe) || line.material != *spec.material_name ||
      line.environment != *spec.environment_name || line.model != *spec.model_name)
    return false;
  return std::equal(line.files.begin(), line.files.end(), keys.outputs.begin(), keys.outputs.end(),
                    [&](const LineGlance::File& file, const OutputFile& output) {
                      const PlacedFiles::Row* row = placed_.find(output.path);
                      // Counts that an older dsbuild did not make are made now.
                      const bool counted =
                          output.kind == "image"  ? line.pixel_counts.lit.has_value()
                          : output.kind == "mask" ? line.pixel_counts.left.has_value()
                                                  : true;
                      return counted && file.path == output.path && file.kind == output.kind &&
                             row != nullptr && row->object == file.xxh128;
                    });
}

/// A file that cannot be looked at is not known to be what a line says.
bool Lines::in_place(const LineGlance& line) const {
  try {
    return std::all_of(line.files.begin(), line.files.end(), [&](const LineGlance::File& file) {
      return placed_.bytes_in_place(std::string(file.path)) == file.xxh128;
    });
  } catch (const DiskFailed&) {
    throw;
  } catch (const Error&) {
    return false;
  }
}

/// Whether the line has a file that the recipe does not want of its image.
bool Lines::has_other_files(const LineGlance& line) const {
  const auto wanted = output_paths(dataset_.recipe.outputs, std::string(line.id));
  return std::any_of(line.files.begin(), line.files.end(), [&](const LineGlance::File& file) {
    return std::find(wanted.begin(), wanted.end(), file.path) == wanted.end();
  });
}

void Lines::add_made(const Wanted& wanted) {
  ImageRecord record = image_record(*wanted.image, dataset_.recipe, plan_, *dataset_.database);
  count_older_pixels(record, *wanted.image, dataset_.folder, *dataset_.database);
  beyond_.count(record, *wanted.image);
  made_[wanted.made] = facts_of(wanted.image->spec, record.pixel_counts);
  writer_.add(to_json_line(record), glance_at(record));
}

void Lines::take_made(const OlderLine& line, const Wanted& wanted) {
  made_[wanted.made] = facts_of(wanted.image->spec, line.glance.pixel_counts);
  writer_.add(line.text, line.glance);
}

void Lines::take_older(const OlderLine& line, bool of_plan) {
  const LineGlance& glance = line.glance;
  if (glance.files.empty() || !in_place(glance)) return;
  left_over_ = left_over_ || !of_plan || has_other_files(glance);
  const auto keep = [&](std::string_view text) -> std::string_view {
    return texts_.emplace_back(text);
  };
  older_.push_back({keep(glance.id), keep(glance.model), keep(glance.class_path),
                    keep(glance.split), glance.pixels, glance.pixel_counts});
  writer_.add(line.text, glance);
}

void Lines::take_older_of_plan(const OlderLine& line, const PlannedImage& image) {
  if (image.refused) return;
  const LineGlance& glance = line.glance;
  const bool labelled = is_labelled(glance, image.spec);
  // Of an output that is switched off the file is gone.
  const bool others = !work_.keep_all && has_other_files(glance);
  if (labelled && !others) return take_older(line, true);
  ImageRecord record = line.record();
  record.class_path = image.spec.class_path;
  record.split = image.spec.split;
  record.fold = image.spec.fold;
  record.class_id = class_id_of(plan_, record.class_path);
  record.other_classes = image.spec.other_classes;
  if (others) {
    const auto wanted = output_paths(dataset_.recipe.outputs, record.id);
    std::erase_if(record.files, [&](const FileRecord& file) {
      return std::find(wanted.begin(), wanted.end(), file.path) == wanted.end();
    });
  }
  take_older(OlderLine(record), true);
}

WrittenManifest Lines::write() {
  const std::vector<Wanted> wanted = wanted_by_id(work_.images);
  const bool wants_older = work_.lines_hold || !work_.images.lacking.empty() || work_.keep_all;
  OlderLines older(wants_older ? dataset_.folder : std::filesystem::path(), work_.lines_hold);
  const OlderLine* line = older.next();
  auto next = wanted.begin();
  while (next != wanted.end() || line != nullptr) {
    const int order = line == nullptr        ? -1
                      : next == wanted.end() ? 1
                                             : next->image->spec.id.compare(line->glance.id);
    const bool made = order <= 0 && next->made != k_not_made;
    if (order == 0 && made && still_holds(line->glance, *next))
      take_made(*line, *next);
    else if (made)
      add_made(*next);
    else if (order == 0)
      take_older_of_plan(*line, *next->image);
    else if (order > 0 && work_.keep_all)
      take_older(*line, false);
    if (order <= 0) ++next;
    if (order >= 0) line = older.next();
  }
  beyond_.remember(*dataset_.database);
  const std::size_t of_an_earlier_build = older_.size();
  made_.insert(made_.end(), older_.begin(), older_.end());
  std::vector<const ImageSpec*> pending;
  for (const PlannedImage* image : work_.images.pending)
    pending.push_back(&image->spec);
  DatasetRecord record = dataset_record(dataset_.recipe, plan_, made_, pending);
  if (of_an_earlier_build > 0)
    record.counts.emplace_back("of_an_earlier_build", of_an_earlier_build);
  writer_.finish(record);
  return {std::move(record.concerns), left_over_};
}

}  // namespace

WrittenManifest write_manifest(Dataset& dataset, const Plan& plan, PlacedFiles& placed,
                               const ManifestWork& work) {
  return Lines(dataset, plan, placed, work).write();
}

}  // namespace ds
