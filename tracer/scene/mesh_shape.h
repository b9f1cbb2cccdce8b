// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/scene/mesh.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace ds {

/// What a surface looks like whichever way it is turned, mirrored, moved, scaled and cut into triangles: 19
/// numbers, integrals over the surface divided by its area and by powers of its size (the root of the mean
/// square of the distance r to its centre), each a root of its degree, so that all change alike with shape:
///
///   the eigenvalues of the means of x x^T, r^2 x x^T and r^4 x x^T (3 each; x from the centre),
///   the sizes of the mean of r^2 x, of the third moments and of the mean of r^4 x,
///   of the distance h of a place's tangent plane to the centre: roots of the means of h^2, |h|, h^4, h^2 r^2,
///   the eigenvalues of the mean of n n^T (3; n the facet's normal).
///
/// Four hexadecimal digits each, in steps of 1e-4. "" for a mesh without area. In double precision with
/// + - * / and sqrt only: the same digits everywhere. What it tells is kept with what is known of models, so
/// another meaning raises k_mesh_reader_version.
std::string shape_of(const FileMesh& mesh);

/// The most that two of the numbers differ by; infinite where one of them is "" or is no shape.
double shape_distance(std::string_view a, std::string_view b);

/// The numbers, in steps of 1 / k_shape_steps.
using ShapeNumbers = std::array<std::uint16_t, 19>;
inline constexpr double k_shape_steps = 1e4;
/// Nothing for what is no shape.
std::optional<ShapeNumbers> shape_numbers(std::string_view shape);
/// The most that two of them differ by, not in steps.
double shape_distance(const ShapeNumbers& a, const ShapeNumbers& b);

}  // namespace ds
