// SPDX-License-Identifier: Apache-2.0
// What every texture answers. A texture NAME in textures/NAME.h has DS_NAME_INPUTS and
// DS_NAME_NUMBERS as materials have (slots of inputs count textures, slots of numbers count floats),
// DS_TRAITS(NAME, a sum of traits.h), NodeOnHost NAME_on_host in a DS_HOOK_HOST part, and
//
//   real3 NAME_evaluate(TexturePoint at, DS_GLOBAL float* numbers, const real3* inputs)
//
// A scalar texture gives three equal components. Textures are evaluated on a stack by
// texture_program.h.
#pragma once

#include "tracer/kernels/math.h"
#include "tracer/kernels/scene_data.h"

/// Turns lists of inputs and numbers into indices.
#define DS_INPUT_INDEX(slot, width, default_value) slot,
#define DS_NUMBER_INDEX(slot, default_value) slot,

typedef struct {
  real3 position;           ///< in the texture's own space (3D mappings)
  real u, v;                ///< after the texture's mapping (2D mappings)
  real b1, b2;              ///< weights of the triangle's second and third corner
  natural colors;           ///< the triangle's row of colours
  DS_GLOBAL float* tables;  ///< texels and rows of colours
} TexturePoint;
