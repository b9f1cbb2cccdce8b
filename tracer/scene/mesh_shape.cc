// SPDX-License-Identifier: Apache-2.0
#include "tracer/scene/mesh_shape.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <limits>
#include <tuple>
#include <vector>

namespace ds {
namespace {

constexpr std::size_t k_numbers = std::tuple_size_v<ShapeNumbers>, k_digits = 4;
constexpr double k_most_steps = 65535;

/// A symmetric matrix: xx, yy, zz, xy, xz, yz.
using Symmetric = std::array<double, 6>;

void add(Symmetric& m, Vec3d v, double weight) {
  const Symmetric of{v.x * v.x, v.y * v.y, v.z * v.z, v.x * v.y, v.x * v.z, v.y * v.z};
  for (std::size_t i = 0; i < m.size(); ++i)
    m[i] += weight * of[i];
}

/// By Jacobi's rotations, greatest first; what is negative by rounding is 0.
std::array<double, 3> eigenvalues(const Symmetric& m) {
  double a[3][3] = {{m[0], m[3], m[4]}, {m[3], m[1], m[5]}, {m[4], m[5], m[2]}};
  for (int sweep = 0; sweep < 32; ++sweep)
    for (const auto& [p, q] : {std::pair(0, 1), std::pair(0, 2), std::pair(1, 2)}) {
      if (a[p][q] == 0) continue;
      const double theta = (a[q][q] - a[p][p]) / (2 * a[p][q]);
      const double t = (theta >= 0 ? 1 : -1) / (std::abs(theta) + std::sqrt(theta * theta + 1));
      const double c = 1 / std::sqrt(t * t + 1), s = t * c;
      for (auto& row : a) {
        const double x = row[p], y = row[q];
        row[p] = c * x - s * y;
        row[q] = s * x + c * y;
      }
      for (int k = 0; k < 3; ++k) {
        const double x = a[p][k], y = a[q][k];
        a[p][k] = c * x - s * y;
        a[q][k] = s * x + c * y;
      }
      a[p][q] = a[q][p] = 0;
    }
  std::array<double, 3> values{std::max(a[0][0], 0.0), std::max(a[1][1], 0.0),
                               std::max(a[2][2], 0.0)};
  std::sort(values.rbegin(), values.rend());
  return values;
}

/// By Newton's iteration from above, which stops where it no longer falls: a C library's own is not the same
/// everywhere.
double cube_root(double x) {
  if (x <= 0) return 0;
  double root = std::max(1.0, x);
  for (int i = 0; i < 200; ++i) {
    const double next = root - (root - x / (root * root)) / 3;
    if (!(next < root)) break;
    root = next;
  }
  return root;
}

double fourth_root(double x) {
  return std::sqrt(std::sqrt(std::max(x, 0.0)));
}

/// Gauss and Legendre's four places and weights in [0, 1].
constexpr std::array<double, 4> k_places{0.06943184420297371, 0.33000947820757187,
                                         0.6699905217924281, 0.9305681557970263};
constexpr std::array<double, 4> k_weights{0.17392742256872692, 0.32607257743127307,
                                          0.32607257743127307, 0.17392742256872692};

struct Facet {
  Vec3d a, u, v;  ///< a corner, and from there to the others
  Vec3d across;   ///< cross(u, v)
  double area2;   ///< its length
};

std::vector<Facet> facets_of(const FileMesh& mesh) {
  Vec3d least = mesh.positions.front(), most = least;
  for (const Vec3d p : mesh.positions) {
    least = {std::min(least.x, p.x), std::min(least.y, p.y), std::min(least.z, p.z)};
    most = {std::max(most.x, p.x), std::max(most.y, p.y), std::max(most.z, p.z)};
  }
  const Vec3d side = most - least;
  const double size = std::max({side.x, side.y, side.z});
  std::vector<Facet> facets;
  if (!(size > 0) || !std::isfinite(size)) return facets;
  facets.reserve(mesh.triangles.size());
  const auto at = [&](std::uint32_t i) { return (mesh.positions[i] - least) * (1 / size); };
  for (const auto& t : mesh.triangles) {
    const Vec3d a = at(t[0]), u = at(t[1]) - a, v = at(t[2]) - a, across = cross(u, v);
    const double area2 = length(across);
    if (area2 > 0) facets.push_back({a, u, v, across, area2});
  }
  return facets;
}

/// Sums over the surface.
struct Sums {
  Symmetric xx{}, r2xx{}, r4xx{}, nn{};
  Vec3d r2x{}, r4x{};
  std::array<double, 10> third{};  ///< xxx yyy zzz, then xxy xxz yyx yyz zzx zzy, then xyz
  double h = 0, h2 = 0, h4 = 0, h2r2 = 0;
};

void add_place(Sums& sums, Vec3d x, double h, double weight) {
  const double r2 = dot(x, x);
  add(sums.xx, x, weight);
  add(sums.r2xx, x, weight * r2);
  add(sums.r4xx, x, weight * r2 * r2);
  sums.r2x = sums.r2x + x * (weight * r2);
  sums.r4x = sums.r4x + x * (weight * r2 * r2);
  const std::array<double, 10> third{
      x.x * x.x * x.x, x.y * x.y * x.y, x.z * x.z * x.z, x.x * x.x * x.y, x.x * x.x * x.z,
      x.y * x.y * x.x, x.y * x.y * x.z, x.z * x.z * x.x, x.z * x.z * x.y, x.x * x.y * x.z};
  for (std::size_t i = 0; i < third.size(); ++i)
    sums.third[i] += weight * third[i];
  sums.h2r2 += weight * h * h * r2;
}

/// Exact but for rounding: all that is integrated is of degree 6 at most over a facet.
Sums integrate(const std::vector<Facet>& facets, Vec3d centre, double area2) {
  Sums sums;
  for (const Facet& f : facets) {
    const double share = f.area2 / area2;
    const Vec3d n = f.across * (1 / f.area2);
    const double h = std::abs(dot(n, f.a - centre));
    add(sums.nn, n, share);
    sums.h += share * h;
    sums.h2 += share * h * h;
    sums.h4 += share * h * h * h * h;
    for (std::size_t i = 0; i < k_places.size(); ++i)
      for (std::size_t j = 0; j < k_places.size(); ++j) {
        const double s = k_places[i], t = (1 - s) * k_places[j];
        const Vec3d x = f.a + f.u * s + f.v * t - centre;
        add_place(sums, x, h, share * 2 * (1 - s) * k_weights[i] * k_weights[j]);
      }
  }
  return sums;
}

/// The root of the sum of the squares of all 27.
double size_of_third(const std::array<double, 10>& m) {
  double sum = 0;
  for (std::size_t i = 0; i < m.size(); ++i)
    sum += (i < 3 ? 1 : i < 9 ? 3 : 6) * m[i] * m[i];
  return std::sqrt(sum);
}

}  // namespace

std::string shape_of(const FileMesh& mesh) {
  if (mesh.positions.empty()) return "";
  const std::vector<Facet> facets = facets_of(mesh);
  double area2 = 0;
  Vec3d centre{};
  for (const Facet& f : facets) {
    area2 += f.area2;
    centre = centre + (f.a + (f.u + f.v) * (1.0 / 3)) * f.area2;
  }
  if (!(area2 > 0)) return "";
  centre = centre * (1 / area2);
  const Sums sums = integrate(facets, centre, area2);
  const double size = std::sqrt(sums.xx[0] + sums.xx[1] + sums.xx[2]);
  if (!(size > 0)) return "";
  std::vector<double> numbers;
  for (const double value : eigenvalues(sums.xx))
    numbers.push_back(std::sqrt(value) / size);
  for (const double value : eigenvalues(sums.r2xx))
    numbers.push_back(fourth_root(value) / size);
  for (const double value : eigenvalues(sums.r4xx))
    numbers.push_back(cube_root(std::sqrt(value)) / size);
  const double cubed = size * size * size;
  numbers.push_back(length(sums.r2x) / cubed);
  numbers.push_back(size_of_third(sums.third) / cubed);
  numbers.push_back(length(sums.r4x) / (cubed * size * size));
  for (const double value :
       {std::sqrt(sums.h2), sums.h, fourth_root(sums.h4), fourth_root(sums.h2r2)})
    numbers.push_back(value / size);
  for (const double value : eigenvalues(sums.nn))
    numbers.push_back(std::sqrt(value));
  std::string text;
  for (const double number : numbers)
    fmt::format_to(std::back_inserter(text), "{:04x}",
                   static_cast<unsigned>(
                       std::clamp(std::floor(number * k_shape_steps + 0.5), 0.0, k_most_steps)));
  return text;
}

std::optional<ShapeNumbers> shape_numbers(std::string_view shape) {
  if (shape.size() != k_numbers * k_digits) return std::nullopt;
  ShapeNumbers numbers{};
  const char* at = shape.data();
  for (std::uint16_t& number : numbers) {
    if (std::from_chars(at, at + k_digits, number, 16).ptr != at + k_digits) return std::nullopt;
    at += k_digits;
  }
  return numbers;
}

double shape_distance(const ShapeNumbers& a, const ShapeNumbers& b) {
  int most = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    most = std::max(most, std::abs(a[i] - b[i]));
  return most / k_shape_steps;
}

double shape_distance(std::string_view a, std::string_view b) {
  const auto numbers_a = shape_numbers(a), numbers_b = shape_numbers(b);
  if (!numbers_a || !numbers_b) return std::numeric_limits<double>::infinity();
  return shape_distance(*numbers_a, *numbers_b);
}

}  // namespace ds
