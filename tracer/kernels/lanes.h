// SPDX-License-Identifier: Apache-2.0
// One work-item carries DS_LANES paths side by side. Shading code is written once in these types
// and reads like the equations; which lanes a line applies to is said by a mask and `choose`.
//
//   real, integer, natural   float, int and uint, DS_LANES wide
//   mask                     what comparisons give: combine with & | !
//   choose(m, a, b)          a where m, else b, lane by lane
//   any_lane(m)              true where at least one lane is set
//   load(p, i)               p[i], each lane with its own index
//   to_natural_bits(i)       an integer's two's complement bits
#pragma once

#include "tracer/kernels/language.h"

#ifndef DS_LANES
#  define DS_LANES 1
#endif

#if DS_LANES == 1

#  ifdef __OPENCL_VERSION__
typedef float real;
typedef int integer;
typedef uint natural;
typedef int mask;
#  else
#    ifdef DS_REAL_DOUBLE
// Only the precision audit's build (tests/precision): tables and constants stay floats.
using real = double;
#    else
using real = float;
#    endif
using integer = int;
using natural = uint;
using mask = bool;
#  endif
#  define DS_LANE_NUMBERS 0u
DS_FN real to_real(natural x) {
  return (real)x;
}
DS_FN real to_real(integer x) {
  return (real)x;
}
DS_FN integer to_integer(real x) {
  return (integer)x;
}
DS_FN natural to_natural(real x) {
  return (natural)x;
}
DS_FN natural to_natural_bits(integer x) {
  return (natural)x;
}
DS_FN natural bits_of(real x) {
  return as_uint((float)x);
}
DS_FN real real_of(natural x) {
  return as_float(x);
}
DS_FN bool any_lane(mask m) {
  return m != 0;
}
DS_FN real load(DS_GLOBAL float* p, natural i) {
  return p[i];
}

#else

#  define DS_JOIN_(a, b) a##b
#  define DS_JOIN(a, b) DS_JOIN_(a, b)
typedef DS_JOIN(float, DS_LANES) real;
typedef DS_JOIN(int, DS_LANES) integer;
typedef DS_JOIN(uint, DS_LANES) natural;
typedef DS_JOIN(int, DS_LANES) mask;
DS_FN real to_real(natural x) {
  return DS_JOIN(convert_float, DS_LANES)(x);
}
DS_FN real to_real(integer x) {
  return DS_JOIN(convert_float, DS_LANES)(x);
}
DS_FN integer to_integer(real x) {
  return DS_JOIN(convert_int, DS_LANES)(x);
}
DS_FN natural to_natural(real x) {
  return DS_JOIN(convert_uint, DS_LANES)(x);
}
DS_FN natural to_natural_bits(integer x) {
  return DS_JOIN(as_uint, DS_LANES)(x);
}
DS_FN natural bits_of(real x) {
  return DS_JOIN(as_uint, DS_LANES)(x);
}
DS_FN real real_of(natural x) {
  return DS_JOIN(as_float, DS_LANES)(x);
}

// A mask's lanes are 0 or -1; narrowed to bytes they are one integer that is tested at once.
#  if DS_LANES == 4
#    define DS_LANE_NUMBERS ((uint4)(0, 1, 2, 3))
DS_FN bool any_lane(mask m) {
  return as_uint(convert_char4(m)) != 0;
}
DS_FN real load(DS_GLOBAL float* p, natural i) {
  return (real)(p[i.s0], p[i.s1], p[i.s2], p[i.s3]);
}
#  elif DS_LANES == 8
#    define DS_LANE_NUMBERS ((uint8)(0, 1, 2, 3, 4, 5, 6, 7))
DS_FN bool any_lane(mask m) {
  return as_ulong(convert_char8(m)) != 0;
}
DS_FN real load(DS_GLOBAL float* p, natural i) {
  return (real)(p[i.s0], p[i.s1], p[i.s2], p[i.s3], p[i.s4], p[i.s5], p[i.s6], p[i.s7]);
}
#  elif DS_LANES == 16
#    define DS_LANE_NUMBERS ((uint16)(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15))
DS_FN bool any_lane(mask m) {
  const ulong2 bytes = as_ulong2(convert_char16(m));
  return (bytes.x | bytes.y) != 0;
}
DS_FN real load(DS_GLOBAL float* p, natural i) {
  return (real)(p[i.s0], p[i.s1], p[i.s2], p[i.s3], p[i.s4], p[i.s5], p[i.s6], p[i.s7], p[i.s8],
                p[i.s9], p[i.sa], p[i.sb], p[i.sc], p[i.sd], p[i.se], p[i.sf]);
}
#  else
#    error "DS_LANES must be 1, 4, 8 or 16"
#  endif

#endif

/// The value of the first lane that is set; at least one must be.
#if DS_LANES == 1
DS_FN uint first_of(mask m, natural a) {
  return a;
}
#else
DS_FN uint first_of(mask m, natural a) {
  int set[DS_LANES] __attribute__((aligned(64)));
  uint value[DS_LANES] __attribute__((aligned(64)));
  *(mask*)set = m;
  *(natural*)value = a;
  int i = 0;
  while (!set[i])
    ++i;
  return value[i];
}
#endif

DS_FN real choose(mask m, real a, real b) {
  return m ? a : b;
}
DS_FN natural choose_natural(mask m, natural a, natural b) {
  return m ? a : b;
}
DS_FN integer choose_integer(mask m, integer a, integer b) {
  return m ? a : b;
}
DS_FN mask choose_mask(mask m, mask a, mask b) {
  return (m & a) | ((!m) & b);
}
DS_FN natural load_natural(DS_GLOBAL float* p, natural i) {
  return bits_of(load(p, i));
}

/// The lesser and the greater; where either is NaN, the second.
DS_FN real lesser(real a, real b) {
  return choose(a < b, a, b);
}
DS_FN real greater(real a, real b) {
  return choose(a > b, a, b);
}
DS_FN real clamp01(real a) {
  return lesser(greater(a, (real)(0.0f)), (real)(1.0f));
}
/// A whole number of any size as an integer, held in [-2^30, 2^30]; NaN is -2^30. to_integer of
/// what an int cannot hold differs from device to device.
DS_FN integer to_held_integer(real whole) {
  return to_integer(lesser(greater(whole, (real)(-1073741824.0f)), (real)(1073741824.0f)));
}
#ifdef DS_REAL_DOUBLE
DS_FN real absolute(real a) {
  return fabs(a);
}
DS_FN real with_sign_of(real magnitude, real sign) {
  return copysign(magnitude, sign);
}
#else
DS_FN real absolute(real a) {
  return real_of(bits_of(a) & 0x7fffffffu);
}
/// `magnitude` with the sign bit of `sign`.
DS_FN real with_sign_of(real magnitude, real sign) {
  return real_of((bits_of(magnitude) & 0x7fffffffu) | (bits_of(sign) & 0x80000000u));
}
#endif
DS_FN real square(real a) {
  return a * a;
}
