// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/make/image_keeper.h"
#include "builder/make/renderer.h"
#include "builder/plan/plan.h"

#include <atomic>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

namespace ds {

/// Nothing can be traced, which is no fault of an image.
class NoDevice : public Error {
 public:
  explicit NoDevice(const std::string& why) : Error(ErrorKind::device, why) {}
};

/// Makes images: finds what is in the store, traces what is not, and gives the rest to an
/// ImageKeeper.
class ImageMaker {
 public:
  /// All must outlive this.
  ImageMaker(Dataset& dataset, Inputs& inputs, const TextSet& texts, Disk& disk,
             RendererFactory factory, std::optional<Placing> placing = Placing::share);

  /// Traces what the image lacks, and leaves the rest to the keeper, which tells what became of it.
  /// Throws Error for anything that stops this image; another image may go well. Throws NoDevice for
  /// an image that is to be traced where nothing can be.
  void start(const PlannedImage& image, bool force,
             const std::function<void(const TraceProgress&)>& progress,
             const std::atomic<bool>& stop);
  /// The same, returning once all is done; for when nothing else is under way. Throws for what the
  /// keeper says too.
  ImageWork make(const PlannedImage& image, bool force,
                 const std::function<void(const TraceProgress&)>& progress,
                 const std::atomic<bool>& stop);
  ImageKeeper& keeper() { return keeper_; }
  /// As Renderer::announce; the images must outlive this.
  void announce(std::vector<const ImageSpec*> images) { upcoming_ = std::move(images); }
  /// As Renderer::expect, told when something of an image is traced; it must outlive this.
  void expect(const PlannedImage& image) { expected_ = &image; }
  /// Of the renderer; none before anything was traced.
  ProgramCounts programs() const { return renderer_ ? renderer_->programs() : ProgramCounts{}; }
  /// Of the renderer; empty before anything was traced.
  std::string device() const { return renderer_ ? renderer_->device() : ""; }

 private:
  struct Work;
  std::optional<Product> find_whole(Hash128 key) const;
  void obtain(Work& work, const OutputFile& output);
  void obtain_film(Work& work);
  void trace_film(Work& work);
  void trace_light(Work& work);
  void trace_planes(Work& work);
  bool lacks_light(const Work& work);
  FilmSums kept_film(const Work& work);
  SceneUse use_of(const PlannedImage& image) const;
  Renderer& renderer();

  Dataset& dataset_;
  Inputs& inputs_;
  RendererFactory factory_;
  std::unique_ptr<Renderer> renderer_;
  std::optional<NoDevice> no_device_;       ///< why there is no renderer, once that was tried
  std::vector<const ImageSpec*> upcoming_;  ///< announced before there was a renderer
  const PlannedImage* expected_ = nullptr;  ///< until the renderer was told
  ImageKeeper keeper_;
};

}  // namespace ds
