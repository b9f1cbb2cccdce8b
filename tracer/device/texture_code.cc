// SPDX-License-Identifier: Apache-2.0
#include "tracer/device/texture_code.h"

#include "tracer/base/error.h"
#include "tracer/kernels/all_nodes.h"
#include "tracer/scene/type_tables.h"

#include <algorithm>
#include <bit>
#include <vector>

namespace ds {
namespace {

std::uint32_t word_of(float value) {
  return std::bit_cast<std::uint32_t>(value);
}

/// Emits instructions for texture graphs, inputs before the texture that takes them.
class Emitter {
 public:
  /// Evaluates what the material uses more than once, and leaves it at the bottom of the stack.
  Emitter(const Scene& scene, const Material& material, TextureCode& code)
      : scene_(scene), code_(code), uses_(scene.textures.size()), kept_(scene.textures.size(), -1) {
    for (const TextureRef& input : material.inputs)
      count(input);
    for (const TextureRef& input : material.inputs)
      keep(input);
  }

  void push(const TextureRef& ref) {
    if (ref.texture < 0) {
      begin(kernels::op_constant);
      for (const float c : {ref.constant.x, ref.constant.y, ref.constant.z})
        code_.words.push_back(word_of(c));
      end();
      grow();
      return;
    }
    const auto index = static_cast<std::size_t>(ref.texture);
    if (kept_[index] >= 0) {
      begin(kernels::op_copy);
      code_.words.push_back(static_cast<std::uint32_t>(kept_[index]));
      end();
      grow();
      return;
    }
    const Texture& texture = scene_.textures[index];
    for (const TextureRef& input : texture.inputs)
      push(input);
    depth_ -= static_cast<int>(texture.inputs.size());
    emit_texture(texture);
    grow();
  }

  void store(int slot, int width) {
    begin(kernels::op_store);
    code_.words.push_back(static_cast<std::uint32_t>(slot));
    code_.words.push_back(static_cast<std::uint32_t>(width));
    end();
    --depth_;
  }

  void finish() {
    begin(kernels::op_end);
    end();
  }

 private:
  void count(const TextureRef& ref) {
    if (ref.texture < 0) return;
    const auto index = static_cast<std::size_t>(ref.texture);
    if (++uses_[index] > 1) return;
    for (const TextureRef& input : scene_.textures[index].inputs)
      count(input);
  }

  void keep(const TextureRef& ref) {
    if (ref.texture < 0) return;
    const auto index = static_cast<std::size_t>(ref.texture);
    if (kept_[index] >= 0) return;
    for (const TextureRef& input : scene_.textures[index].inputs)
      keep(input);
    if (uses_[index] < 2) return;
    push(ref);
    kept_[index] = depth_ - 1;
  }

  void begin(std::uint32_t op) {
    start_ = code_.words.size();
    code_.words.push_back(op);
    code_.words.push_back(0);
  }
  void end() { code_.words[start_ + 1] = static_cast<std::uint32_t>(code_.words.size() - start_); }

  void grow() {
    code_.stack = std::max(code_.stack, ++depth_);
    if (depth_ > k_texture_stack_limit)
      fail(ErrorKind::asset, "a texture graph needs more than {} values at once",
           k_texture_stack_limit);
  }

  void emit_texture(const Texture& texture) {
    begin(static_cast<std::uint32_t>(kernels::op_texture + texture.type));
    code_.op_words.push_back(start_);
    code_.types.push_back(texture.type);
    const NodeType& type = texture_types()[static_cast<std::size_t>(texture.type)];
    emit_transform(texture, reads_uvs(type));
    if (texture.image >= 0) {
      emit_image(texture);
    } else {
      for (const float number : texture.numbers)
        code_.words.push_back(word_of(number));
      if (reads_colors(type)) {
        code_.color_words.push_back(code_.words.size());
        code_.words.push_back(0);
      }
    }
    end();
  }

  void emit_transform(const Texture& texture, bool of_uvs) {
    if (!of_uvs) {
      for (std::size_t i = 0; i < kernels::k_instruction_transform; ++i)
        code_.words.push_back(word_of(static_cast<float>(texture.world_to_texture.m[i])));
      return;
    }
    for (const float number : texture.uv_transform)
      code_.words.push_back(word_of(number));
    code_.words.insert(code_.words.end(), kernels::k_instruction_transform - 6, 0);
  }

  void emit_image(const Texture& texture) {
    const Image& image = scene_.images[static_cast<std::size_t>(texture.image)];
    code_.image_words.push_back(code_.words.size());
    code_.words.push_back(static_cast<std::uint32_t>(texture.image));
    code_.words.push_back(static_cast<std::uint32_t>(image.width));
    code_.words.push_back(static_cast<std::uint32_t>(image.height));
    code_.words.push_back(static_cast<std::uint32_t>(image.wrap));
    code_.words.push_back(image.filter == ImageFilter::linear ? 1u : 0u);
  }

  const Scene& scene_;
  TextureCode& code_;
  std::vector<int> uses_;  ///< of each texture of the scene
  std::vector<int> kept_;  ///< its place on the stack, or -1
  std::size_t start_ = 0;
  int depth_ = 0;
};

}  // namespace

TextureCode texture_code(const Scene& scene, const Material& material) {
  TextureCode code;
  Emitter emitter(scene, material, code);
  const NodeType& type = material_types()[static_cast<std::size_t>(material.type)];
  int slot = 0;
  for (std::size_t i = 0; i < material.inputs.size(); ++i) {
    if (material.inputs[i].texture >= 0) {
      emitter.push(material.inputs[i]);
      emitter.store(slot, type.inputs[i].width);
    }
    slot += type.inputs[i].width;
  }
  if (!code.words.empty()) emitter.finish();
  std::sort(code.types.begin(), code.types.end());
  code.types.erase(std::unique(code.types.begin(), code.types.end()), code.types.end());
  return code;
}

}  // namespace ds
