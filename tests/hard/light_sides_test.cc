// SPDX-License-Identifier: Apache-2.0
// Lights on either side of a surface, seen from either side: for every material, next-event
// estimation brings what the BSDF says and nothing where it says nothing.
#include "tests/hard/everywhere.h"
#include "tests/tracer/kernels/materials.h"
#include "tracer/scene/type_tables.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

namespace ds {
namespace {

using materials::Case;
using pictures::Picture;

/// A square of the material in the plane z = 0, whose outside is above, seen steeply from above or
/// below. One vertex a path.
Picture plate(const std::string& material, bool from_above, int spp) {
  Picture p = hard::deep_picture(8, spp);
  p.name = fmt::format("{} from {}", material, from_above ? "above" : "below");
  hard::add_material(p.scene, material);
  hard::set_alpha(p.scene, static_cast<int>(p.scene.materials.size()) - 1, 0.5f);
  pictures::add_object(p.scene, pictures::quad({0, 0, 0}, {4, 0, 0}, {0, 4, 0}),
                       static_cast<int>(p.scene.materials.size()) - 1);
  p.engine.depth_total = 1;
  p.camera.position = {0.3, -0.8, from_above ? 2.0 : -2.0};
  p.camera.fov_deg = 0.2;
  return p;
}

/// Radiance that leaves the plate's middle towards the camera, by the header's function in C++.
double by_the_bsdf(const Case& material, const Picture& p, Vec3 lamp) {
  const Vec3d eye = p.camera.position;
  const double side = eye.z > 0 ? 1 : -1;
  // The frame of the side that is seen: x stays, the other two turn over. No material that is seen
  // here tells azimuths apart.
  const auto local = [&](Vec3d d) {
    return kernels::vec(static_cast<float>(d.x), static_cast<float>(side * d.y),
                        static_cast<float>(side * d.z));
  };
  kernels::Viewer viewer;
  viewer.wo = local(normalized(eye));
  viewer.outside = side > 0;
  const Vec3d to_lamp = to_double(lamp);
  const std::vector<float> inputs = materials::inputs(material, 0.5f);
  const kernels::BsdfValue v = material.evaluate(inputs.data(), viewer, local(normalized(to_lamp)));
  return double{v.value.x} / dot(to_lamp, to_lamp);
}

TEST(LightSides, ALampThatOnlyNextEventEstimationFinds) {
  int through = 0;
  for (const Case& material : materials::all()) {
    if (material.type->children > 0) continue;  // its parts are here
    for (const bool from_above : {true, false})
      for (const float lamp_z : {1.0f, -1.0f}) {
        const Vec3 lamp = {-0.2f, 0.3f, lamp_z};
        Picture p = plate(std::string(material.name), from_above, 16);
        p.scene.lights.push_back(pictures::point_light(lamp, {1, 1, 1}));
        const double right = by_the_bsdf(material, p, lamp);
        through += right > 0 && from_above != (lamp_z > 0) ? 1 : 0;
        for (const hard::Way& way : hard::full_program_ways())
          EXPECT_NEAR(hard::mean_of(hard::trace(p, way)), right, 2e-3 * right)
              << p.name << ", lamp at " << lamp_z << ", " << way.name();
      }
  }
  EXPECT_GT(through, 0);
}

TEST(LightSides, ASkyFoundByOneStrategyAndByTwo) {
  // A constant sky is met by BSDF samples alone; an image of the same radiance is sampled as well.
  Image ones;
  ones.width = 8;
  ones.height = 4;
  ones.rgb.assign(8 * 4 * 3, 1.0f);
  for (const std::string& material : hard::materials(true))
    for (const bool from_above : {true, false}) {
      Picture one = plate(material, from_above, 64);
      Picture two = one;
      one.scene.lights.push_back(pictures::constant_light({1, 1, 1}));
      two.scene.images.push_back(ones);
      two.scene.lights.push_back(pictures::image_light(0));
      for (const hard::Way& way : hard::full_program_ways()) {
        const pictures::Estimate a = hard::estimate(one, way, 16);
        const pictures::Estimate b = hard::estimate(two, way, 16, 1000);
        EXPECT_NEAR(a.mean, b.mean, 4.5 * std::hypot(a.error, b.error) + 1e-5 * a.mean)
            << one.name << ", " << way.name();
        EXPECT_GT(a.mean, 0.1) << one.name;
        EXPECT_LT(a.error + b.error, 0.02 * a.mean) << one.name;
      }
    }
}

TEST(LightSides, AConeThatOneStrategyFindsAndOneThatTwoDo) {
  // A distant light is found by next-event estimation alone, a sun by scattered rays as well.
  Light cone = make_light("distant");
  cone.color = {2, 2, 2};
  const Vec3d towards = normalized(Vec3d{-0.4, 0.5, 1});
  set_light_value(cone, "direction", to_float(-towards));
  *light_value(cone, "theta") = 25;
  for (const char* material : {"matte", "glossy2", "metal2", "roughglass"}) {
    Picture one = plate(material, true, 64);
    Picture two = one;
    one.scene.lights.push_back(cone);
    two.scene.lights.push_back(pictures::sun_light(to_float(towards), 25, {2, 2, 2}));
    for (const hard::Way& way : hard::full_program_ways()) {
      const pictures::Estimate a = hard::estimate(one, way, 16);
      const pictures::Estimate b = hard::estimate(two, way, 16, 1000);
      EXPECT_NEAR(a.mean, b.mean, 4.5 * std::hypot(a.error, b.error) + 1e-5 * a.mean)
          << material << ", " << way.name();
      EXPECT_GT(a.mean, 0.01) << material;
      EXPECT_LT(a.error + b.error, 0.02 * a.mean) << material;
    }
  }
}

TEST(LightSides, NoMirrorShowsWhatNoPathMeets) {
  for (const char* light : {"sharpdistant", "distant"}) {
    Picture p = plate("mirror", true, 16);
    p.scene.lights.push_back(pictures::light_of_table(light));
    // The mirrored view runs straight into it.
    const Vec3d eye = normalized(p.camera.position);
    set_light_value(p.scene.lights[0], "direction", to_float(Vec3d{eye.x, eye.y, -eye.z}));
    for (const hard::Way& way : hard::full_program_ways())
      EXPECT_EQ(hard::mean_of(hard::trace(p, way)), 0) << light << ", " << way.name();
  }
}

}  // namespace
}  // namespace ds
