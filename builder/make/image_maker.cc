// SPDX-License-Identifier: Apache-2.0
#include "builder/make/image_maker.h"

#include "builder/make/plane_outputs.h"
#include "builder/plan/limits.h"
#include "tracer/base/error.h"
#include "tracer/base/log.h"
#include "tracer/render/develop.h"
#include "tracer/render/film_file.h"

#include <chrono>
#include <utility>

namespace ds {

/// What is known while one image is made.
struct ImageMaker::Work {
  const PlannedImage& image;
  bool force;
  const std::function<void(const TraceProgress&)>& progress;
  const std::atomic<bool>& stop;
  ImageWork done;
  std::vector<MadeProduct> made;
  std::vector<Plane> planes;
  TraceRun planes_run;
};

namespace {

class Stopwatch {
 public:
  double seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
};

Product product_of(Hash128 key, const std::string& kind) {
  Product product;
  product.key = key;
  product.kind = kind;
  return product;
}

}  // namespace

ImageMaker::ImageMaker(Dataset& dataset, Inputs& inputs, const TextSet& texts, Disk& disk,
                       RendererFactory factory, Placing placing)
    : dataset_(dataset),
      inputs_(inputs),
      texts_(texts),
      disk_(disk),
      factory_(std::move(factory)),
      placing_(placing) {
  DS_ASSERT(dataset_.store != nullptr);
}

Renderer& ImageMaker::renderer() {
  if (no_device_) throw *no_device_;
  if (renderer_) return *renderer_;
  try {
    renderer_ = factory_();
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::device) throw;
    throw no_device_.emplace(error.what());
  }
  renderer_->announce(std::exchange(upcoming_, {}));
  return *renderer_;
}

std::optional<Product> ImageMaker::find_whole(Hash128 key) const {
  std::optional<Product> product = dataset_.database->find_product(key);
  // The row of a lost object stays: files placed of it before are still what it says.
  if (product && !dataset_.store->intact(product->object)) return std::nullopt;
  return product;
}

Product ImageMaker::keep(Work& work, Product product, const std::vector<std::byte>& bytes,
                         const TraceRun& run) const {
  product.object = dataset_.store->put(bytes);
  product.size_bytes = bytes.size();
  product.sha256 = sha256_hex(bytes);
  product.pixels = product.kind == k_sums_kind
                       ? product.object
                       : pixel_hash(bytes, work.image.spec.id + " " + product.kind);
  work.made.push_back({product, run});
  return product;
}

/// An empty one where none is kept, or it cannot be read: then tracing starts anew.
FilmSums ImageMaker::kept_film(const Work& work) const {
  if (work.force || !dataset_.recipe.keep_sums) return {};
  const std::optional<Product> known = dataset_.database->find_product(work.image.keys.kept);
  const auto bytes = known ? dataset_.store->get(known->object) : std::nullopt;
  if (!bytes) return {};
  try {
    return decode_film_sums(*bytes, "kept film of " + work.image.spec.id);
  } catch (const Error& error) {
    warn(error.what());
    return {};
  }
}

/// Keeps the film with more samples, of the one there was and this one.
void ImageMaker::keep_sums(Work& work, const FilmSums& sums, std::uint64_t had,
                           const TraceRun& run) {
  if (sums.empty() || sums.samples() <= had) return;
  Product product = product_of(work.image.keys.kept, k_sums_kind);
  product.facts.samples = sums.samples();
  keep(work, std::move(product), encode_film_sums(sums), run);
}

Film ImageMaker::trace_film(Work& work) {
  const Stopwatch watch;
  FilmSums sums = kept_film(work);
  const std::uint64_t had = sums.samples();
  Film film = renderer().trace(work.image.spec, &sums, work.progress, work.stop);
  work.done.traced = true;
  work.done.samples += film.traced_samples;
  if (dataset_.recipe.keep_sums) keep_sums(work, sums, had, {watch.seconds(), renderer().device()});
  if (dataset_.recipe.keep_film) {
    Product product = product_of(work.image.keys.render, "film");
    product.rejected_samples = film.rejected_samples;
    product.relative_error = film.relative_error;
    product.facts = film.facts;
    keep(work, std::move(product), encode_film_exr(film), {watch.seconds(), renderer().device()});
  }
  return film;
}

Film ImageMaker::obtain_film(Work& work) {
  const Hash128 key = work.image.keys.render;
  const std::optional<Product> known =
      work.force ? std::nullopt : dataset_.database->find_product(key);
  const auto bytes = known ? dataset_.store->get(known->object) : std::nullopt;
  if (!bytes) return trace_film(work);
  Film film = decode_film_exr(*bytes, "film of " + work.image.spec.id);
  film.rejected_samples = known->rejected_samples;
  film.relative_error = known->relative_error;
  film.facts = known->facts;
  return film;
}

