// SPDX-License-Identifier: Apache-2.0
#include "builder/cmd/sbatch_options.h"

#include "tracer/base/error.h"

#include <algorithm>
#include <array>
#include <string_view>

namespace ds {
namespace {

struct Refused {
  std::string_view name;
  char letter;  ///< 0: it has none
  const char* why;
};

constexpr std::array<Refused, 9> k_refused{{
    {"array", 'a', "the shares are the array (--shards N, --nodes N)"},
    {"output", 'o', "logs go to the store, where the jobs' mark is"},
    {"dependency", 'd', "the last job waits for the shares"},
    {"parsable", 0, "it is given, to learn the jobs' numbers"},
    {"wait", 'W', "sbatch would submit the last job only when the shares have ended"},
    {"wrap", 0, "the jobs are those of dsbuild's own script (--print writes it)"},
    {"test-only", 0, "no job would be submitted (--print writes the script)"},
    {"help", 'h', "no job would be submitted"},
    {"version", 'V', "no job would be submitted"},
}};

/// Letters of sbatch's that take no value, so that others may follow in one word.
constexpr std::string_view k_flags = "hHIkOQsvVW";

[[noreturn]] void refuse(const Refused& option, const std::string& word) {
  fail(ErrorKind::usage, "slurm: sbatch's --{} is not to be given, got {}: {}", option.name, word,
       option.why);
}

void check_long(const std::string& word) {
  // The least beginning that tells an option from others is enough for sbatch.
  const std::string_view name = std::string_view(word).substr(2, word.find('=') - 2);
  for (const Refused& option : k_refused)
    if (option.name.starts_with(name)) refuse(option, word);
}

void check_letters(const std::string& word) {
  for (const char letter : std::string_view(word).substr(1)) {
    for (const Refused& option : k_refused)
      if (option.letter == letter) refuse(option, word);
    if (k_flags.find(letter) == k_flags.npos) return;  // the rest is its value
  }
}

}  // namespace

void check_sbatch_options(const std::vector<std::string>& words) {
  bool may_be_value = false;
  for (const std::string& word : words) {
    const bool is_option = word.size() > 1 && word[0] == '-' && word != "--";
    if (!is_option && !may_be_value)
      fail(ErrorKind::usage,
           "slurm: wanted options of sbatch behind --, got {}: sbatch would run it in place of the "
           "script",
           word);
    const bool is_long = is_option && word[1] == '-';
    if (is_long)
      check_long(word);
    else if (is_option)
      check_letters(word);
    may_be_value = is_option && (!is_long || word.find('=') == word.npos);
  }
}

}  // namespace ds
