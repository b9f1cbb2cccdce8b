// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <tiny_gltf.h>
#include <vector>

/// The only files that include tinygltf are gltf_*.cc.
namespace ds {

/// A glTF 2.0 file with what its buffers hold; its images are not loaded, and its indices are as the file has them.
struct GltfFile {
  tinygltf::Model model;
  std::size_t trailing_bytes = 0;
};

bool is_gltf(std::string_view bytes);
/// Throws Error(asset) for a file that is cut off, contradicts itself, requires an extension that is not read, or names
/// a file that does not lie beside it or below.
GltfFile load_gltf(std::string_view bytes, const std::string& name);
/// The files that its buffers are in.
std::vector<std::filesystem::path> gltf_buffer_files(std::string_view bytes,
                                                     const std::string& name);

}  // namespace ds
