// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/db/database.h"
#include "tracer/base/error.h"

#include <string>
#include <string_view>
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

/// What a line of a record says of which product is which object, with views into the text.
struct RecordLine {
  std::string_view text;  ///< with its line break
  Hash128 key, object;
  std::string kind;
};
/// Of each line, without taking apart the rest of it, which costs ten times as much: a line that has
/// members as `to_record` writes them is taken at a glance. Throws as from_record.
std::vector<RecordLine> record_lines(std::string_view text);

}  // namespace ds
