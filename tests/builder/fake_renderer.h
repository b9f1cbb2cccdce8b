// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/make/renderer.h"
#include "tracer/base/error.h"
#include "tracer/base/files.h"
#include "tracer/base/hash.h"
#include "tracer/device/plane_types.h"
#include "tracer/kernels/layout.h"

#include <atomic>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace ds {

/// Makes a film that is a pure function of the image's files and settings, in no time, and counts
/// what it was asked.
class FakeRenderer : public Renderer {
 public:
  /// What all fakes of one build share.
  struct Calls {
    std::vector<std::string> traced, planes, announced, expected;  ///< ids in order
    std::atomic<std::size_t> films{0};                             ///< traced; for other threads
    std::string fails_on;                           ///< id of an image that cannot be traced
    std::map<std::string, std::uint64_t> rejected;  ///< samples that are NaN, by id
    std::atomic<bool>* stop_after_one = nullptr;
  };
  explicit FakeRenderer(Calls& calls) : calls_(calls) {}

  Film trace(const ImageSpec& image, FilmSums* /*kept*/,
             const std::function<void(const TraceProgress&)>& progress,
             const std::atomic<bool>& stop) override {
    if (stop) fail(ErrorKind::cancelled, "stopped");
    if (image.id == calls_.fails_on) fail(ErrorKind::device, "the fake was told to fail");
    calls_.traced.push_back(image.id);
    ++calls_.films;
    if (progress) progress({1, 1});
    Film film{image.engine.width, image.engine.height, {}, 0};
    const std::uint64_t seed = hash64_text(seed_text(image));
    for (int i = 0; i < film.width * film.height * 3; ++i)
      film.rgb.push_back(unit(seed, static_cast<std::uint64_t>(i)));
    film.facts.samples = static_cast<std::uint64_t>(film.width) *
                         static_cast<std::uint64_t>(film.height) *
                         static_cast<std::uint64_t>(image.engine.spp);
    film.traced_samples = film.facts.samples;
    if (const auto found = calls_.rejected.find(image.id); found != calls_.rejected.end())
      film.rejected_samples = film.facts.nan_samples = found->second;
    if (calls_.stop_after_one != nullptr) *calls_.stop_after_one = true;
    return film;
  }
  LitPlanes trace_light(const ImageSpec& image, const std::vector<const PlaneType*>& types,
                        FilmSums* /*reached*/,
                        const std::function<void(const TraceProgress&)>& progress,
                        const std::atomic<bool>& stop) override {
    LitPlanes traced{trace(image, nullptr, progress, stop), {}};
    traced.planes = planes_by_seed(image, types, hash64_text(seed_text(image)));
    return traced;
  }
  std::vector<Plane> trace_planes(const ImageSpec& image,
                                  const std::vector<const PlaneType*>& types) override {
    calls_.planes.push_back(image.id);
    return planes_by_seed(image, types,
                          hash64_text(read_text_file(image.model_file) + *image.view));
  }
  std::vector<Plane> trace_distractors(const ImageSpec& image) override {
    std::vector<Plane> masks;
    for (const Distractor& one : *image.distractors)
      masks.push_back(
          planes_by_seed(image, {&plane_type("amodal_mask")}, hash64_text(*one.model.name))
              .front());
    return masks;
  }
  void expect(const ImageSpec& image, SceneUse /*use*/) override {
    calls_.expected.push_back(image.id);
  }
  void announce(std::vector<const ImageSpec*> images) override {
    for (const ImageSpec* image : images)
      calls_.announced.push_back(image->id);
  }
  ProgramCounts programs() const override { return {}; }
  std::string device() const override { return "fake"; }

 private:
  static std::vector<Plane> planes_by_seed(const ImageSpec& image,
                                           const std::vector<const PlaneType*>& types,
                                           std::uint64_t seed) {
    std::vector<Plane> planes;
    for (const PlaneType* type : types) {
      Plane& plane = planes.emplace_back(Plane{type, image.engine.width, image.engine.height, {}});
      const bool whole =
          (type->traits & (kernels::k_plane_words | kernels::k_plane_png_share)) != 0;
      for (int i = 0; i < plane.width * plane.height * type->width; ++i) {
        const float value = unit(seed, static_cast<std::uint64_t>(i));
        plane.values.push_back(!whole ? value : value > 0.5f ? 1.0f : 0.0f);
      }
    }
    return planes;
  }
  static std::string seed_text(const ImageSpec& image) {
    return read_text_file(image.model_file) + read_text_file(image.material_file) +
           read_text_file(*image.environment_folder / "environment.scn") + *image.view +
           fmt::format("{} {}", image.engine.spp, image.engine.seed);
  }
  static float unit(std::uint64_t seed, std::uint64_t i) {
    return static_cast<float>(hash64_text(fmt::format("{} {}", seed, i)) >> 40) * 0x1p-24f;
  }

  Calls& calls_;
};

}  // namespace ds
