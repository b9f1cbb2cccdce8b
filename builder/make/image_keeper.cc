// SPDX-License-Identifier: Apache-2.0
#include "builder/make/image_keeper.h"

#include "builder/make/plane_outputs.h"
#include "builder/plan/image_scene.h"
#include "builder/plan/limits.h"
#include "tracer/base/disk_error.h"
#include "tracer/base/error.h"
#include "tracer/render/develop.h"
#include "tracer/render/film_file.h"

#include <chrono>
#include <utility>

namespace ds {

/// An image's files in bytes.
struct ImageKeeper::Ready {
  const PlannedImage* image = nullptr;
  ImageWork work;
  std::vector<MadeProduct> made;
  std::vector<std::vector<std::byte>> bytes;  ///< of each made
  std::vector<PlacedFile> placed;
  std::exception_ptr error;
  bool over_limit = false;  ///< that is the error: what was made is kept, and nothing placed
  bool dropped = false;
};

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

Product product_of(Hash128 key, const std::string& kind) {
  Product product;
  product.key = key;
  product.kind = kind;
  return product;
}

std::size_t bytes_held(const TracedImage& image) {
  std::size_t floats = image.sums.planes.size();
  if (image.film) floats += image.film->rgb.size() + image.film->halves.size();
  for (const auto* planes : {&image.planes, &image.light_planes})
    for (const Plane& plane : *planes)
      floats += plane.values.size();
  return floats * sizeof(float);
}

std::vector<Hash128> products_of(const PlannedImage& image) {
  std::vector<Hash128> keys{image.keys.render, image.keys.kept};
  for (const PlannedFile& file : image.files)
    if (file.state != FileState::in_place) keys.push_back(file.output.key);
  return keys;
}

}  // namespace

ImageKeeper::ImageKeeper(Dataset& dataset, const TextSet& texts, Disk& disk,
                         std::optional<Placing> placing)
    : dataset_(dataset), texts_(texts), disk_(disk), placing_(placing) {
  DS_ASSERT(dataset_.store != nullptr);
}

ImageKeeper::~ImageKeeper() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
    waiting_.clear();
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void ImageKeeper::keep(TracedImage image) {
  const std::size_t bytes = bytes_held(image);
  {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] {
      return waiting_.empty() || waiting_bytes_ + bytes <= k_most_waiting_bytes || ended_;
    });
    if (ended_) return;  // `take` tells it
    for (const Hash128 key : products_of(*image.image))
      products_.insert(key);
    waiting_bytes_ += bytes;
    ++under_way_;
    waiting_.push_back(std::move(image));
    if (!thread_.joinable()) thread_ = std::thread([this] { run(); });
  }
  changed_.notify_all();
}

bool ImageKeeper::makes(Hash128 product) {
  const std::lock_guard lock(mutex_);
  return products_.contains(product);
}

void ImageKeeper::wait_for(Hash128 product) {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return ended_ || !products_.contains(product); });
}

void ImageKeeper::finish() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return ended_ || under_way_ == 0; });
}

std::vector<KeptImage> ImageKeeper::take() {
  const std::lock_guard lock(mutex_);
  if (ended_) std::rethrow_exception(ended_);
  return std::exchange(kept_, {});
}

void ImageKeeper::run() {
  try {
    for (auto batch = next_batch(); !batch.empty(); batch = next_batch())
      keep_batch(std::move(batch));
  } catch (...) {
    const std::lock_guard lock(mutex_);
    ended_ = std::current_exception();
  }
  changed_.notify_all();
}

/// What waits now; empty at the end.
std::deque<TracedImage> ImageKeeper::next_batch() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return stop_ || !waiting_.empty(); });
  std::deque<TracedImage> batch;
  while (!stop_ && !waiting_.empty() && batch.size() < k_most_together) {
    waiting_bytes_ -= bytes_held(waiting_.front());
    batch.push_back(std::move(waiting_.front()));
    waiting_.pop_front();
  }
  lock.unlock();
  changed_.notify_all();
  return batch;
}

void ImageKeeper::keep_batch(std::deque<TracedImage> batch) {
  std::vector<Ready> ready;
  for (TracedImage& traced : batch) {
    ready.push_back(made_ready(traced, ready));
    traced.film.reset();
    traced.planes = traced.light_planes = {};
    traced.sums = {};
  }
  std::vector<Ready*> images;
  for (Ready& image : ready)
    if (!image.error || image.over_limit) images.push_back(&image);
  keep_together(images);
  for (Ready& image : ready)
    settle(image);
}

/// Where that fails for all, each is tried alone, and what fails is its own.
void ImageKeeper::keep_together(std::vector<Ready*>& images) {
  if (images.size() > 1 && !disk_failed_) {
    try {
      put_objects(images);
      commit(images);
      place(images);
      for (const Ready* image : images)
        journal_placed(*image);
      return;
    } catch (const DamagedDatabase&) {
      throw;
    } catch (const Error&) {
    }
  }
  for (Ready* image : images)
    keep_alone(*image);
}

