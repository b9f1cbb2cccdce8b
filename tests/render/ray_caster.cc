// SPDX-License-Identifier: Apache-2.0
#include "tests/render/ray_caster.h"

#include "manifests/camera_geometry.h"
#include "tracer/scene/sdl.h"
#include "tracer/scene/type_tables.h"

#include <algorithm>
#include <cmath>

namespace ds::ray_caster {
namespace {

template <typename Value>
Vec3d between(const std::vector<Value>& corners, const std::array<std::uint32_t, 3>& triangle,
              double b1, double b2) {
  return to_double(corners[triangle[0]]) * (1 - b1 - b2) + to_double(corners[triangle[1]]) * b1 +
         to_double(corners[triangle[2]]) * b2;
}

/// Moeller and Trumbore 1997.
void meet(const Object& object, int index, Vec3d from, Vec3d way, Hit& nearest) {
  const Mesh& mesh = object.mesh;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto& triangle = mesh.triangles[i];
    const Vec3d p0 = to_double(mesh.positions[triangle[0]]);
    const Vec3d e1 = to_double(mesh.positions[triangle[1]]) - p0;
    const Vec3d e2 = to_double(mesh.positions[triangle[2]]) - p0;
    const Vec3d s = from - p0, p = cross(way, e2), q = cross(s, e1);
    const double determinant = dot(e1, p);
    if (determinant == 0) continue;
    const double b1 = dot(s, p) / determinant, b2 = dot(way, q) / determinant;
    const double t = dot(e2, q) / determinant;
    const double margin = std::min({b1, b2, 1 - b1 - b2});
    if (margin < 0 || t <= 0 || (nearest.object >= 0 && t >= nearest.depth)) continue;
    Hit hit{index, t, t * length(way),     from + way * t, {}, {}, -normalized(way),
            0,     0, static_cast<int>(i), margin};
    const Vec3d normal = normalized(cross(e1, e2));
    const double side = dot(normal, way) < 0 ? 1 : -1;
    hit.normal = hit.shading = normal * side;
    if (!mesh.normals.empty()) {
      const Vec3d stored = normalized(between(mesh.normals, triangle, b1, b2));
      hit.shading = stored * (dot(stored, hit.normal) < 0 ? -1.0 : 1.0);
    }
    if (!mesh.uvs.empty()) {
      const Vec2 a = mesh.uvs[triangle[0]], b = mesh.uvs[triangle[1]], c = mesh.uvs[triangle[2]];
      hit.u = double{a.x} * (1 - b1 - b2) + double{b.x} * b1 + double{c.x} * b2;
      hit.v = double{a.y} * (1 - b1 - b2) + double{b.y} * b1 + double{c.y} * b2;
    }
    nearest = hit;
  }
}

struct Ray {
  Vec3d from, way;
};

/// From the camera's axes to the world's.
Vec3d turned(const std::array<double, 16>& m, Vec3d v) {
  return {m[0] * v.x + m[1] * v.y + m[2] * v.z, m[4] * v.x + m[5] * v.y + m[6] * v.z,
          m[8] * v.x + m[9] * v.y + m[10] * v.z};
}

/// `ray_through(x, y)`: pixels, from the picture's top left corner.
template <typename RayThrough>
std::vector<Hit> cast_rays(const std::vector<Object>& objects, const std::vector<bool>& sees,
                           int width, int height, const RayThrough& ray_through) {
  std::vector<Hit> hits;
  for (int i = 0; i < width * height; ++i) {
    const Ray ray = ray_through(i % width + 0.5, i / width + 0.5);
    Hit& nearest = hits.emplace_back();
    for (std::size_t o = 0; o < objects.size(); ++o)
      if (sees[o]) meet(objects[o], static_cast<int>(o), ray.from, ray.way, nearest);
  }
  return hits;
}

}  // namespace

std::vector<Hit> cast(const std::vector<Object>& objects, const std::vector<bool>& sees,
                      const std::array<double, 9>& k, const std::array<double, 16>& m, int width,
                      int height) {
  const Vec3d from{m[3], m[7], m[11]};
  return cast_rays(objects, sees, width, height, [&](double column, double row) {
    // OpenCV's axes: x right, y down, z forward; z of the way is 1, so t is the planar depth.
    const double x = (column - k[2]) / k[0], y = (row - k[5]) / k[4];
    return Ray{from, turned(m, {x, y, 1})};
  });
}

std::vector<Hit> cast_parallel(const std::vector<Object>& objects, const std::vector<bool>& sees,
                               double metres_per_pixel, const std::array<double, 16>& m, int width,
                               int height) {
  return cast_rays(objects, sees, width, height, [&](double column, double row) {
    const Vec3d aside{(column - width / 2.0) * metres_per_pixel,
                      (row - height / 2.0) * metres_per_pixel, 0};
    return Ray{Vec3d{m[3], m[7], m[11]} + turned(m, aside), turned(m, {0, 0, 1})};
  });
}

namespace {

std::vector<Hit> cast_those(const Scene& scene, const Camera& camera, int width, int height,
                            bool (*seen)(const Object&)) {
  std::vector<bool> sees;
  for (const Object& object : scene.objects)
    sees.push_back(seen(object));
  if (type_of(camera).host.span == kernels::CameraSpan::extent_m)
    return cast_parallel(scene.objects, sees, camera.extent_m / std::max(width, height),
                         camera_pose(camera), width, height);
  return cast(scene.objects, sees, camera_intrinsics(camera.fov_deg, width, height),
              camera_pose(camera), width, height);
}

}  // namespace

std::vector<Hit> cast(const Scene& scene, const Camera& camera, int width, int height) {
  return cast_those(scene, camera, width, height,
                    [](const Object& object) { return !object.camera_invisible; });
}

std::vector<Hit> cast_model(const Scene& scene, const Camera& camera, int width, int height) {
  return cast_those(scene, camera, width, height,
                    [](const Object& object) { return object.id == k_model_object_id; });
}

}  // namespace ds::ray_caster
