// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/make/renderer.h"
#include "builder/plan/plan.h"
#include "builder/store/made_record.h"
#include "tracer/render/film.h"

#include <atomic>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

namespace ds {

/// Product::kind of a kept film's sums.
inline constexpr const char* k_sums_kind = "film_sums";

/// What one image's making took.
struct ImageWork {
  bool traced = false;        ///< film or geometry
  bool developed = false;     ///< a picture was made from a film
  std::uint64_t samples = 0;  ///< traced now
};

/// Nothing can be traced, which is no fault of an image.
class NoDevice : public Error {
 public:
  explicit NoDevice(const std::string& why) : Error(ErrorKind::device, why) {}
};

/// Makes one image at a time: finds what is in the store, traces and develops what is not, records
/// all of it in one transaction, then puts the files into the dataset's folder. A crash at any
/// moment leaves nothing that the next plan takes for whole: objects come before the rows that name
/// them, rows before the files they account for.
class ImageMaker {
 public:
  /// All must outlive this.
  ImageMaker(Dataset& dataset, Inputs& inputs, const TextSet& texts, Disk& disk,
             RendererFactory factory, Placing placing = Placing::share);

  /// Throws Error for anything that stops this image; another image may go well. Throws NoDevice for
  /// an image that is to be traced where nothing can be.
  ImageWork make(const PlannedImage& image, bool force,
                 const std::function<void(const TraceProgress&)>& progress,
                 const std::atomic<bool>& stop);
  /// Enters an image whose files need nothing.
  void record(const PlannedImage& image);
  /// Makes copies of the image's files that are in place and hard links to the store.
  void part_from_store(const PlannedImage& image);
  /// Writes the stamps of the files placed since the last call; they ride along with the next image
  /// otherwise.
  void remember_stamps();
  /// As Renderer::announce; the images must outlive this.
  void announce(std::vector<const ImageSpec*> images) { upcoming_ = std::move(images); }
  /// Of the renderer; none before anything was traced.
  ProgramCounts programs() const { return renderer_ ? renderer_->programs() : ProgramCounts{}; }
  /// Of the renderer; empty before anything was traced.
  std::string device() const { return renderer_ ? renderer_->device() : ""; }

 private:
  struct Work;
  Product obtain(Work& work, const OutputFile& output);
  std::optional<Product> find_whole(Hash128 key) const;
  Film obtain_film(Work& work);
  Film trace_film(Work& work);
  FilmSums kept_film(const Work& work) const;
  void keep_sums(Work& work, const FilmSums& sums, std::uint64_t had, const TraceRun& run);
  Product develop_image(Work& work, const OutputFile& output);
  Product make_plane_file(Work& work, const OutputFile& output);
  Product keep(Work& work, Product product, const std::vector<std::byte>& bytes,
               const TraceRun& run) const;
  void commit(const PlannedImage& image, const std::vector<MadeProduct>& made,
              const std::vector<PlacedFile>& placed);
  void refuse_over_limit(const Work& work, const Product& picture);
  void place(const PlacedFile& file);
  void place_all(const std::vector<PlacedFile>& files);
  Renderer& renderer();

  Dataset& dataset_;
  Inputs& inputs_;
  const TextSet& texts_;
  Disk& disk_;
  RendererFactory factory_;
  Placing placing_;
  std::unique_ptr<Renderer> renderer_;
  std::optional<NoDevice> no_device_;  ///< why there is no renderer, once that was tried
  std::vector<PlacedFile> stamped_;
  std::vector<const ImageSpec*> upcoming_;  ///< announced before there was a renderer
};

}  // namespace ds
