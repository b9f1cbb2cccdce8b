// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/base/vec.h"
#include "tracer/scene/mesh_topology.h"

#include <span>
#include <vector>

namespace ds {

/// Angle in [0, pi] between two vectors, from the length of their cross product and their dot
/// product, with + - * / and sqrt only, so that it has the same bits on every machine. Within 1e-15
/// of atan2; 0 where both are 0. `sine_part` must be at least 0.
double angle_between(double sine_part, double cosine_part);

/// Cosine of an angle in [0, 180] degrees, by the same means; within 1e-15.
double cosine_deg(double degrees);

/// Unit normal of each triangle; zero for one without area.
std::vector<Vec3d> face_normals(std::span<const Vec3d> positions,
                                std::span<const Triangle> triangles);

/// A unit normal for each corner, three a triangle.
///
/// Corners at one place (`welded`, see weld) are in one fan where a chain of shared edges leads
/// from one to the other, each edge between two triangles wound alike whose normals differ by at
/// most `crease_deg`. A corner's normal is the sum, over those corners of its fan whose triangles
/// are within the crease of its own, of unit normal * area * corner angle. So a flipped triangle
/// keeps to itself, and around the tip of a cone the normal still turns. Where the sum does not
/// point to the outer side of the triangle (only with a crease above 90 degrees), the triangle's
/// own normal is taken.
std::vector<Vec3d> smooth_corner_normals(std::span<const Vec3d> positions,
                                         std::span<const Triangle> triangles,
                                         std::span<const std::uint32_t> welded, double crease_deg);

}  // namespace ds
