// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/base/error.h"

#include <nlohmann/json.hpp>

#include <exception>
#include <string>

namespace ds {

/// Where a line of an error says that it is of, "FILE:LINE:COLUMN: ..." or "FILE: ..." (see
/// SourcePlace), and what it says of it. Without a line in front of it, a name counts as a file's
/// where one of it is there; `file` is empty for an error of nothing of that kind.
struct PlacedMessage {
  SourcePlace place;
  std::string message;
};
PlacedMessage placed_message(const std::string& line);

/// What a command with --json prints in place of its answer where it ends by an exception:
///   {"error": the whole text, "kind": "usage", "exit_code": 2,
///    "failures": [{"what": "r.toml:14:9", "why": "camera.fov_deg must be ...",
///                  "file": "r.toml", "line": 14, "column": 9}, ...]}
/// One failure for each line of the text; file, line and column are null where they are unknown, and
/// "what" is then "dsbuild". `kind` is one of ErrorKind's names, or "internal" for what no Error is.
nlohmann::json error_json(const std::exception& error);

}  // namespace ds
