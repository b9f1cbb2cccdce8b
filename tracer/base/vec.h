// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>

namespace ds {

/// Host-side vectors. Metres where they are positions; world frame is right-handed with Z up.
template <typename T>
struct BasicVec3 {
  T x{}, y{}, z{};

  friend BasicVec3 operator+(BasicVec3 a, BasicVec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend BasicVec3 operator-(BasicVec3 a, BasicVec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend BasicVec3 operator*(BasicVec3 a, BasicVec3 b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
  friend BasicVec3 operator*(BasicVec3 a, T s) { return {a.x * s, a.y * s, a.z * s}; }
  friend BasicVec3 operator*(T s, BasicVec3 a) { return a * s; }
  BasicVec3 operator-() const { return {-x, -y, -z}; }
  bool operator==(const BasicVec3&) const = default;
  T operator[](int axis) const { return axis == 0 ? x : axis == 1 ? y : z; }
};
using Vec3 = BasicVec3<float>;
using Vec3d = BasicVec3<double>;

struct Vec2 {
  float x = 0, y = 0;
  bool operator==(const Vec2&) const = default;
};

template <typename T>
T dot(BasicVec3<T> a, BasicVec3<T> b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <typename T>
BasicVec3<T> cross(BasicVec3<T> a, BasicVec3<T> b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <typename T>
T length(BasicVec3<T> a) {
  return std::sqrt(dot(a, a));
}
/// Unit vector; the zero vector (and any whose squared length underflows) gives the zero vector.
template <typename T>
BasicVec3<T> normalized(BasicVec3<T> a) {
  const T l = length(a);
  return l > T(0) ? a * (T(1) / l) : BasicVec3<T>{};
}
inline Vec3d to_double(Vec3 a) {
  return {double{a.x}, double{a.y}, double{a.z}};
}
inline Vec3 to_float(Vec3d a) {
  return {static_cast<float>(a.x), static_cast<float>(a.y), static_cast<float>(a.z)};
}

/// 4x4 affine matrix, row-major, column vectors: p' = M p.
struct Mat4 {
  std::array<double, 16> m{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  bool operator==(const Mat4&) const = default;

  friend Mat4 operator*(const Mat4& a, const Mat4& b) {
    Mat4 r;
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = 0; j < 4; ++j) {
        double sum = 0;
        for (std::size_t k = 0; k < 4; ++k)
          sum += a.m[i * 4 + k] * b.m[k * 4 + j];
        r.m[i * 4 + j] = sum;
      }
    return r;
  }
  Vec3d point(Vec3d p) const {
    return {m[0] * p.x + m[1] * p.y + m[2] * p.z + m[3],
            m[4] * p.x + m[5] * p.y + m[6] * p.z + m[7],
            m[8] * p.x + m[9] * p.y + m[10] * p.z + m[11]};
  }
  Vec3d direction(Vec3d d) const {
    return {m[0] * d.x + m[1] * d.y + m[2] * d.z, m[4] * d.x + m[5] * d.y + m[6] * d.z,
            m[8] * d.x + m[9] * d.y + m[10] * d.z};
  }
};

}  // namespace ds
