// SPDX-License-Identifier: Apache-2.0
// Lines of images.jsonl: a record that writes itself as a line that reads back as the same, or an
// Error.
#include "manifests/manifest.h"
#include "tracer/base/error.h"

#include <cstddef>
#include <cstdint>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const std::string line(reinterpret_cast<const char*>(data), size);
    const std::string again = ds::to_json_line(ds::image_from_json_line(line, "fuzz.jsonl", 1));
    DS_ASSERT(ds::to_json_line(ds::image_from_json_line(again, "again.jsonl", 1)) == again);
  } catch (const ds::Error&) {
    // A finding, as it should be.
  }
  return 0;
}
