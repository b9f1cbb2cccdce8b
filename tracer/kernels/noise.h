// SPDX-License-Identifier: Apache-2.0
// Gradient noise (Perlin 2002, "Improving Noise") over an integer lattice hashed by arithmetic, not
// by a table: lanes need no gathers, and the pattern has no period of 256.
#pragma once

#include "tracer/kernels/sampler.h"

/// One of Perlin's twelve edge gradients (four of them twice), chosen by the lattice point, times
/// the offset from it.
DS_FN real noise_corner(natural x, natural y, natural z, real dx, real dy, real dz) {
  const natural h = mix_bits(x * 0x8da6b343u + y * 0xd8163841u + z * 0xcb1ab31fu) >> 28;
  const real a = choose(h < 8u, dx, dy);
  const real b = choose(h < 4u, dy, choose((h == 12u) | (h == 14u), dx, dz));
  return choose((h & 1u) != 0u, -a, a) + choose((h & 2u) != 0u, -b, b);
}

/// The lattice's number of a whole coordinate.
DS_FN natural lattice(real whole) {
  return to_natural_bits(to_held_integer(whole));
}

DS_FN real noise_fade(real t) {
  return t * t * t * fma(t, fma(t, (real)(6.0f), (real)(-15.0f)), (real)(10.0f));
}
DS_FN real noise_between(real a, real b, real t) {
  return fma(t, b - a, a);
}

/// In [-1, 1], 0 at lattice points, mean 0. Domain: |coordinate| <= 2^30; beyond it all cells are
/// one.
DS_FN real gradient_noise(real3 p) {
  const real3 cell = vec(floor(p.x), floor(p.y), floor(p.z));
  const real3 d = sub(p, cell);
  const natural x = lattice(cell.x);
  const natural y = lattice(cell.y);
  const natural z = lattice(cell.z);
  const real fx = noise_fade(d.x);
  const real fy = noise_fade(d.y);
  const real fz = noise_fade(d.z);
  const real n00 = noise_between(noise_corner(x, y, z, d.x, d.y, d.z),
                                 noise_corner(x + 1u, y, z, d.x - 1.0f, d.y, d.z), fx);
  const real n10 = noise_between(noise_corner(x, y + 1u, z, d.x, d.y - 1.0f, d.z),
                                 noise_corner(x + 1u, y + 1u, z, d.x - 1.0f, d.y - 1.0f, d.z), fx);
  const real n01 = noise_between(noise_corner(x, y, z + 1u, d.x, d.y, d.z - 1.0f),
                                 noise_corner(x + 1u, y, z + 1u, d.x - 1.0f, d.y, d.z - 1.0f), fx);
  const real n11 =
      noise_between(noise_corner(x, y + 1u, z + 1u, d.x, d.y - 1.0f, d.z - 1.0f),
                    noise_corner(x + 1u, y + 1u, z + 1u, d.x - 1.0f, d.y - 1.0f, d.z - 1.0f), fx);
  return noise_between(noise_between(n00, n10, fy), noise_between(n01, n11, fy), fz);
}

/// Fractal sum: octave o has frequency 1.99^o and weight roughness^o (Musgrave; the lacunarity
/// keeps lattices apart).
DS_FN real fractal_noise(real3 p, real roughness, int octaves) {
  real sum = (real)(0.0f);
  real weight = (real)(1.0f);
  for (int o = 0; o < octaves; ++o) {
    sum = fma(weight, gradient_noise(p), sum);
    p = scale(p, (real)(1.99f));
    weight = weight * roughness;
  }
  return sum;
}
