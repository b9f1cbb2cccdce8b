// SPDX-License-Identifier: Apache-2.0
// Gradient noise (after Perlin 2002, "Improving Noise") over an integer lattice hashed by
// arithmetic, not by a table: lanes need no gathers, and the pattern has no period of 256.
#pragma once

#include "tracer/kernels/sampler.h"

/// A lattice point's number: its coordinates times odd constants, so that a neighbour's is one
/// addition away.
enum { k_noise_x = 0x4da6b343, k_noise_y = 0x18163841, k_noise_z = 0x4b1ab31f };

/// Three random bits of a lattice point, the uppermost: those of a square, nearly, which depend on
/// all below.
DS_FN natural noise_signs(natural point) {
  const natural h = point ^ (point >> 15);
  return h * (h | 1u);
}

/// The point's gradient, one of the cube's eight diagonals by these signs, times the offset from
/// it.
DS_FN real noise_corner(natural point, real dx, real dy, real dz) {
  const natural signs = noise_signs(point);
  return choose((signs & 0x80000000u) != 0u, -dx, dx) +
         choose((signs & 0x40000000u) != 0u, -dy, dy) +
         choose((signs & 0x20000000u) != 0u, -dz, dz);
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

/// Within [-1.23, 1.23], hardly ever beyond 1; 0 at lattice points, mean 0, variance that of
/// Perlin's twelve gradients. Domain: |coordinate| <= 2^30; beyond it all cells are one.
DS_FN real gradient_noise(real3 p) {
  const real3 cell = vec(floor(p.x), floor(p.y), floor(p.z));
  const real3 d = sub(p, cell);
  const natural p000 = lattice(cell.x) * (uint)k_noise_x + lattice(cell.y) * (uint)k_noise_y +
                       lattice(cell.z) * (uint)k_noise_z;
  const natural p010 = p000 + (uint)k_noise_y;
  const natural p001 = p000 + (uint)k_noise_z;
  const natural p011 = p010 + (uint)k_noise_z;
  const real3 e = sub(d, splat((real)(1.0f)));
  const real fx = noise_fade(d.x);
  const real fy = noise_fade(d.y);
  const real fz = noise_fade(d.z);
  const real n00 = noise_between(noise_corner(p000, d.x, d.y, d.z),
                                 noise_corner(p000 + (uint)k_noise_x, e.x, d.y, d.z), fx);
  const real n10 = noise_between(noise_corner(p010, d.x, e.y, d.z),
                                 noise_corner(p010 + (uint)k_noise_x, e.x, e.y, d.z), fx);
  const real n01 = noise_between(noise_corner(p001, d.x, d.y, e.z),
                                 noise_corner(p001 + (uint)k_noise_x, e.x, d.y, e.z), fx);
  const real n11 = noise_between(noise_corner(p011, d.x, e.y, e.z),
                                 noise_corner(p011 + (uint)k_noise_x, e.x, e.y, e.z), fx);
  const real between = noise_between(noise_between(n00, n10, fy), noise_between(n01, n11, fy), fz);
  return between * 0.81649658f;  // sqrt(2/3): the gradients are sqrt(3) long, Perlin's sqrt(2)
}

#ifdef DS_HOOK_HOST
/// No gradient noise is greater: that in a cell's middle with all gradients towards it.
inline constexpr double k_noise_size = 1.2248;
#endif

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
