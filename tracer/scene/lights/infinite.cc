// SPDX-License-Identifier: Apache-2.0
#include "tracer/scene/sdl_lights.h"

#include <cmath>

namespace ds {
namespace {

/// The upper 3x3 must be a rotation, mirrored or not: a lat-long picture cannot be sheared or
/// scaled.
Mat4 rotation_of(const SdlNode& node, Mat4 m) {
  m.m[3] = m.m[7] = m.m[11] = 0;
  Mat4 transposed = m;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      transposed.m[i * 4 + j] = m.m[j * 4 + i];
  const Mat4 product = m * transposed;
  double error = 0;
  for (std::size_t i = 0; i < 16; ++i)
    error = std::fmax(error, std::fabs(product.m[i] - Mat4{}.m[i]));
  if (error > 1e-4)
    node.error("transformation", "wanted a rotation, found a matrix that scales or shears");
  return m;
}

void read_infinite(const SdlNode& node, const LightProperties& properties, Light& light) {
  Mat4 mirror;
  mirror.m[0] = -1;
  light.light_to_world = rotation_of(node, properties.transformation) * mirror;
  light.upper_hemisphere_only = node.flag("sampleupperhemisphereonly");
  light.image = read_image(node, 1, ImageUse::light);
}

}  // namespace

LightReading infinite_reading() {
  return {.parameters = concatenated({image_parameters(),
                                      {{"sampleupperhemisphereonly", SdlType::flag, "0",
                                        "the light is sampled from above the horizon only; a "
                                        "scattered ray still meets it below, as in LuxCore"}}}),
          .transformation_help = "a rotation, mirrored or not",
          .read = read_infinite};
}

}  // namespace ds
