// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/base/vec.h"
#include "tracer/scene/scene.h"

#include <array>

namespace ds {

/// LuxCore's sky2 parameters.
struct SkySettings {
  Vec3d sun_direction{0, 0, 1};  ///< unit, towards the sun; z at least 0
  double turbidity = 2.2;        ///< 1.7 .. 10
  Vec3d ground_albedo{};         ///< 0 .. 1 a band: light the ground throws back into the sky
  /// Below the horizon: the ground's colour, else the sky at the horizon.
  bool ground_enable = false;
  bool ground_autoscale = true;  ///< the ground's colour is times the luminance of the zenith
  Vec3d ground_color{0.75, 0.75, 0.75};
};

/// A clear sky without the sun's disc: radiance in linear Rec.709, photometric like LuxCore's sky2
/// (lm/(m^2 sr)).
///
/// The model is the five-parameter sky of Perez, Seals and Michalsky, "All-weather model for sky
/// luminance distribution" (Solar Energy 50(3), 1993), as Preetham, Shirley and Smits (SIGGRAPH
/// 1999, eq. 3) use it, one for each band: L = L_zenith F(theta, gamma) / F(0, theta_sun), with
///     F = (1 + A exp(B / (cos theta + 0.01))) (1 + C exp(D gamma) + E cos^2 gamma).
/// Neither paper's coefficients are used: they were fitted, as polynomials in the sine of the sun's
/// elevation and the turbidity, to radiances measured from LuxCore 2.11 (elevations 5 to 85
/// degrees, turbidities 1.7 to 10, ground albedo 0). At turbidity 2.2 they differ from it by 7 %
/// (root mean square over the sky), at most by 40 % beside the sun. The ground's light in the sky
/// is its irradiance times a share that depends on the height over the horizon, fitted the same
/// way. A sun lower than 2 degrees lights the sky as one at 2 degrees.
///
/// Same bits everywhere: no libm function is used.
class SkyModel {
 public:
  explicit SkyModel(const SkySettings& settings);
  /// What directions of one height share, so that a row of a picture takes half the time: the same
  /// bits, kept from call to call.
  struct Ring {
    double z = -2;  ///< of no direction
    Vec3d gradation;
  };
  /// `direction` unit, any.
  Vec3d radiance(Vec3d direction, Ring& ring) const;
  Vec3d radiance(Vec3d direction) const {
    Ring ring;
    return radiance(direction, ring);
  }

 private:
  /// One band's coefficients for this sun and turbidity; `scale` is L_zenith / F(0, theta_sun).
  struct Band {
    double a, b, c, d, e, scale;
  };
  Vec3d sky(Vec3d direction, Ring& ring) const;
  Vec3d clear(Vec3d direction, Ring& ring) const;
  Vec3d irradiance_of_clear_sky() const;

  SkySettings settings_;
  std::array<Band, 3> bands_;
  Vec3d from_ground_;  ///< radiance of the lit ground as the sky sees it
  Vec3d ground_;       ///< radiance below the horizon where the ground is enabled
};

/// The whole sphere as a lat-long picture for Light::image, with light_to_world the identity:
/// linear floats, no file. `content` is the hash of the pixels.
Image make_sky_image(const SkySettings& settings, int width = 512, int height = 256);

}  // namespace ds
