// SPDX-License-Identifier: Apache-2.0
#include "tracer/base/streams.h"

#include "tracer/base/text_width.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <fcntl.h>
#include <mutex>
#include <poll.h>
#include <sys/ioctl.h>
#include <system_error>
#include <unistd.h>

namespace ds {
namespace {

constexpr const char* k_erase_line = "\r\x1b[K";
/// Where a terminal does not tell its width.
constexpr int k_usual_columns = 80;
/// How long to wait for a reader who made the descriptor non-blocking and does not keep up.
constexpr int k_patience_ms = 2000;

std::mutex g_mutex;
std::string g_status;           ///< the line on the screen, as it was asked for; empty: none
int g_result_error = 0;         ///< of the first failure to write a result
bool g_results_wanted = false;  ///< a result was written, so what is left in the buffer counts

/// What cannot be written is given up: a terminal that was closed, a disk that is full.
void write_to_people(std::string_view text) {
  while (!text.empty()) {
    const ssize_t done = ::write(STDERR_FILENO, text.data(), text.size());
    if (done >= 0) {
      text.remove_prefix(static_cast<std::size_t>(done));
      continue;
    }
    if (errno == EINTR) continue;
    pollfd ready{STDERR_FILENO, POLLOUT, 0};
    if (errno != EAGAIN || ::poll(&ready, 1, k_patience_ms) <= 0) return;
  }
}

void write_to_output(Stream to, std::string_view text) {
  if (!g_status.empty()) write_to_people(k_erase_line);
  g_status.clear();
  errno = 0;
  const bool whole = std::fwrite(text.data(), 1, text.size(), stdout) == text.size();
  if (to != Stream::result) return;
  g_results_wanted = true;
  if (!whole && g_result_error == 0) g_result_error = errno != 0 ? errno : EIO;
}

/// git does the same: a job in the background does not draw over what the shell shows.
bool in_foreground() {
  const pid_t group = ::tcgetpgrp(STDERR_FILENO);
  return group < 0 || group == ::getpgrp();
}

std::string fitted(std::string_view line) {
  return cut_to_columns(line, line_columns().value_or(k_usual_columns));
}

}  // namespace

void reserve_standard_streams() {
  // Opened the other way round, as coreutils do, so that using what was closed stays an error.
  for (const int wanted : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (::fcntl(wanted, F_GETFD) != -1 || errno != EBADF) continue;
    const int flags = wanted == STDIN_FILENO ? O_WRONLY : O_RDONLY;
    const int opened = ::open("/dev/null", flags);
    if (opened >= 0 && opened != wanted) {
      ::dup2(opened, wanted);
      ::close(opened);
    }
  }
}

void write_text(Stream to, std::string_view text) {
  const std::lock_guard lock(g_mutex);
  if (to != Stream::people) {
    write_to_output(to, text);
    return;
  }
  // One write, so that lines of two processes that share a terminal or a log do not mix.
  std::string whole(text);
  if (!g_status.empty()) whole = k_erase_line + whole + fitted(g_status);
  write_to_people(whole);
}

std::optional<std::string> lost_result() {
  const std::lock_guard lock(g_mutex);
  errno = 0;
  const bool flushed = std::fflush(stdout) == 0;
  if (!flushed && g_results_wanted && g_result_error == 0)
    g_result_error = errno != 0 ? errno : EIO;
  if (g_result_error == 0) return std::nullopt;
  return std::generic_category().message(g_result_error);
}

bool has_status_line() {
  if (::isatty(STDERR_FILENO) != 1) return false;
  const char* terminal = std::getenv("TERM");
  return terminal == nullptr || std::string_view(terminal) != "dumb";
}

std::optional<int> line_columns() {
  winsize size{};
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-vararg): the only form of this call
  if (::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) != 0)
    return ::isatty(STDERR_FILENO) == 1 ? std::optional(k_usual_columns) : std::nullopt;
  // The last column stays free: some terminals begin a new line as soon as it is filled.
  return std::max(1, (size.ws_col > 0 ? int{size.ws_col} : k_usual_columns) - 1);
}

void show_status_line(std::string_view line) {
  if (!has_status_line() || !in_foreground()) return;
  const std::lock_guard lock(g_mutex);
  g_status = line;
  write_to_people(k_erase_line + fitted(line));
}

void clear_status_line() {
  const std::lock_guard lock(g_mutex);
  if (!g_status.empty()) write_to_people(k_erase_line);
  g_status.clear();
}

}  // namespace ds
