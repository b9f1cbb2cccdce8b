// SPDX-License-Identifier: Apache-2.0
// Every material, texture, light, camera and plane, weights of hits and surface points as C++
// functions, one lane wide, in namespace ds::kernels. For the host's tables, for packing, and for
// tests against closed forms.
#pragma once

#include "tracer/kernels/layout.h"

#define DS_HOOK_ALBEDO
#define DS_HOOK_LIGHT_PLANES

#if defined(__GNUC__)
#  pragma GCC diagnostic push
// One signature serves all nodes, so some leave parameters unused; casts are spelled as OpenCL C
// has them.
#  pragma GCC diagnostic ignored "-Wunused-parameter"
#  pragma GCC diagnostic ignored "-Wold-style-cast"
#  pragma GCC diagnostic ignored "-Wsign-conversion"
#  pragma GCC diagnostic ignored "-Wconversion"
#  pragma GCC diagnostic ignored "-Wshadow"
#  pragma GCC diagnostic ignored "-Wpedantic"
#endif

// clang-format off
namespace ds::DS_KERNELS {
#include "tracer/kernels/camera.h"
#include "tracer/kernels/guide.h"
#include "tracer/kernels/node_headers.h"
#include "tracer/kernels/shear.h"
#include "tracer/kernels/surface.h"
#include "tracer/kernels/texture_program.h"
}  // namespace ds::DS_KERNELS
// clang-format on

#if defined(__GNUC__)
#  pragma GCC diagnostic pop
#endif
