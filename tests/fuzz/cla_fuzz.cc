// SPDX-License-Identifier: Apache-2.0
// Class files: whatever the bytes, a classification that keeps its invariants or an Error.
#include "manifests/classification.h"
#include "tracer/base/error.h"

#include <cstddef>
#include <cstdint>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    const ds::Classification read = ds::parse_classification(text, "fuzz.cla");
    int models = 0;
    for (std::size_t i = 0; i < read.classes.size(); ++i) {
      DS_ASSERT(read.classes[i].parent < static_cast<int>(i));
      models += static_cast<int>(read.classes[i].models.size());
    }
    DS_ASSERT(models == read.model_count);
    const ds::Labels labels(read, std::nullopt);
    DS_ASSERT(labels.size() == static_cast<std::size_t>(models));
  } catch (const ds::Error&) {
    // A finding, as it should be.
  }
  return 0;
}
