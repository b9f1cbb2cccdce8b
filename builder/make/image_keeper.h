// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/make/made_journal.h"
#include "builder/make/traced_image.h"
#include "builder/store/dataset.h"
#include "builder/store/made_record.h"

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <mutex>
#include <optional>
#include <set>
#include <thread>
#include <vector>

namespace ds {

/// Product::kind of a kept film's sums.
inline constexpr const char* k_sums_kind = "film_sums";

/// What became of an image that was given to the keeper.
struct KeptImage {
  const PlannedImage* image = nullptr;
  ImageWork work;
  std::exception_ptr error;  ///< why its files are not in place
  bool dropped = false;      ///< the disk failed at an image before: this one was not tried
};

/// Develops and encodes what was traced, puts it into the store, records it, and places the files,
/// in a thread of its own while the next image is traced. Images that wait are kept together: they
/// share a wait for the disk and a transaction, so that images which are traced quicker than a disk
/// answers do not queue for it. A crash at any moment leaves nothing that the next plan takes for
/// whole: objects come before the rows that name them, rows before the files they account for.
///
/// All functions are for one thread, which calls `keep`; `record`, `part_from_store` and
/// `remember_stamps` while nothing is under way.
class ImageKeeper {
 public:
  /// All must outlive this. Without `placing` no file is placed: the store has what was made.
  ImageKeeper(Dataset& dataset, const TextSet& texts, Disk& disk, std::optional<Placing> placing);
  /// What is not finished is dropped.
  ~ImageKeeper();
  ImageKeeper(const ImageKeeper&) = delete;
  ImageKeeper& operator=(const ImageKeeper&) = delete;

  /// Where images are entered as they are kept; called before any is. Null: nowhere.
  void enter_in(MadeJournal* journal) { journal_ = journal; }
  /// Waits where more than k_most_waiting_bytes wait already.
  void keep(TracedImage image);
  /// Whether an image under way makes the product.
  bool makes(Hash128 product);
  /// Returns once none does.
  void wait_for(Hash128 product);
  /// Returns once nothing is under way.
  void finish();
  /// What was kept since the last call, in the order it was given. Throws what ended the thread
  /// where that was no Error of an image's.
  std::vector<KeptImage> take();

  /// Enters an image whose files need nothing.
  void record(const PlannedImage& image);
  /// Makes copies of the image's files that are in place and hard links to the store.
  void part_from_store(const PlannedImage& image);
  /// Writes the stamps of the files placed since the last call; they ride along with the next image
  /// otherwise.
  void remember_stamps();

 private:
  struct Ready;
  static constexpr std::size_t k_most_waiting_bytes = std::size_t{256} << 20U;
  static constexpr std::size_t k_most_together = 64;  ///< images: what waits is lost by a crash

  void run();
  std::deque<TracedImage> next_batch();
  void keep_batch(std::deque<TracedImage> batch);
  void keep_together(std::vector<Ready*>& images);
  void keep_alone(Ready& image);
  void settle(Ready& image);
  Ready made_ready(const TracedImage& traced, const std::vector<Ready>& before) const;
  Product made_before(const OutputFile& output, const std::vector<Ready>& before) const;
  Product keep_bytes(Ready& ready, Product product, std::vector<std::byte> bytes,
                     const TraceRun& run) const;
  Product developed(Ready& ready, const OutputFile& output, const TracedImage& traced) const;
  Product plane_file(Ready& ready, const OutputFile& output, const TracedImage& traced) const;
  void journal_begun(const Ready& image) const;
  void journal_placed(const Ready& image) const;
  void put_objects(const std::vector<Ready*>& images) const;
  void commit(const std::vector<Ready*>& images);
  void enter(const PlannedImage& image, const Ready* ready);
  void enter_stamps();
  void place(const std::vector<Ready*>& images);
  void place_alone(const std::vector<PlacedFile>& files);

  Dataset& dataset_;
  const TextSet& texts_;
  Disk& disk_;
  std::optional<Placing> placing_;
  MadeJournal* journal_ = nullptr;
  std::vector<PlacedFile> stamped_;  ///< of the thread while images are under way
  bool disk_failed_ = false;         ///< of the thread

  std::mutex mutex_;  ///< for all below
  std::condition_variable changed_;
  std::deque<TracedImage> waiting_;
  std::size_t waiting_bytes_ = 0;
  std::multiset<Hash128> products_;  ///< of images under way
  std::size_t under_way_ = 0;        ///< images given and not yet in kept_
  std::vector<KeptImage> kept_;
  std::exception_ptr ended_;  ///< by what the thread was
  bool stop_ = false;
  std::thread thread_;
};

}  // namespace ds
