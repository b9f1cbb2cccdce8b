// SPDX-License-Identifier: Apache-2.0
#include "tests/fuzz/model_fuzz.h"
#include "tracer/scene/mesh_formats.h"

namespace ds {
extern const MeshFormat DS_MESH_FORMAT;
}

/// Built for each format. Bytes of another are left alone, so that what is found is of this one.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const ds::MeshFormat& format = ds::DS_MESH_FORMAT;
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  const std::string name = "fuzz" + std::string(format.endings.substr(0, format.endings.find(' ')));
  if (format.matches(bytes, name)) ds::fuzz_model(bytes, name);
  return 0;
}
