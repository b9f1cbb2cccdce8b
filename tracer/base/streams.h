// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace ds {

/// What a text is, which decides where it goes and what its loss means.
enum class Stream {
  result,  ///< standard output, what the command was asked for: a loss is told by lost_result()
  report,  ///< standard output, for people beside the work: a loss is none
  people,  ///< standard error, in whole lines: a loss is none
};

/// Opens what is closed of the descriptors 0 to 2, so that no file that is opened later becomes one
/// of them and takes in what was meant for people. Writing to what was closed fails, as it did.
/// To be called before anything is opened.
void reserve_standard_streams();

/// Never throws and never ends the process, whatever became of the stream. Safe from any thread.
/// Lines for people stand on lines of their own: a status line is taken away before them and drawn
/// again behind them.
void write_text(Stream to, std::string_view text);

template <typename... Args>
void say(Stream to, fmt::format_string<Args...> format, Args&&... args) {
  write_text(to, fmt::format(format, std::forward<Args>(args)...));
}

/// Flushes standard output. Why a part of the results did not arrive ("No space left on device"),
/// or nothing where all of them did.
std::optional<std::string> lost_result();

/// Whether standard error is a terminal on which a line can be drawn over.
bool has_status_line();
/// The columns that a line on standard error may take, asked anew each time (the window's size
/// changes); nothing where it is no terminal.
std::optional<int> line_columns();
/// Draws the line, cut to the terminal's width, over the last one. Nothing is drawn where there is
/// no such terminal, or this process is in its background.
void show_status_line(std::string_view line);
void clear_status_line();

}  // namespace ds
