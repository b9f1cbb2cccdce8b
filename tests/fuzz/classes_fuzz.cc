// SPDX-License-Identifier: Apache-2.0
// Tables of classes: whatever the bytes, a list that keeps its invariants or an Error.
#include "manifests/class_table.h"
#include "tracer/base/error.h"

#include <cstddef>
#include <cstdint>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    const auto models = ds::parse_class_table(text, "fuzz.csv");
    const ds::Labels labels(models);
    DS_ASSERT(labels.size() == models.size());
    for (const ds::LabelledModel& model : models)
      DS_ASSERT(!model.model.empty() && labels.find(model.model) == model.label);
    for (const std::string& path : labels.class_paths())
      DS_ASSERT(!path.empty() && path.front() != '/' && path.back() != '/');
  } catch (const ds::Error&) {
    // A finding, as it should be.
  }
  return 0;
}
