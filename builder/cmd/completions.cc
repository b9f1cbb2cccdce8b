// SPDX-License-Identifier: Apache-2.0
#include "builder/cmd/shell_text.h"
#include "builder/cmd/verbs.h"
#include "tracer/base/error.h"
#include "tracer/base/nearest.h"
#include "tracer/base/streams.h"

#include <algorithm>

namespace ds {

int run_completions(const Arguments& arguments) {
  const std::vector<std::string_view> known = shell_texts();
  if (std::find(known.begin(), known.end(), arguments.shell) == known.end())
    fail(ErrorKind::usage, "completions: wanted {}, got {}{}",
         fmt::format("{}", fmt::join(known, ", ")), arguments.shell,
         did_you_mean(arguments.shell, known));
  write_text(Stream::result, shell_text(arguments.shell));
  return 0;
}

}  // namespace ds
