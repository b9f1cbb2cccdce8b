// SPDX-License-Identifier: Apache-2.0
// A material's textured inputs as a program for a stack machine: instructions in `programs`, one
// value (real3) a slot. All lanes run the same instruction, so the program's words are read once
// for all of them. Instructions:
//
//   op_constant  r g b               push
//   op_copy      place               push the stack's value at that place from the bottom: textures
//                                    that are used more than once are evaluated first and stay
//                                    there
//   op_store     slot width          pop into `width` components of the material's inputs from
//                                    `slot` on
//   op_end
//   op_texture + type  transform[12] numbers...   pop its inputs (the last pushed is the last
//                                    input), push its value
//
// word 0 is the operation, word 1 the instruction's length in words. `transform` is a 3x4 row-major
// world-to-texture matrix, or for one of uvs [a b c; d e f] of (s, t) = [..] (u, v, 1) in its first
// six words. DS_TEXTURES(X) is the scene's own list: X(name, number), see device/program_text.cc.
#pragma once

#include "tracer/kernels/texture.h"

enum { op_end, op_constant, op_copy, op_store, op_texture };
enum { k_instruction_head = 2, k_instruction_transform = 12 };

#ifdef DS_TEXTURES

typedef struct {
  real3 position;  ///< world
  real u, v;
  real b1, b2;
  natural colors;
} SurfacePoint;

DS_FN TexturePoint texture_point(SurfacePoint at, DS_GLOBAL float* t, DS_GLOBAL float* tables) {
  TexturePoint p;
  p.position =
      vec(fma(at.position.x, (real)(t[0]),
              fma(at.position.y, (real)(t[1]), fma(at.position.z, (real)(t[2]), (real)(t[3])))),
          fma(at.position.x, (real)(t[4]),
              fma(at.position.y, (real)(t[5]), fma(at.position.z, (real)(t[6]), (real)(t[7])))),
          fma(at.position.x, (real)(t[8]),
              fma(at.position.y, (real)(t[9]), fma(at.position.z, (real)(t[10]), (real)(t[11])))));
  p.u = fma(at.u, (real)(t[0]), fma(at.v, (real)(t[1]), (real)(t[2])));
  p.v = fma(at.u, (real)(t[3]), fma(at.v, (real)(t[4]), (real)(t[5])));
  p.b1 = at.b1;
  p.b2 = at.b2;
  p.colors = at.colors;
  p.tables = tables;
  return p;
}

/// Runs the program at `code` and stores its results into `inputs` where `here` is set.
DS_FN void run_texture_program(DS_GLOBAL float* code, DS_GLOBAL float* tables, SurfacePoint at,
                               mask here, real* inputs) {
  real3 stack[DS_TEXTURE_STACK];
  int top = 0;
  for (;; code += as_uint(code[1])) {
    DS_GLOBAL float* words = code + k_instruction_head;
    const uint op = as_uint(code[0]);
    if (op == op_end) return;
    if (op == op_constant) {
      stack[top++] = vec((real)(words[0]), (real)(words[1]), (real)(words[2]));
    } else if (op == op_copy) {
      stack[top++] = stack[as_uint(words[0])];
    } else if (op == op_store) {
      const real3 value = stack[--top];
      const uint slot = as_uint(words[0]);
      inputs[slot] = choose(here, value.x, inputs[slot]);
      if (as_uint(words[1]) == 3u) {
        inputs[slot + 1] = choose(here, value.y, inputs[slot + 1]);
        inputs[slot + 2] = choose(here, value.z, inputs[slot + 2]);
      }
    } else {
      const TexturePoint point = texture_point(at, words, tables);
      DS_GLOBAL float* numbers = words + k_instruction_transform;
#  define DS_TEXTURE_CASE(name, number)                          \
    if (op == op_texture + number) {                             \
      top -= name##_inputs;                                      \
      stack[top] = name##_evaluate(point, numbers, stack + top); \
      ++top;                                                     \
    }
      DS_TEXTURES(DS_TEXTURE_CASE)
    }
  }
}

#endif
