// SPDX-License-Identifier: Apache-2.0
#include "builder/cmd/arguments.h"
#include "builder/cmd/error_text.h"
#include "builder/cmd/plan_text.h"
#include "builder/cmd/stop_signal.h"
#include "builder/cmd/supervisor.h"
#include "builder/db/sqlite.h"
#include "tracer/base/error.h"
#include "tracer/base/streams.h"

#include <algorithm>
#include <csignal>
#include <exception>
#include <sstream>
#include <string>
#include <string_view>

namespace {

bool wants_json(std::span<const char* const> words) {
  const auto is_json = [](const char* word) { return std::string_view(word) == "--json"; };
  return std::any_of(words.begin(), words.end(), is_json);
}

/// Also where the command line is wrong: who reads the answer by a program is to learn that so.
void answer_error(std::span<const char* const> words, const std::exception& error) {
  if (wants_json(words)) ds::print_json(ds::error_json(error));
}

void print_error(const std::string& message) {
  std::istringstream lines(message);
  for (std::string line; std::getline(lines, line);)
    ds::say(ds::Stream::people, "dsbuild: error: {}\n", line);
}

int run(std::span<const char* const> arguments) {
  try {
    return ds::run_command_line(arguments);
  } catch (const ds::DamagedDatabase& error) {
    answer_error(arguments, error);
    print_error(error.what());
    print_error(
        "run dsbuild again: it sets the database aside and takes what was made from the store");
    return ds::exit_code(error.kind());
  } catch (const ds::Error& error) {
    answer_error(arguments, error);
    // That the user stopped it, the user knows.
    if (error.kind() != ds::ErrorKind::cancelled || !ds::stopped_by_signal())
      print_error(error.what());
    return ds::exit_code(error.kind());
  } catch (const std::exception& error) {
    answer_error(arguments, error);
    print_error(error.what());
    return 1;
  }
}

}  // namespace

int main(int count, char** arguments) {
  ds::reserve_standard_streams();
  const std::span words(arguments, static_cast<std::size_t>(count));
  if (count > 1 && std::string_view(words[1]) == "build")
    if (const auto code = ds::watch_over_build(wants_json(words))) return *code;
  ds::watch_signals();
  // A file over `ulimit -f` is then an error of one write, as on a full disk, and not the end of
  // the process.
  std::signal(SIGXFSZ, SIG_IGN);
  int code = run(words);
  if (const auto why = ds::lost_result()) {
    print_error("standard output: cannot write: " + *why);
    code = code == 0 ? 1 : code;
  }
  ds::die_of_stop_signal();
  ds::tell_end_of_build(code);
  return code;
}
