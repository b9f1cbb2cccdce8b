// SPDX-License-Identifier: Apache-2.0
// What OpenCL C and C++20 call by different names. First in every program; C++ code includes host.h
// instead.
#pragma once

#ifdef __OPENCL_VERSION__
#  pragma OPENCL FP_CONTRACT OFF
/// The compiler inlines small ones once it has made them simple. With `always_inline` clang would
/// put them into each other as they are written, and programs take up to twice as long to compile.
#  define DS_FN static inline __attribute__((overloadable))
/// Of what is worth inlining though it is not small: its callers share work with it.
#  define DS_INLINED static inline __attribute__((always_inline, overloadable))
/// Of large functions, where a second copy is not worth its compiling. PoCL puts a kernel's own
/// text three times into what it compiles, but calls functions that are not inlined; their arrays
/// then also lie on the stack once, not once a work-item.
#  define DS_OUT_OF_LINE static __attribute__((noinline))
#  define DS_GLOBAL __global const
#  define leading_zeros(x) clz(x)
/// Traits are the host's (traits.h): a program neither holds nor depends on what there is of them.
#  define DS_TRAITS(name, sum) enum { name##_has_traits }
#else
#  define DS_FN inline
#  define DS_INLINED inline
#  define DS_OUT_OF_LINE inline
#  define DS_GLOBAL const
#  define DS_TRAITS(name, sum) enum { name##_traits = (sum) }
#endif