void ImageKeeper::keep_alone(Ready& image) {
  image.dropped = disk_failed_;
  if (image.dropped) return;
  try {
    put_objects({&image});
    commit({&image});
    place_alone(image.placed);
    journal_placed(image);
  } catch (const DamagedDatabase&) {
    throw;
  } catch (const DiskFailed&) {
    disk_failed_ = true;
    image.error = std::current_exception();
  } catch (const Error&) {
    image.error = std::current_exception();
  }
}

void ImageKeeper::journal_begun(const Ready& image) const {
  if (journal_ != nullptr && !image.error) journal_->begin(image.image->spec.id, image.work);
}

void ImageKeeper::journal_placed(const Ready& image) const {
  if (journal_ != nullptr && !image.error) journal_->placed(image.image->spec.id);
}

void ImageKeeper::settle(Ready& image) {
  const std::lock_guard lock(mutex_);
  for (const Hash128 key : products_of(*image.image))
    products_.erase(products_.find(key));
  --under_way_;
  // Who takes it is then the last to let go of it.
  kept_.push_back({image.image, image.work, std::move(image.error), image.dropped});
  changed_.notify_all();
}

Product ImageKeeper::made_before(const OutputFile& output, const std::vector<Ready>& before) const {
  for (const Ready& image : before)
    for (const MadeProduct& made : image.made)
      if (made.product.key == output.key && (!image.error || image.over_limit)) return made.product;
  const std::optional<Product> product = dataset_.database->find_product(output.key);
  if (!product)
    fail(ErrorKind::io, "the image that was to make its {} failed; build again", output.kind);
  return *product;
}

/// Never throws what is the image's own fault: that stands in it. `before`: of the same batch.
ImageKeeper::Ready ImageKeeper::made_ready(const TracedImage& traced,
                                           const std::vector<Ready>& before) const {
  Ready ready;
  ready.image = traced.image;
  ready.work = traced.work;
  try {
    std::optional<Product> picture;
    const std::vector<PlannedFile>& files = traced.image->files;
    for (std::size_t i = 0; i < files.size(); ++i) {
      if (files[i].state == FileState::in_place) continue;
      const OutputFile& output = files[i].output;
      const Product product = traced.known[i]           ? *traced.known[i]
                              : traced.made_before[i]   ? made_before(output, before)
                              : output.plane == nullptr ? developed(ready, output, traced)
                                                        : plane_file(ready, output, traced);
      if (placing_)
        ready.placed.push_back({output.path, traced.image->spec.id, output.kind, output.key,
                                product.object, std::nullopt});
      if (output.kind == "image") picture = product;
    }
    if (picture) {
      ready.over_limit = true;
      check_limits(dataset_.recipe, traced.image->spec, *picture);
      ready.over_limit = false;
    }
  } catch (const DamagedDatabase&) {
    throw;
  } catch (const Error&) {
    ready.error = std::current_exception();
    ready.placed.clear();
  }
  return ready;
}

Product ImageKeeper::keep_bytes(Ready& ready, Product product, std::vector<std::byte> bytes,
                                const TraceRun& run) const {
  product.object = hash_bytes(bytes);
  product.size_bytes = bytes.size();
  product.sha256 = sha256_hex(bytes);
  product.pixels = product.kind == k_sums_kind
                       ? product.object
                       : pixel_hash(bytes, ready.image->spec.id + " " + product.kind);
  ready.made.push_back({product, run});
  ready.bytes.push_back(std::move(bytes));
  return product;
}

Product ImageKeeper::developed(Ready& ready, const OutputFile& output,
                               const TracedImage& traced) const {
  const Film& film = *traced.film;
  if (!traced.sums.empty()) {
    Product product = product_of(traced.image->keys.kept, k_sums_kind);
    product.facts.samples = traced.sums.samples();
    keep_bytes(ready, std::move(product), encode_film_sums(traced.sums), traced.film_run);
  }
  Product product = product_of(output.key, output.kind);
  product.rejected_samples = film.rejected_samples;
  product.relative_error = film.relative_error;
  product.facts = film.facts;
  if (traced.new_film && dataset_.recipe.keep_film) {
    Product film_product = product;
    film_product.key = traced.image->keys.render;
    film_product.kind = "film";
    keep_bytes(ready, std::move(film_product), encode_film_exr(film), traced.film_run);
  }
  const auto start = Clock::now();
  const auto [picture, scale, clipped] =
      develop(film, traced.tone_map, effects_of(traced.image->spec));
  ready.work.developed = true;
  product.tone_map_scale = scale;
  product.pixel_counts = count_picture(picture.pixels, picture.channels);
  product.pixel_counts.white = clipped;
  return keep_bytes(ready, std::move(product), encode_png(picture), {seconds_since(start), ""});
}

