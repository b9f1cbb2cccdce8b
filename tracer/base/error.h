// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace ds {

/// What went wrong, by who can mend it. Decides the exit code (see `exit_code`).
enum class ErrorKind {
  usage,      ///< the command line
  recipe,     ///< the recipe or a file it names by a wrong name
  asset,      ///< a model, material, environment or image that cannot be used
  io,         ///< disk full, no permission, torn file
  device,     ///< no OpenCL device, compile failure, lost device
  cancelled,  ///< the user asked to stop
};

/// Anything the world can do to us. `what()` is one line (or one line a diagnostic), lower case, no
/// full stop.
class Error : public std::runtime_error {
 public:
  Error(ErrorKind kind, const std::string& message) : std::runtime_error(message), kind_(kind) {}
  ErrorKind kind() const { return kind_; }

 private:
  ErrorKind kind_;
};

/// Throws `Error` with a message made by fmt.
template <typename... Args>
[[noreturn]] void fail(ErrorKind kind, fmt::format_string<Args...> format, Args&&... args) {
  throw Error(kind, fmt::format(format, std::forward<Args>(args)...));
}

/// 2 for usage and recipe, 1 for the rest. 0 is success.
int exit_code(ErrorKind kind);

/// A place in a text file. Line and column count from 1; 0 means unknown and is not printed.
struct SourcePlace {
  std::string file;
  int line = 0;
  int column = 0;
};

/// "file:line:column", leaving out what is unknown.
std::string to_string(const SourcePlace& place);

/// Collects the findings of a parser so that all are reported together, in the order they were
/// added.
class Diagnostics {
 public:
  explicit Diagnostics(ErrorKind kind) : kind_(kind) {}

  template <typename... Args>
  void add(const SourcePlace& place, fmt::format_string<Args...> format, Args&&... args) {
    add_line(place, fmt::format(format, std::forward<Args>(args)...));
  }
  bool empty() const { return lines_.empty(); }
  const std::vector<std::string>& lines() const { return lines_; }
  /// Throws one `Error` that holds every line, or returns where there is none.
  void throw_if_any() const;

 private:
  void add_line(const SourcePlace& place, const std::string& message);

  ErrorKind kind_;
  std::vector<std::string> lines_;
};

/// Prints the expression and place to standard error and aborts. For what only a bug can do.
[[noreturn]] void assertion_failed(const char* expression, const char* file, int line);

}  // namespace ds

/// On in every build type.
#define DS_ASSERT(expression)              \
  (static_cast<bool>(expression) ? void(0) \
                                 : ::ds::assertion_failed(#expression, __FILE__, __LINE__))
