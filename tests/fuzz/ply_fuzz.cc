// SPDX-License-Identifier: Apache-2.0
#include "tests/fuzz/model_fuzz.h"

/// Any bytes behind "ply\n", so that every input gets to the PLY reader.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  ds::fuzz_model(bytes.starts_with("ply") ? std::string(bytes) : "ply\n" + std::string(bytes));
  return 0;
}
