// SPDX-License-Identifier: Apache-2.0
// What OpenCL C and C++20 call by different names. First in every program; C++ code includes host.h
// instead.
#pragma once

#ifdef __OPENCL_VERSION__
#  pragma OPENCL FP_CONTRACT OFF
#  define DS_FN static inline __attribute__((always_inline, overloadable))
#  define DS_GLOBAL __global const
#  define leading_zeros(x) clz(x)
#else
#  define DS_FN inline
#  define DS_GLOBAL const
#endif
