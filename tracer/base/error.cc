// SPDX-License-Identifier: Apache-2.0
#include "tracer/base/error.h"

#include <cstdio>
#include <cstdlib>

namespace ds {

int exit_code(ErrorKind kind) {
  return kind == ErrorKind::usage || kind == ErrorKind::recipe ? 2 : 1;
}

std::string to_string(const SourcePlace& place) {
  std::string text = place.file;
  if (place.line > 0) text += fmt::format(":{}", place.line);
  if (place.line > 0 && place.column > 0) text += fmt::format(":{}", place.column);
  return text;
}

void Diagnostics::add_line(const SourcePlace& place, const std::string& message) {
  const std::string where = to_string(place);
  lines_.push_back(where.empty() ? message : where + ": " + message);
}

void Diagnostics::throw_if_any() const {
  if (!lines_.empty()) throw Error(kind_, fmt::format("{}", fmt::join(lines_, "\n")));
}

void assertion_failed(const char* expression, const char* file, int line) {
  std::fprintf(stderr, "%s:%d: bug: %s does not hold\n", file, line, expression);
  std::abort();
}

}  // namespace ds
