// SPDX-License-Identifier: Apache-2.0
#include "tracer/device/program_assembly.h"

#include "tracer/base/error.h"
#include "tracer/kernels/embedded.h"

#include <algorithm>
#include <set>
#include <utility>

namespace ds {
namespace {

std::string_view embedded_text(std::string_view path) {
  for (const EmbeddedFile& file : std::span(k_embedded_files, k_embedded_file_count))
    if (path == file.path) return file.text;
  fail(ErrorKind::device, "kernel file {} is not part of this program", path);
}

std::string_view take_line(std::string_view& text) {
  const std::size_t end = text.find('\n');
  const std::string_view line = text.substr(0, end);
  text.remove_prefix(end == text.npos ? text.size() : end + 1);
  return line;
}

/// What stands behind a directive's '#' and its blanks; nothing of other lines.
std::string_view directive_of(std::string_view line) {
  if (!line.starts_with('#')) return {};
  line.remove_prefix(std::min(line.find_first_not_of(' ', 1), line.size()));
  return line;
}

/// The path of a line `#include "path"`, or nothing.
std::string_view included_path(std::string_view line) {
  constexpr std::string_view k_include = "include \"";
  std::string_view path = directive_of(line);
  if (!path.starts_with(k_include)) return {};
  path.remove_prefix(k_include.size());
  return path.substr(0, path.find('"'));
}

/// Takes the rest of an `#if` with its `#endif` off the text.
void skip_block(std::string_view& text) {
  for (int depth = 1; depth > 0;) {
    DS_ASSERT(!text.empty());
    const std::string_view directive = directive_of(take_line(text));
    DS_ASSERT(depth > 1 || !directive.starts_with("el"));
    depth += directive.starts_with("if") ? 1 : directive.starts_with("endif") ? -1 : 0;
  }
}

/// Puts files together. What stands behind `#ifdef DS_HOOK_...` is in the text only where that is
/// defined, so that a hook is in no key of a program without it.
class Assembly {
 public:
  explicit Assembly(const std::string& definitions) : text_(definitions) {
    for (std::string_view rest = definitions; !rest.empty();) {
      constexpr std::string_view k_define = "#define ";
      std::string_view line = take_line(rest);
      if (!line.starts_with(k_define)) continue;
      line.remove_prefix(k_define.size());
      if (line.starts_with(k_hook)) hooks_.emplace(line);
    }
  }
  void add(std::string_view path) {
    if (!done_.emplace(path).second) return;
    for (std::string_view rest = embedded_text(path); !rest.empty();) {
      const std::string_view line = take_line(rest);
      if (const std::string_view other = included_path(line); !other.empty()) {
        add(other);
      } else if (is_missing_hook(line)) {
        skip_block(rest);
      } else if (!line.starts_with("#pragma once")) {
        text_ += line;
        text_ += '\n';
      }
    }
  }
  std::string take() { return std::move(text_); }

 private:
  static constexpr std::string_view k_hook = "DS_HOOK_";

  bool is_missing_hook(std::string_view line) const {
    constexpr std::string_view k_ifdef = "ifdef ";
    std::string_view name = directive_of(line);
    if (!name.starts_with(k_ifdef)) return false;
    name.remove_prefix(k_ifdef.size());
    return name.starts_with(k_hook) && !hooks_.contains(name);
  }

  std::string text_;
  std::set<std::string, std::less<>> done_, hooks_;
};

}  // namespace

std::string assemble(const std::string& definitions, std::span<const std::string> paths) {
  Assembly assembly(definitions);
  for (const std::string& path : paths)
    assembly.add(path);
  return assembly.take();
}

}  // namespace ds
