// SPDX-License-Identifier: Apache-2.0
#include "tests/fuzz/model_fuzz.h"

/// Any bytes behind "OFF", so that every input gets to the OFF reader.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  ds::fuzz_model(bytes.find("OFF") != bytes.npos ? std::string(bytes)
                                                 : "OFF " + std::string(bytes));
  return 0;
}
