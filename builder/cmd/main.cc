// SPDX-License-Identifier: Apache-2.0
#include "builder/cmd/arguments.h"
#include "builder/db/sqlite.h"
#include "tracer/base/error.h"

#include <csignal>
#include <cstdio>
#include <exception>
#include <sstream>
#include <string>

namespace {

void print_error(const std::string& message) {
  std::istringstream lines(message);
  for (std::string line; std::getline(lines, line);)
    fmt::print(stderr, "dsbuild: error: {}\n", line);
}

}  // namespace

int main(int count, char** arguments) {
  // A file over `ulimit -f` is then an error of one write, as on a full disk, and not the end of
  // the process.
  std::signal(SIGXFSZ, SIG_IGN);
  try {
    return ds::run_command_line({arguments, static_cast<std::size_t>(count)});
  } catch (const ds::DamagedDatabase& error) {
    print_error(error.what());
    print_error(
        "run dsbuild again: it sets the database aside and takes what was made from the store");
    return ds::exit_code(error.kind());
  } catch (const ds::Error& error) {
    print_error(error.what());
    return ds::exit_code(error.kind());
  } catch (const std::exception& error) {
    print_error(error.what());
    return 1;
  }
}
