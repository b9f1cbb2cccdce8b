// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/scene/own_materials.h"

#include <nlohmann/json.hpp>

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <tiny_gltf.h>
#include <vector>

/// The only files that include tinygltf are gltf_*.cc.
namespace ds {

/// A glTF 2.0 file with what its buffers hold; of its images those in data URIs are as they are encoded, others not
/// there. Its indices are as the file has them.
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

/// Where a uri leads. Throws Error(asset) where that is not beside the file or below.
std::filesystem::path gltf_file_of_uri(const std::string& uri, const std::string& name);

/// Its materials of these indices, in this order (own_materials.h).
OwnMaterials gltf_materials(const GltfFile& file, const std::vector<int>& used,
                            const std::string& name);
/// The bytes of image `number`, which is in the file, in one of its buffers. Throws Error(asset) where it has none.
std::string_view gltf_image(const tinygltf::Model& model, int number, const std::string& name);

}  // namespace ds
