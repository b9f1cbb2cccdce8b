// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/db/database.h"
#include "tracer/base/error.h"

#include <string>
#include <vector>

namespace ds {

/// A text that is no record of this version.
class UnreadableRecord : public Error {
 public:
  explicit UnreadableRecord(const std::string& message) : Error(ErrorKind::io, message) {}
};

/// A product and how it was made.
struct MadeProduct {
  Product product;
  TraceRun run;
};

/// One text for what one image's making gave, kept beside the objects so that a lost database costs
/// no tracing: one JSON object a line, the fields of Product and TraceRun
/// ("facts" and "pixel_counts" are missing where an older dsbuild wrote the record).
std::string to_record(const std::vector<MadeProduct>& made);
/// Throws UnreadableRecord for a text that `to_record` did not write.
std::vector<MadeProduct> from_record(const std::string& text);

}  // namespace ds