Product ImageKeeper::plane_file(Ready& ready, const OutputFile& output,
                                const TracedImage& traced) const {
  Product product = product_of(output.key, output.kind);
  if (is_cut_out(dataset_.recipe.outputs, output))
    return keep_bytes(ready, std::move(product),
                      encode_cut_out(output, traced.light_planes, *traced.film, traced.tone_map),
                      traced.light_run);
  if (is_of_light(*output.plane))
    return keep_bytes(ready, std::move(product),
                      encode_output(dataset_.recipe.outputs, output, traced.light_planes),
                      traced.light_run);
  product.pixel_counts = count_planes(traced.planes, *output.plane);
  // A plane of the model alone is that of images with others around it, too.
  if (!is_of_model_alone(*output.plane)) product.pixel_counts.objects = traced.objects;
  return keep_bytes(ready, std::move(product),
                    encode_output(dataset_.recipe.outputs, output, traced.planes),
                    traced.planes_run);
}

void ImageKeeper::put_objects(const std::vector<Ready*>& images) const {
  std::vector<Store::NewObject> objects;
  std::vector<std::string> records;
  for (const Ready* image : images) {
    for (std::size_t i = 0; i < image->made.size(); ++i)
      objects.push_back({image->made[i].product.object, image->bytes[i]});
    if (!image->made.empty()) records.push_back(to_record(image->made));
  }
  dataset_.store->put_all(objects, records);
}

void ImageKeeper::enter(const PlannedImage& image, const Ready* ready) {
  Database& database = *dataset_.database;
  if (ready != nullptr)
    for (const auto& [product, run] : ready->made)
      database.put_product(product, run);
  for (const Hash128 part : image.keys.parts)
    texts_.visit(part,
                 [&](Hash128 hash, const std::string& text) { database.put_text(hash, text); });
  database.put_image(dataset_.row.id, image.spec.id, image.keys.parts);
  if (ready != nullptr)
    for (const PlacedFile& file : ready->placed)
      database.put_placed(dataset_.row.id, file);
}

void ImageKeeper::enter_stamps() {
  for (const PlacedFile& file : stamped_)
    dataset_.database->put_placed(dataset_.row.id, file);
}

void ImageKeeper::commit(const std::vector<Ready*>& images) {
  Transaction transaction(dataset_.database->connection());
  for (const Ready* image : images) {
    journal_begun(*image);
    enter(*image->image, image);
  }
  enter_stamps();
  transaction.commit();
  stamped_.clear();
}

void ImageKeeper::place(const std::vector<Ready*>& images) {
  if (!placing_) return;
  std::vector<Store::ObjectToPlace> files;
  for (const Ready* image : images)
    for (const PlacedFile& file : image->placed)
      files.push_back({file.object, dataset_.folder / file.path});
  dataset_.store->place_all(files, *placing_);
  for (const Ready* image : images)
    for (const PlacedFile& file : image->placed) {
      stamped_.push_back(file);
      stamped_.back().stamp = stamp_of(dataset_.folder / file.path);
    }
}

/// All of an image's files or none: what the manifest cannot list is not to lie there.
void ImageKeeper::place_alone(const std::vector<PlacedFile>& files) {
  std::vector<PlacedFile> stamped;
  try {
    for (const PlacedFile& file : files) {
      const std::filesystem::path target = dataset_.folder / file.path;
      dataset_.store->place(file.object, target, *placing_);
      stamped.push_back(file);
      stamped.back().stamp = stamp_of(target);
    }
  } catch (const Error&) {
    for (const PlacedFile& file : stamped) {
      try {
        disk_.remove(dataset_.folder / file.path);
      } catch (const Error&) {  // what failed first is what the user is to hear of
      }
    }
    throw;
  }
  stamped_.insert(stamped_.end(), stamped.begin(), stamped.end());
}

void ImageKeeper::part_from_store(const PlannedImage& image) {
  for (const OutputFile& output : image.keys.outputs) {
    const std::optional<Product> product = dataset_.database->find_product(output.key);
    if (product && dataset_.store->is_object(dataset_.folder / output.path, product->object))
      place_alone(
          {{output.path, image.spec.id, output.kind, output.key, product->object, std::nullopt}});
  }
}

void ImageKeeper::record(const PlannedImage& image) {
  Transaction transaction(dataset_.database->connection());
  enter(image, nullptr);
  enter_stamps();
  transaction.commit();
  stamped_.clear();
}

void ImageKeeper::remember_stamps() {
  if (stamped_.empty()) return;
  Transaction transaction(dataset_.database->connection());
  enter_stamps();
  transaction.commit();
  stamped_.clear();
}

}  // namespace ds
