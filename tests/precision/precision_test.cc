// SPDX-License-Identifier: Apache-2.0
// The precision audit: the kernels in float against the same sources in double, stage by stage, on
// inputs at the ends of their ranges. Prints the worst of each stage; a stage that passes its bound
// fails the test. A bound is in half-ulps of float (2^-24 = 6e-8) times the condition of the
// question: how much the exact answer itself moves when an input or an intermediate value that must
// be rounded moves by one of them.
#include "tests/precision/numbers.h"
#include "tests/precision/stage.h"
#include "tests/render/pictures.h"
#include "tests/tracer/kernels/mix_on_host.h"
#include "tracer/device/scene_pack.h"
#include "tracer/render/pixel_filter.h"
#include "tracer/render/view.h"
#include "tracer/scene/type_tables.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

namespace ds {
namespace {

using namespace audit;

/// A material's inputs with everything at its default but the roughnesses.
std::vector<float> inputs_of(const NodeType& type, float u, float v, Numbers& numbers) {
  std::vector<float> p;
  for (const InputType& input : type.inputs)
    for (int i = 0; i < input.width; ++i)
      p.push_back(input.name == "uroughness"   ? u
                  : input.name == "vroughness" ? v
                  : input.name == "roughness"  ? std::sqrt(u)
                  : input.width == 3 ? input.default_value * (0.2f + 0.8f * numbers.next())
                                     : input.default_value);
  for (const NumberType& number : type.numbers)
    p.push_back(number.default_value);
  return p;
}

std::array<float, 3> above(double cosine, double azimuth) {
  const double s = std::sqrt(1 - cosine * cosine);
  return {static_cast<float>(s * std::cos(azimuth)), static_cast<float>(s * std::sin(azimuth)),
          static_cast<float>(cosine)};
}

/// Of the sum that the half vector of reflection or, below the surface, of refraction is made from:
/// wo + eta wi at the default indices.
struct Half {
  double length = 0;
  double cosine = 0;  ///< of wi to the half vector's line
};
template <typename Direction>
Half half_of(const BsdfQuestion& q, const Direction& wi) {
  const double eta = wi[2] > 0 ? 1 : q.outside ? 1.5 : 1 / 1.5;
  double squares = 0, along = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double sum = double{q.wo[i]} + eta * double{wi[i]};
    squares += sum * sum;
    along += sum * double{wi[i]};
  }
  const double length = std::max(1e-3, std::sqrt(squares));
  return {length, std::fabs(along) / length};
}

/// How near a number is to the ends of [0, 1].
double rim_of(float x) {
  return std::min(double{x}, 1 - double{x});
}

/// velvet's P is a sum of which little may be left: how much greater its terms are. 1 of others.
template <typename Direction>
double cancelled(const NodeType& type, const BsdfQuestion& q, const Direction& wi) {
  if (type.name != "velvet") return 1;
  double c = 0;
  for (std::size_t i = 0; i < 3; ++i)
    c -= double{q.wo[i]} * double{wi[i]};
  const std::array terms{1.0,
                         double{q.inputs[kernels::velvet_p1]} * c,
                         double{q.inputs[kernels::velvet_p2]} * 1.5 * c * c,
                         double{q.inputs[kernels::velvet_p2]} * -0.5,
                         double{q.inputs[kernels::velvet_p3]} * 2.5 * c * c * c,
                         double{q.inputs[kernels::velvet_p3]} * -1.5 * c};
  double sum = 0, sizes = 0;
  for (const double term : terms) {
    sum += term;
    sizes += std::fabs(term);
  }
  return sizes / std::max(1e-6, sum);
}

TEST(Precision, Bsdf) {
  Stage value("bsdf: value and pdf"), weight("bsdf: sample's weight"),
      way("bsdf: sample's direction");
  Numbers numbers(1);
  int choices_differ = 0, asked = 0;
  for (std::size_t row = 0; row < material_types().size(); ++row) {
    const bool mix = material_types()[row].name == "mix";
    const NodeType& type = mix ? kernels::mix_type() : material_types()[row];
    for (const float u : {1e-9f, 1e-3f, 0.03f, 0.1f, 0.3f, 1.0f})
      for (const float v : {u, std::min(1.0f, 2 * u)})
        for (const double cosine : {1.0, 0.7, 0.3, 0.05, 1e-3})
          for (int i = 0; i < 200; ++i) {
            BsdfQuestion q;
            q.material = static_cast<int>(row);
            q.inputs = inputs_of(type, u, v, numbers);
            // Nearer to the ends a part has no place among the choices that are floats.
            for (std::size_t k = 0; mix && k < 2; ++k)
              q.inputs[k] = static_cast<float>(numbers.between(0.01, 0.99));
            q.wo = above(cosine, numbers.between(-3, 3));
            q.outside = i % 2 == 0;
            for (float& n : q.numbers)
              n = numbers.next();
            // Half of the directions anywhere, half where the lobe is.
            q.wi = numbers.direction();
            if (i % 4 < 2) {
              const BsdfAnswer aim = in_double::ask(q);
              for (std::size_t k = 0; k < 3; ++k)
                q.wi[k] = static_cast<float>(aim.sampled[k]);
            }
            const BsdfAnswer f = in_float::ask(q), d = in_double::ask(q);
            ++asked;
            // D falls with (angle of the half vector / alpha)^4. The half vector is made from a sum
            // that is rounded to half-ulps of 1 and may be short, so its angle is known to 2^-24
            // over its length, and ln D to four times that over alpha.
            const double alpha = std::max(1e-3, double{std::min(u, v)});
            // Below the surface the value goes with the cosine of refraction.
            const Half aimed = half_of(q, q.wi);
            const double condition = cancelled(type, q, q.wi) + 1 / (alpha * aimed.length) +
                                     (q.wi[2] < 0 ? 1 / std::max(1e-4, aimed.cosine) : 0);
            const std::string where = fmt::format("{} alpha {} {} cos {}", type.name, u, v, cosine);
            if (greatest(d.value) > 1e-12) value.add(relative(f.value, d.value), condition, where);
            if (d.pdf > 1e-12) value.add(relative(f.pdf, d.pdf), condition, where);
            if (f.valid != d.valid || f.specular != d.specular || f.glossy != d.glossy ||
                distance(f.sampled, d.sampled) > 0.01) {
              ++choices_differ;  // a number on the border between two lobes
              continue;
            }
            if (!d.valid) continue;
            // A disc's height is sqrt(1 - r^2): near the rim, where a number is within n of 0 or 1,
            // half-ulps of 1 become half-ulps over sqrt(n).
            const double rim = std::sqrt(
                std::max(0x1p-24, std::min({rim_of(q.numbers[0]), rim_of(q.numbers[1])})));
            // The cosine of refraction, sqrt(1 - sin^2 / eta^2), does the same to the facet's error near
            // total reflection.
            const Half half = half_of(q, d.sampled);
            const double bend = d.sampled[2] < 0 ? 1 + 1.5 / std::max(1e-4, half.cosine) : 1;
            way.add(distance(f.sampled, d.sampled), (1 + 1 / rim) * bend, where);
            // That turns the direction, whose height the weight is in proportion to.
            const double height = std::max(1e-4, std::fabs(d.sampled[2]));
            weight.add(relative(f.weight, d.weight),
                       1 / (alpha * half.length) +
                           (1 + 1 / rim) * (1 / height + cancelled(type, q, d.sampled) - 1),
                       where);
          }
  }
  // The fits have coefficients of up to 20 that sum to about 1, and glossy2 takes what they give
  // from 1, down to 0.05: 20 times 20 half-ulps at the worst.
  value.expect_within(256);
  way.expect_within(12);
  weight.expect_within(12);
  EXPECT_LT(choices_differ, asked / 1000);
}

/// A scene of one light, packed.
class Packed {
 public:
  explicit Packed(const Scene& scene) {
    const PackedScene packed = pack_scene(scene, scene_effects(scene, Camera{}), BvhQuality::low);
    for (const auto& [from, to] : {std::pair{&packed.lights, &lights},
                                   {&packed.tables, &tables},
                                   {&packed.triangles, &triangles}})
      for (const std::uint32_t word : from->words())
        to->push_back(std::bit_cast<float>(word));
  }
  std::vector<float> lights, tables, triangles;
};

Scene triangle_scene() {
  Scene scene;
  pictures::add_object(scene, pictures::quad({0, 0, 0}, {0.5f, 0, 0}, {0, 0.5f, 0}),
                       pictures::add_matte(scene, {1, 1, 1}));
  return scene;
}

Scene scene_of(const LightType& type) {
  Scene scene = triangle_scene();
  if (type.kernel_prefix == "point") {
    scene.lights.push_back(pictures::point_light({0.2f, 0.1f, 1}, {3, 2, 1}));
  } else if (type.kernel_prefix == "spot") {
    scene.lights.push_back(pictures::spot_light({0.2f, 0.1f, 1}, {0.1f, 0, -1}, 35, 20, {3, 2, 1}));
  } else if (type.kernel_prefix == "mesh") {
    scene.materials[0].emits = true;
    scene.materials[0].emission.constant = {3, 2, 1};
  } else if (type.kernel_prefix == "sun") {
    scene.lights.push_back(pictures::sun_light({0.3f, -0.4f, 0.7f}, 0.265, {5, 4, 3}));
  } else {
    pictures::add_light(scene, type.kernel_prefix);
  }
  return scene;
}

/// What the spot of scene_of gives on its axis at the question's distance.
double unramped(const LightQuestion& q) {
  const double squared = std::pow(double{q.from[0]} - 0.2, 2) +
                         std::pow(double{q.from[1]} - 0.1, 2) + std::pow(double{q.from[2]} - 1, 2);
  return 3 / squared;
}

TEST(Precision, Lights) {
  Stage way("light: direction"), radiance("light: radiance"), pdf("light: pdf"),
      escape("light: radiance of what escapes");
  Numbers numbers(2);
  int borders = 0, asked = 0;
  for (const LightType& type : light_types()) {
    const Packed packed(scene_of(type));
    const bool image = (type.host.made_by & kernels::k_host_panorama) != 0;
    const bool spot = type.kernel_prefix == "spot", mesh = type.kernel_prefix == "mesh";
    for (int i = 0; i < 20000; ++i) {
      LightQuestion q;
      q.light = static_cast<int>(&type - light_types().data());
      q.lights = &packed.lights;
      q.tables = &packed.tables;
      q.triangles = &packed.triangles;
      const double far = i % 3 == 0 ? 1e-3 : i % 3 == 1 ? 1 : 1e4;
      const std::array<float, 3> from = numbers.direction();
      for (std::size_t k = 0; k < 3; ++k)
        q.from[k] = static_cast<float>(double{from[k]} * far) + (k == 2 ? -1e-3f : 0);
      for (float& n : q.numbers)
        n = numbers.next();
      q.direction = numbers.direction();
      const LightAnswer f = in_float::ask(q), d = in_double::ask(q);
      ++asked;
      const std::string where = fmt::format("{} at {:g} m", type.kernel_prefix, far);
      // On a cell's border, or on a disc's rim, a rounding decides between two answers.
      if ((f.pdf > 0) != (d.pdf > 0) || (image && relative(f.pdf, d.pdf) > 0.01) ||
          (f.escape_pdf > 0) != (d.escape_pdf > 0) ||
          (image && relative(f.escape_pdf, d.escape_pdf) > 0.01)) {
        ++borders;
        continue;
      }
      // A point of an image's cell is found by a number less its row's share, which is 1/300 or so:
      // known to 300 half-ulps of 1. From there to the next column a sky's radiance may rise a
      // thousandfold.
      const double found = image ? 300 : 1;
      if (d.pdf > 0) {
        way.add(distance(f.wi, d.wi), found, where);
        // The spot's ramp goes to nothing, where no difference is small beside it: beside its
        // strength without the ramp, then, of which 0.12 of cosine take it to the fourth power.
        const double strength = spot ? unramped(q) : greatest(d.radiance);
        radiance.add(greatest({f.radiance[0] - d.radiance[0], f.radiance[1] - d.radiance[1],
                               f.radiance[2] - d.radiance[2]}) /
                         strength,
                     image  ? found * 1000
                     : spot ? 4 / 0.12
                            : 1,
                     where);
        // A mesh's pdf is over the cosine at the light, an image's over the sine from its pole.
        const double under = mesh ? std::fabs(d.wi[2]) : image ? std::hypot(d.wi[0], d.wi[1]) : 1;
        pdf.add(relative(f.pdf, d.pdf), found / std::max(under, 1e-6), where);
      }
      // A place in the image is known to half-ulps of its width; the disc of a sun has none.
      if (has_trait(type, kernels::k_trait_beyond))
        escape.add(relative(f.escape, d.escape), image ? 19 * 1000 : 1, where);
    }
  }
  way.expect_within(4);
  radiance.expect_within(8);
  pdf.expect_within(8);
  escape.expect_within(1);
  EXPECT_LT(borders, asked / 200);
}

/// What the window has over each half pixel, by integrals in closed form with libm's sine.
TEST(Precision, Filter) {
  Stage weights("filter: weights of half pixels");
  for (int k = 0; k <= 100; ++k) {
    const double width = 1.25 + 14.75 * k / 100;
    const PixelFilter filter(static_cast<float>(width));
    const auto until = [&](std::size_t half) {
      const double from_centre = double(half) / 2 - double(filter.reach()) - 0.5;
      const double x = std::clamp(from_centre / width + 0.5, 0.0, 1.0) * 2 * M_PI;
      return (0.35875 * x - 0.48829 * std::sin(x) + 0.14128 / 2 * std::sin(2 * x) -
              0.01168 / 3 * std::sin(3 * x)) /
             (0.35875 * 2 * M_PI);
    };
    for (std::size_t i = 0; i < filter.weights().size(); ++i)
      weights.add(std::fabs(filter.weights()[i] - (until(i + 1) - until(i))), 1,
                  fmt::format("width {:g}", width));
  }
  // Two sines of an error of 2e-7 each, which is 3.4 half-ulps, times 0.22, and two of less.
  weights.expect_within(2);
}

TEST(Precision, Camera) {
  Stage origin("camera: origin on the lens"), direction("camera: direction");
  Numbers numbers(3);
  for (const int size : {1, 17, 512, 16384})
    for (const double fov : {0.01, 49.0, 179.0}) {
      Camera camera;
      camera.position = {0.3, -2.6, 1.5};
      camera.fov_deg = fov;
      camera.lens_radius_m = 0.05;
      camera.focus_distance_m = 2.6;
      EngineSettings engine;
      engine.width = engine.height = size;
      const kernels::ViewData view = view_data(camera, engine);
      for (int i = 0; i < 2000; ++i) {
        CameraQuestion q;
        std::memcpy(q.view.data(), &view, sizeof(view));
        for (float& x : q.place)
          x = static_cast<float>(numbers.bits() % static_cast<unsigned>(size)) + numbers.next();
        for (float& n : q.lens_numbers)
          n = numbers.next();
        const CameraAnswer f = in_float::ask(q), d = in_double::ask(q);
        const std::string where = fmt::format("{} pixels, {} degrees", size, fov);
        origin.add(distance(f.origin, d.origin), 2.6, where);
        // A pixel's place is a float of up to `size`, its half-ulp 2^-24 of the whole picture,
        // which spans 2 tan(fov / 2) of the direction before that is made a unit vector.
        direction.add(distance(f.direction, d.direction), 1 + 2 * std::tan(fov * M_PI / 360),
                      where);
      }
    }
  origin.expect_within(2);
  direction.expect_within(4);
}

TEST(Precision, Sum) {
  // A pixel that looks at the sky: the host makes the very samples of the device (the same
  // headers, the same bits) and adds them in double.
  Stage sum("sum: of a pixel's samples");
  pictures::Picture p;
  p.scene = triangle_scene();
  p.scene.images.push_back(pictures::small_sky());
  p.scene.lights.push_back(pictures::image_light(0));
  p.camera.position = {0, 0, 3};
  p.camera.target = {1, 0.2, 3.4};
  p.camera.fov_deg = 100;
  p.engine.width = p.engine.height = 12;
  p.engine.spp = 4096;
  p.engine.filter_width = 0;
  p.engine.seed = 0x0123456789abcdefu;
  const Film film = pictures::trace(p);
  const Packed packed(p.scene);
  const kernels::ViewData view = view_data(p.camera, p.engine);
  SkyQuestion q;
  std::memcpy(q.view.data(), &view, sizeof(view));
  q.lights = &packed.lights;
  q.tables = &packed.tables;
  for (q.y = 0; q.y < 12; ++q.y)
    for (q.x = q.y % 3; q.x < 12; q.x += 3) {
      Three exact{};
      for (q.sample = 0; q.sample < 4096; ++q.sample) {
        const Three radiance = in_float::ask(q);
        for (std::size_t c = 0; c < 3; ++c)
          exact[c] += radiance[c] / 4096;
      }
      for (std::size_t c = 0; c < 3; ++c)
        sum.add(relative(double{film.rgb[3 * (q.y * 12 + q.x) + c]}, exact[c]), 1,
                fmt::format("pixel {}, {}", q.x, q.y));
    }
  // The film's own rounding is one half-ulp; what is summed beside the sum is rounded itself, 4096
  // times, in half-ulps of half-ulps.
  sum.expect_within(1.5);
}

}  // namespace
}  // namespace ds