Product ImageMaker::develop_image(Work& work, const OutputFile& output) {
  const Film film = obtain_film(work);
  const ToneMap& tone_map =
      tone_map_of(dataset_.recipe, inputs_.environment(work.image.spec.environment_folder));
  const Stopwatch watch;
  const Picture picture = develop(film, tone_map);
  work.done.developed = true;
  Product product = product_of(output.key, output.kind);
  product.tone_map_scale = tone_map_scale(film, tone_map);
  product.rejected_samples = film.rejected_samples;
  product.relative_error = film.relative_error;
  product.facts = film.facts;
  product.pixel_counts = count_picture(picture.pixels, picture.channels);
  product.pixel_counts.white = clipped_pixels(film, tone_map);
  const std::vector<std::byte> bytes = encode_png(picture);
  return keep(work, std::move(product), bytes, {watch.seconds(), ""});
}

Product ImageMaker::make_plane_file(Work& work, const OutputFile& output) {
  if (work.planes.empty()) {
    const Stopwatch watch;
    work.planes = renderer().trace_planes(work.image.spec, planes_of(dataset_.recipe.outputs));
    work.planes_run = {watch.seconds(), renderer().device()};
    work.done.traced = true;
  }
  Product product = product_of(output.key, output.kind);
  product.pixel_counts = count_planes(work.planes);
  return keep(work, std::move(product), encode_output(dataset_.recipe.outputs, output, work.planes),
              work.planes_run);
}

Product ImageMaker::obtain(Work& work, const OutputFile& output) {
  if (!work.force)
    if (const auto known = find_whole(output.key)) return *known;
  return output.plane == nullptr ? develop_image(work, output) : make_plane_file(work, output);
}

void ImageMaker::commit(const PlannedImage& image, const std::vector<MadeProduct>& made,
                        const std::vector<PlacedFile>& placed) {
  Database& database = *dataset_.database;
  Transaction transaction(database.connection());
  for (const auto& [product, run] : made)
    database.put_product(product, run);
  for (const Hash128 part : image.keys.parts)
    texts_.visit(part,
                 [&](Hash128 hash, const std::string& text) { database.put_text(hash, text); });
  database.put_image(dataset_.row.id, image.spec.id, image.keys.parts);
  for (const PlacedFile& file : placed)
    database.put_placed(dataset_.row.id, file);
  for (const PlacedFile& file : stamped_)
    database.put_placed(dataset_.row.id, file);
  transaction.commit();
  stamped_.clear();
}

void ImageMaker::place(const PlacedFile& file) {
  const std::filesystem::path target = dataset_.folder / file.path;
  dataset_.store->place(file.object, target, placing_);
  PlacedFile stamped = file;
  stamped.stamp = stamp_of(target);
  stamped_.push_back(std::move(stamped));
}

/// All of an image's files or none: what the manifest cannot list is not to lie there.
void ImageMaker::place_all(const std::vector<PlacedFile>& files) {
  const std::size_t before = stamped_.size();
  try {
    for (const PlacedFile& file : files)
      place(file);
  } catch (const Error&) {
    for (; stamped_.size() > before; stamped_.pop_back()) {
      try {
        disk_.remove(dataset_.folder / stamped_.back().path);
      } catch (const Error&) {  // what failed first is what the user is to hear of
      }
    }
    throw;
  }
}

/// What was made is recorded, so that it is not made again, but nothing is placed.
void ImageMaker::refuse_over_limit(const Work& work, const Product& picture) {
  try {
    check_limits(dataset_.recipe, work.image.spec, picture);
  } catch (const Error&) {
    commit(work.image, work.made, {});
    throw;
  }
}

ImageWork ImageMaker::make(const PlannedImage& image, bool force,
                           const std::function<void(const TraceProgress&)>& progress,
                           const std::atomic<bool>& stop) {
  Work work{image, force, progress, stop, {}, {}, {}, {}};
  std::vector<PlacedFile> placed;
  std::optional<Product> picture;
  for (const PlannedFile& file : image.files) {
    if (file.state == FileState::in_place) continue;
    const Product product = obtain(work, file.output);
    placed.push_back({file.output.path, image.spec.id, file.output.kind, file.output.key,
                      product.object, std::nullopt});
    if (file.output.kind == "image") picture = product;
  }
  if (!work.made.empty()) dataset_.store->put_record(to_record(work.made));
  if (picture) refuse_over_limit(work, *picture);
  commit(image, work.made, placed);
  place_all(placed);
  return work.done;
}

void ImageMaker::part_from_store(const PlannedImage& image) {
  for (const OutputFile& output : image.keys.outputs) {
    const std::optional<Product> product = dataset_.database->find_product(output.key);
    if (product && dataset_.store->is_object(dataset_.folder / output.path, product->object))
      place({output.path, image.spec.id, output.kind, output.key, product->object, std::nullopt});
  }
}

void ImageMaker::record(const PlannedImage& image) {
  commit(image, {}, {});
}

void ImageMaker::remember_stamps() {
  if (stamped_.empty()) return;
  Transaction transaction(dataset_.database->connection());
  for (const PlacedFile& file : stamped_)
    dataset_.database->put_placed(dataset_.row.id, file);
  transaction.commit();
  stamped_.clear();
}

}  // namespace ds
