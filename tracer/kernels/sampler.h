// SPDX-License-Identifier: Apache-2.0
// Hash-based Owen-scrambled Sobol' points (Burley 2020, "Practical Hash-based Owen Scrambling",
// JCGT 9(4)): every number is a pure function of seed, pixel, sample and dimension. Dimensions come
// in pairs; each pair is the (0,2)-sequence of Sobol's first two dimensions, its order shuffled and
// its digits scrambled by hashes of its own ("padding").
#pragma once

#include "tracer/kernels/math.h"

typedef struct {
  real x, y;
} real2;

typedef struct {
  natural reversed_index;  ///< bits of the sample's number, most significant first
  natural seed;            ///< of image and pixel
} Sampler;

/// A 32-bit permutation that mixes every bit (lowbias32; constants found by Wellons 2018).
DS_FN natural mix_bits(natural x) {
  x ^= x >> 16;
  x *= 0x7feb352du;
  x ^= x >> 15;
  x *= 0x846ca68bu;
  x ^= x >> 16;
  return x;
}

DS_FN natural reverse_bits(natural x) {
  x = ((x >> 1) & 0x55555555u) | ((x & 0x55555555u) << 1);
  x = ((x >> 2) & 0x33333333u) | ((x & 0x33333333u) << 2);
  x = ((x >> 4) & 0x0f0f0f0fu) | ((x & 0x0f0f0f0fu) << 4);
  x = ((x >> 8) & 0x00ff00ffu) | ((x & 0x00ff00ffu) << 8);
  return (x >> 16) | (x << 16);
}

/// Owen scrambling of a number whose digits stand least significant first: bit k is changed by bits
/// below k alone (Laine and Karras 2011, with the constants of Vegdahl 2021).
DS_FN natural scramble_reversed(natural x, natural seed) {
  x ^= x * 0x3d20adeau;
  x += seed;
  x *= (seed >> 16) | 1u;
  x ^= x * 0x05526c56u;
  x ^= x * 0x53a22864u;
  return x;
}

/// Sobol's second dimension of index i, digits least significant first. Its generator matrix is
/// Pascal's triangle mod 2, and C(k, j) is odd where the bits of j are a subset of k's (Lucas), so
/// the product is five exclusive-or steps.
DS_FN natural sobol_second_reversed(natural i) {
  i ^= (i >> 1) & 0x55555555u;
  i ^= (i >> 2) & 0x33333333u;
  i ^= (i >> 4) & 0x0f0f0f0fu;
  i ^= (i >> 8) & 0x00ff00ffu;
  i ^= (i >> 16) & 0x0000ffffu;
  return i;
}

/// The 24 leading digits as a number in [0, 1).
DS_FN real unit_interval(natural digits) {
  return to_real(digits >> 8) * 5.9604644775390625e-8f;
}

/// The sampler of a sample of a pixel. Even and odd samples are two sequences scrambled
/// independently of each other: their difference tells the error of their mean (render.h,
/// Film::relative_error). `seed_low`, `seed_high`: of the image. `pixel`: y * width + x. `sample`:
/// from 0, below 2^32.
DS_FN Sampler sampler_for(uint seed_low, uint seed_high, natural pixel, natural sample) {
  Sampler s;
  s.reversed_index = reverse_bits(sample >> 1);
  s.seed = mix_bits(mix_bits(pixel ^ seed_low) ^ seed_high) ^ ((sample & 1u) * 0x6a09e667u);
  return s;
}

/// The point of dimensions 2 `pair` and 2 `pair` + 1, in [0, 1)^2.
DS_FN real2 sample_pair(Sampler s, natural pair) {
  const natural key = mix_bits(s.seed + pair * 0x9e3779b9u);
  const natural index = reverse_bits(scramble_reversed(s.reversed_index, key));
  real2 p;
  p.x = unit_interval(reverse_bits(scramble_reversed(index, key * 0x85ebca6bu + 0x27d4eb2fu)));
  p.y = unit_interval(reverse_bits(
      scramble_reversed(sobol_second_reversed(index), key * 0xc2b2ae35u + 0x165667b1u)));
  return p;
}

/// Shirley and Chiu 1997, "A Low Distortion Map Between Disk and Square"; the unit disc.
DS_FN real2 concentric_disc(real2 u) {
  const real a = 2.0f * u.x - 1.0f;
  const real b = 2.0f * u.y - 1.0f;
  const mask wide = a * a > b * b;
  const real radius = choose(wide, a, b);
  const real other = choose(wide, b, a);
  const real ratio =
      choose(radius == 0.0f, (real)(0.0f), other / choose(radius == 0.0f, (real)(1.0f), radius));
  const real turns = ratio * 0.125f;
  real2 p;
  // Along x: angle ratio pi/4 from the x axis; along y: the same from the y axis.
  const real angle = choose(wide, turns, 0.25f - turns);
  const SinCos sc = sin_cos_turns(angle);
  p.x = radius * sc.cos;
  p.y = radius * sc.sin;
  return p;
}
