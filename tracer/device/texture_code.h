// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/scene/scene.h"

#include <cstdint>
#include <string>
#include <vector>

namespace ds {

/// Most values a texture program may have on its stack, those used more than once among them; a
/// deeper graph is an error.
inline constexpr int k_texture_stack_limit = 32;

/// The program that evaluates a material's textured inputs (kernels/texture_program.h). Operations
/// of textures are k_first_texture_op + row of texture_types() until `number_ops` turns rows into a
/// program's own numbers.
struct TextureCode {
  std::vector<std::uint32_t> words;      ///< empty where every input is constant
  std::vector<int> types;                ///< rows of texture_types() used, ascending
  std::vector<std::size_t> op_words;     ///< indices in `words` of texture operations
  std::vector<std::size_t> image_words;  ///< indices in `words` that hold an index of Scene::images
  std::vector<std::size_t> color_words;  ///< indices in `words` for the offset of colours' rows
  int stack = 1;
};

/// Throws Error(asset) for a graph deeper than k_texture_stack_limit.
TextureCode texture_code(const Scene& scene, const Material& material);

}  // namespace ds
