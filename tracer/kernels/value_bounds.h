// SPDX-License-Identifier: Apache-2.0
// Between what a texture's values lie, for the host, and what operations make of that. No program
// holds this file.
#pragma once

/// The least and the greatest value in each channel. `reached`: each of them is taken somewhere, or may
/// be; else they are outer bounds.
struct ValueBounds {
  Vec3 low, high;
  bool reached = true;

  bool is_constant() const { return low == high; }
};
using MaybeBounds = std::optional<ValueBounds>;

template <typename Function>
Vec3 each_channel(Vec3 a, Vec3 b, Function function) {
  return {function(a.x, b.x), function(a.y, b.y), function(a.z, b.z)};
}
inline float lesser_of(float a, float b) {
  return a < b ? a : b;
}
inline float greater_of(float a, float b) {
  return a > b ? a : b;
}

/// Of what is one here and the other there.
inline MaybeBounds either_bounds(const MaybeBounds& a, const MaybeBounds& b) {
  if (!a || !b) return std::nullopt;
  return ValueBounds{each_channel(a->low, b->low, lesser_of),
                     each_channel(a->high, b->high, greater_of), a->reached && b->reached};
}

/// Of an operation that is monotonic in either operand. The extremes of two textures may lie in different
/// places.
template <typename Operation>
MaybeBounds combined_bounds(const MaybeBounds& a, const MaybeBounds& b, Operation operation) {
  if (!a || !b) return std::nullopt;
  const bool reached = a->reached && b->reached && (a->is_constant() || b->is_constant());
  const auto at = [&](Vec3 from_a, Vec3 from_b) {
    const Vec3 value = each_channel(from_a, from_b, operation);
    return ValueBounds{value, value, reached};
  };
  return either_bounds(either_bounds(at(a->low, b->low), at(a->high, b->high)),
                       either_bounds(at(a->low, b->high), at(a->high, b->low)));
}

/// From `from` to `to` by an amount that is held in [0, 1].
inline MaybeBounds mixed_bounds(const MaybeBounds& amount, const MaybeBounds& from,
                                const MaybeBounds& to) {
  if (!amount || !amount->is_constant()) return either_bounds(from, to);
  const float share = lesser_of(greater_of(amount->low.x, 0.0f), 1.0f);
  return combined_bounds(from, to,
                         [share](float a, float b) { return (1 - share) * a + share * b; });
}

/// Values of all channels in [low, high].
inline MaybeBounds bounds_from_to(double low, double high, bool reached) {
  const auto a = static_cast<float>(low), b = static_cast<float>(high);
  return ValueBounds{{a, a, a}, {b, b, b}, reached};
}

/// Of a sum of octaves of what is within `size`, each `roughness` times the one before: outer ones.
inline MaybeBounds octave_bounds(double size, double least, double octaves, double roughness) {
  double sum = 0, weight = 1, below = 0;
  for (int i = 0; i < static_cast<int>(octaves); ++i) {
    sum += std::fabs(weight) * size;
    // What cannot be negative is so where its weight is.
    below += least < 0 || weight < 0 ? std::fabs(weight) * size : 0;
    weight *= roughness;
  }
  return bounds_from_to(-below, sum, false);
}
