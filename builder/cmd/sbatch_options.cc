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

constexpr const char* k_none_submitted = "no job would be submitted";
constexpr const char* k_one_process =
    "each job is one process on one node, and more would stand idle (dsbuild slurm --nodes N: "
    "shares made at once; -- --cpus-per-task=N: a share's processors)";
constexpr const char* k_requeued =
    "a job whose node dies, or whose time limit is near, is requeued to go on";

/// All options of sbatch 22.05, by what they do to the work. Refused are those that
///   say what the jobs are:       array, dependency, wrap
///   hide what became of them:    output, open-mode, parsable, wait, clusters
///   submit none:                 test-only, help, usage, version
///   take more than one process:  nodes, ntasks, ntasks-per-*
///   let none go on:              no-requeue, no-kill; signal, but for another time (check_signal)
/// Taken are those that
///   ask for resources and time:  account, bb, bbf, begin, cluster-constraint, constraint,
///     container, contiguous, core-spec, cores-per-socket, cpu-freq, cpus-per-*, deadline,
///     delay-boot, distribution, exclude, exclusive, extra-node-info, gpu*, gres*, hint, hold,
///     licenses, mem*, mincpus, network, nice, nodefile, nodelist, overcommit, oversubscribe,
///     partition, power, priority, qos, reboot, reservation, sockets-per-node, spread-job, switches,
///     thread-spec, threads-per-core, time, time-min, tmp, use-min-nodes, wait-all-nodes
///   only tell and count:         acctg-freq, comment, error, job-name, mail-*, mcs-label, profile,
///     quiet, verbose, wckey
///   the script does not notice:  chdir, export, export-file, get-user-env, gid, ignore-pbs, input,
///     kill-on-invalid-dep, propagate, requeue, uid: it has absolute paths, "afterany" is never in
///     vain, and it is requeued anyway
constexpr std::array<Refused, 22> k_refused{{
    {"array", 'a', "the shares are the array (--shards N, --nodes N)"},
    {"dependency", 'd', "the last job waits for the shares"},
    {"wrap", 0, "the jobs are those of dsbuild's own script (--print writes it)"},
    {"output", 'o', "logs go to the store, where the jobs' mark is"},
    {"open-mode", 0, "logs are appended to, so that a job that is requeued keeps what it said"},
    {"parsable", 0, "it is given, to learn the jobs' numbers"},
    {"wait", 'W', "sbatch would submit the last job only when the shares have ended"},
    {"clusters", 'M',
     "jobs are looked for on one cluster, that of slurm.conf: work where that is the one meant"},
    {"test-only", 0, "no job would be submitted (--print writes the script)"},
    {"help", 'h', k_none_submitted},
    {"usage", 'u', k_none_submitted},
    {"version", 'V', k_none_submitted},
    {"nodes", 'N', k_one_process},
    {"ntasks", 'n', k_one_process},
    {"ntasks-per-core", 0, k_one_process},
    {"ntasks-per-gpu", 0, k_one_process},
    {"ntasks-per-node", 0, k_one_process},
    {"ntasks-per-socket", 0, k_one_process},
    {"ntasks-per-tres", 0, k_one_process},
    {"tasks-per-node", 0, k_one_process},
    {"no-requeue", 0, k_requeued},
    {"no-kill", 'k', k_requeued},
}};

/// Letters of sbatch's that take no value, so that others may follow in one word.
constexpr std::string_view k_flags = "hHIkOQsuvVW";

constexpr std::string_view k_signal = "signal";

[[noreturn]] void refuse(const Refused& option, const std::string& word) {
  fail(ErrorKind::usage, "slurm: sbatch's --{} is not to be given, got {}: {}", option.name, word,
       option.why);
}

/// The script, and no step of it, waits for USR1.
void check_signal(std::string_view value) {
  const std::string_view signal = value.substr(0, value.find('@'));
  for (const std::string_view wanted : {"B:USR1", "B:SIGUSR1", "B:10"})
    if (signal == wanted) return;
  fail(ErrorKind::usage,
       "slurm: sbatch's --signal must be B:USR1@SECONDS (how long before its time limit a job ends "
       "by "
       "itself, to be requeued), got {}",
       value.empty() ? "nothing" : value);
}

/// The name of a long option as far as it is written.
std::string_view name_of(std::string_view word) {
  return word.substr(2, word.find('=') - 2);
}

void check_long(const std::string& word) {
  // The least beginning that tells an option from others is enough for sbatch.
  for (const Refused& option : k_refused)
    if (option.name.starts_with(name_of(word))) refuse(option, word);
}

void check_letters(const std::string& word) {
  for (const char letter : std::string_view(word).substr(1)) {
    for (const Refused& option : k_refused)
      if (option.letter == letter) refuse(option, word);
    if (k_flags.find(letter) == k_flags.npos) return;  // the rest is its value
  }
}

/// The shortest beginning that is no other option's: "--sig".
bool is_signal(std::string_view word) {
  return word.starts_with("--si") && k_signal.starts_with(name_of(word));
}

}  // namespace

void check_sbatch_options(const std::vector<std::string>& words) {
  bool may_be_value = false;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string& word = words[i];
    const bool is_option = word.size() > 1 && word[0] == '-' && word != "--";
    if (!is_option && !may_be_value)
      fail(ErrorKind::usage,
           "slurm: wanted options of sbatch behind --, got {}: sbatch would run it in place of the "
           "script",
           word);
    const bool is_long = is_option && word[1] == '-';
    const bool has_value = word.find('=') != word.npos;
    if (is_long && is_signal(word))
      check_signal(has_value              ? word.substr(word.find('=') + 1)
                   : i + 1 < words.size() ? words[i + 1]
                                          : "");
    else if (is_long)
      check_long(word);
    else if (is_option)
      check_letters(word);
    may_be_value = is_option && (!is_long || !has_value);
  }
}

}  // namespace ds
