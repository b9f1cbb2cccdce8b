// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

/// The same questions to the kernels' headers compiled twice: with `real` a float, as on a device,
/// and with `real` a double and the C library's functions in place of math.h's polynomials.
/// Numbers of a question are floats, so that both builds start from the same bits. Constants of the
/// kernels keep their float values in both: what a constant's own rounding does (3e-8 of it) is the
/// same on either side and is not seen here; tests of closed forms hold that.
namespace ds::audit {

using Three = std::array<double, 3>;

struct BsdfQuestion {
  int material = 0;  ///< row of kernels/lists.h
  std::vector<float> inputs;
  std::array<float, 3> wo{}, wi{};  ///< local, unit to float rounding
  std::array<float, 4> numbers{};   ///< u, lobe
  bool outside = true;
};
struct BsdfAnswer {
  Three value{};  ///< at wi
  double pdf = 0;
  bool valid = false, specular = false, glossy = false;
  Three sampled{}, weight{};
  double sampled_pdf = 0;
};

struct LightQuestion {
  int light = 0;                               ///< row of kernels/lists.h
  const std::vector<float>* lights = nullptr;  ///< tables as device/scene_pack.h packs them
  const std::vector<float>* tables = nullptr;
  const std::vector<float>* triangles = nullptr;
  std::array<float, 3> from{};
  std::array<float, 2> numbers{};
  std::array<float, 3> direction{};  ///< of a path that leaves the scene
};
struct LightAnswer {
  Three wi{}, radiance{};
  double pdf = 0;
  Three escape{};  ///< of those that lie beyond the scene
  double escape_pdf = 0;
};

struct CameraQuestion {
  std::array<float, 44> view{};  ///< the words of ViewData
  std::array<float, 2> place{};  ///< in pixels
  std::array<float, 2> lens_numbers{};
};
struct CameraAnswer {
  Three origin{}, direction{};
};

/// A sample of a pixel that looks straight at an image sky.
struct SkyQuestion {
  std::array<float, 44> view{};  ///< the words of ViewData
  const std::vector<float>* lights = nullptr;
  const std::vector<float>* tables = nullptr;
  unsigned x = 0, y = 0, sample = 0;
};

/// A ray and a triangle that it hits.
struct HitQuestion {
  std::array<std::array<float, 3>, 3> corners{};
  std::array<float, 3> origin{}, direction{};
};
struct HitAnswer {
  double b1 = 0, b2 = 0;
  Three position{};
  double error = 0;  ///< as SurfaceAnswer's
};

struct SurfaceQuestion {
  std::array<std::array<float, 3>, 3> corners{};
  float b1 = 0, b2 = 0;
};
struct SurfaceAnswer {
  Three position{}, normal{};
  double error = 0;  ///< the bound that rays are offset by, half of it
};

namespace in_float {
BsdfAnswer ask(const BsdfQuestion& question);
LightAnswer ask(const LightQuestion& question);
CameraAnswer ask(const CameraQuestion& question);
HitAnswer ask(const HitQuestion& question);
SurfaceAnswer ask(const SurfaceQuestion& question);
Three ask(const SkyQuestion& question);
}  // namespace in_float

namespace in_double {
BsdfAnswer ask(const BsdfQuestion& question);
LightAnswer ask(const LightQuestion& question);
CameraAnswer ask(const CameraQuestion& question);
HitAnswer ask(const HitQuestion& question);
SurfaceAnswer ask(const SurfaceQuestion& question);
Three ask(const SkyQuestion& question);
}  // namespace in_double

}  // namespace ds::audit
