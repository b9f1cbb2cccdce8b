// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/plan/inputs.h"
#include "builder/recipe/recipe.h"
#include "tracer/render/render.h"

#include <atomic>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace ds {

/// What makes films from images' specifications. Virtual so that builds can be tested without a
/// tracer. Calls for one scene (model, material, environment) should follow each other: a scene is
/// loaded once for as long as it stays.
class Renderer {
 public:
  virtual ~Renderer() = default;
  /// As Tracer::trace: goes on from `kept` where there is one and that gives the same bits, calls
  /// `progress` about twice a second, throws Error(cancelled) soon after `stop` is set.
  virtual Film trace(const ImageSpec& image, FilmSums* kept,
                     const std::function<void(const TraceProgress&)>& progress,
                     const std::atomic<bool>& stop) = 0;
  /// As Tracer::trace_light.
  virtual LitPlanes trace_light(const ImageSpec& image, const std::vector<const PlaneType*>& types,
                                FilmSums* reached,
                                const std::function<void(const TraceProgress&)>& progress,
                                const std::atomic<bool>& stop) = 0;
  /// As Tracer::trace_planes.
  virtual std::vector<Plane> trace_planes(const ImageSpec& image,
                                          const std::vector<const PlaneType*>& types) = 0;
  /// As Tracer::trace_alone, of the image's distractors, in their order.
  virtual std::vector<Plane> trace_distractors(const ImageSpec& image) = 0;
  /// The image that will be asked for when this one is done, and what of it: what the host can do
  /// for it is done in the background while this one is traced. It must outlive the renderer. A guess
  /// that does not come true costs time only; an error is that image's, when it is asked for.
  virtual void expect(const ImageSpec& /*image*/, SceneUse /*use*/) {}
  /// Images that will be traced, in this order, one of each kind: what they need is got ready in
  /// the background while others are traced. They must outlive the renderer.
  // NOLINTNEXTLINE(performance-unnecessary-value-param): who overrides it keeps the list
  virtual void announce(std::vector<const ImageSpec*> /*images*/) {}
  virtual ProgramCounts programs() const { return {}; }
  virtual std::string device() const = 0;
};

/// Called when something has to be traced, so that a build that traces nothing needs no device.
using RendererFactory = std::function<std::unique_ptr<Renderer>()>;

/// The real one. `inputs` and `recipe` must outlive it. Throws Error(device) where there is none.
std::unique_ptr<Renderer> make_tracer_renderer(Inputs& inputs, const Recipe& recipe,
                                               const TracerOptions& options);

}  // namespace ds
