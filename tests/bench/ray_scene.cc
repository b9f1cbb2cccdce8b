// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/ray_scene.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>

namespace ds {
namespace {

constexpr int k_face_cells = 65;  // 6 faces * 65^2 cells * 2 triangles = 50,700
constexpr double k_ground_size = 20;
constexpr float k_farthest = 1e30f;

/// A direction's distance from the centre: five octaves of waves, so that there are large and small
/// bumps.
double bumpy_radius(Vec3d d) {
  double height = 0, amplitude = 0.16, frequency = 3;
  for (int octave = 0; octave < 5; ++octave) {
    height += amplitude * std::sin(frequency * d.x + 1.3 * octave) *
              std::sin(frequency * d.y + 2.1 * octave) * std::sin(frequency * d.z + 0.7 * octave);
    amplitude *= 0.55;
    frequency *= 2.1;
  }
  return 1 + height;
}

/// Point (i, j) of the grid on a cube's face, moved onto the ball.
Vec3 face_point(int face, int i, int j) {
  const double a = std::tan((2.0 * i / k_face_cells - 1) * std::numbers::pi / 4);
  const double b = std::tan((2.0 * j / k_face_cells - 1) * std::numbers::pi / 4);
  const double side = face % 2 == 0 ? 1 : -1;
  const Vec3d cube = face / 2 == 0   ? Vec3d{side, a, b}
                     : face / 2 == 1 ? Vec3d{a, side, b}
                                     : Vec3d{a, b, side};
  const Vec3d direction = normalized(cube);
  return to_float(direction * bumpy_radius(direction));
}

Vec3 face_normal(const Corners& c) {
  return normalized(cross(c[1] - c[0], c[2] - c[0]));
}

}  // namespace

std::vector<Corners> ray_scene() {
  std::vector<Corners> triangles;
  float lowest = 0;
  for (int face = 0; face < 6; ++face)
    for (int j = 0; j < k_face_cells; ++j)
      for (int i = 0; i < k_face_cells; ++i) {
        const Vec3 p00 = face_point(face, i, j), p10 = face_point(face, i + 1, j);
        const Vec3 p01 = face_point(face, i, j + 1), p11 = face_point(face, i + 1, j + 1);
        triangles.push_back({p00, p10, p11});
        triangles.push_back({p00, p11, p01});
        lowest = std::min({lowest, p00.z, p10.z, p01.z, p11.z});
      }
  const float g = k_ground_size;
  triangles.push_back({Vec3{-g, -g, lowest}, Vec3{g, -g, lowest}, Vec3{g, g, lowest}});
  triangles.push_back({Vec3{-g, -g, lowest}, Vec3{g, g, lowest}, Vec3{-g, g, lowest}});
  return triangles;
}

std::vector<RayWords> camera_rays(int size) {
  const Vec3d position{2.2, 1.6, 1.3};
  const Vec3d forward = normalized(-position);
  const Vec3d right = normalized(cross(forward, Vec3d{0, 0, 1}));
  const Vec3d up = cross(right, forward);
  const double half = std::tan(49 * std::numbers::pi / 360);
  std::vector<RayWords> rays;
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      const double sx = half * (2 * (x + 0.5) / size - 1), sy = half * (1 - 2 * (y + 0.5) / size);
      const Vec3 d = to_float(normalized(forward + right * sx + up * sy));
      const Vec3 o = to_float(position);
      rays.push_back({o.x, o.y, o.z, d.x, d.y, d.z, k_farthest});
    }
  return rays;
}

std::vector<RayWords> bounce_rays(const std::vector<Corners>& triangles,
                                  const std::vector<RayWords>& rays, const std::vector<Met>& met) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<RayWords> bounces;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (!met[i].any) continue;
    const RayWords& r = rays[i];
    const Vec3 direction{r[3], r[4], r[5]};
    Vec3 normal = face_normal(triangles[met[i].triangle]);
    if (dot(normal, direction) > 0) normal = -normal;
    const Vec3 origin = Vec3{r[0], r[1], r[2]} + direction * met[i].t + normal * 1e-4f;
    // A point on the unit sphere about the normal's tip is cosine-distributed seen from its foot.
    const double z = 1 - 2 * uniform(random), angle = 2 * std::numbers::pi * uniform(random);
    const double radius = std::sqrt(std::max(0.0, 1 - z * z));
    const Vec3d sphere{radius * std::cos(angle), radius * std::sin(angle), z};
    const Vec3 d = to_float(normalized(to_double(normal) + sphere));
    bounces.push_back({origin.x, origin.y, origin.z, d.x, d.y, d.z, k_farthest});
  }
  return bounces;
}

}  // namespace ds
