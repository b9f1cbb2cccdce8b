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
/// The formula is that of Hosek and Wilkie, "An Analytic Model for Full Spectral Sky-Dome Radiance"
/// (ACM TOG 31(4), 2012, eq. 8 to 11), one for each band, with theta from the zenith and gamma from
/// the sun:
///     (1 + A exp(B / (cos theta + 0.01)))
///       (C + D exp(E gamma) + F cos^2 gamma + G chi(H, gamma) + I sqrt(cos theta)),
///     chi(H, gamma) = (1 + cos^2 gamma) / (1 + H^2 - 2 H cos gamma)^1.5.
/// Their tables are not used: A to I are polynomials of the sun's elevation and the turbidity, fitted to
/// radiances of their sky in Mitsuba 3.9 (sunsky, albedo 0, 29,000 directions; LuxCore 2.11.2's sky2 is
/// 72,900 times that, to 0.2 %). At 25,000 other directions, elevations 1 to 88 degrees, turbidities 1.7
/// to 9.6, a band differs from it by 1.2 to 1.8 % (root mean square), in one of a hundred by 4 to 6 %, at
/// most by a third, beside a low sun. The ground's light in the sky is its irradiance times a share that
/// depends on the height over the horizon, an own fit too. A sun lower than a tenth of a degree lights the sky as one at a tenth.
///
/// Same bits everywhere: no libm function is used.
class SkyModel {
 public:
  explicit SkyModel(const SkySettings& settings);
  /// What directions of one height share, so that a row of a picture takes half the time: the same
  /// bits, kept from call to call.
  struct Ring {
    double z = -2;  ///< of no direction
    double root = 0;
    Vec3d gradation;
  };
  /// `direction` unit, any.
  Vec3d radiance(Vec3d direction, Ring& ring) const;
  Vec3d radiance(Vec3d direction) const {
    Ring ring;
    return radiance(direction, ring);
  }

 private:
  /// One band's parameters for this sun and turbidity.
  struct Band {
    double a, b, c, d, e, f, g, h, i;
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
