// SPDX-License-Identifier: Apache-2.0
#include "builder/cmd/slurm_script.h"

#include "tracer/base/shell_quoted.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>

namespace ds {
namespace {

std::string array_of(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words)
    text += (text.empty() ? "" : " ") + shell_quoted(word);
  return "(" + text + ")";
}

/// A comment is one line.
std::string one_line(std::string text) {
  for (char& c : text)
    if (static_cast<unsigned char>(c) < ' ') c = '?';
  return text;
}

/// sbatch puts job numbers where a file name has a "%".
std::string without_patterns(const std::string& path) {
  std::string text;
  for (const char c : path)
    text += c == '%' ? "%%" : std::string(1, c);
  return text;
}

/// '"${TMPDIR:?}"/x' of "$TMPDIR/x".
std::string local_text(const std::string& local) {
  if (local.empty() || local.front() != '$') return shell_quoted(local);
  const std::size_t end = std::min(local.find('/'), local.size());
  const std::string rest = local.substr(end);
  return fmt::format("\"${{{}:?}}\"{}", local.substr(1, end - 1),
                     rest.empty() ? "" : shell_quoted(rest));
}

constexpr const char* k_use_text =
    R"(# It submits itself: bash FILE, or a pipe into bash. Its jobs are FILE shard (with SLURM_ARRAY_TASK_ID) and FILE last.
set -euo pipefail

# From a pipe: sbatch wants a file, of which it keeps a copy. What bash has not read yet is the rest of this text.
if [ -z "${BASH_SOURCE[0]:-}" ]; then
  file=$(mktemp -- "${TMPDIR:-/tmp}/dsbuild-slurm.XXXXXXXX")
  trap 'rm -f -- "$file"' EXIT
  { echo '#!/bin/bash'; cat; } >"$file"
  bash "$file" "$@"
  exit
fi

)";

constexpr const char* k_submission_text = R"(
# Without a word it submits itself and prints the ids of both jobs. Of a job that is requeued Slurm would otherwise
# write the log anew. USR1 comes before the time limit, a minute or two (--signal=B:USR1@600 among the options: ten).
if [ $# -eq 0 ]; then
  mkdir -p -- "$logs"
  unset SBATCH_ARRAY_INX SBATCH_WAIT
  common=(--parsable --ntasks=1 --requeue --open-mode=append --signal=B:USR1@60)
  array=$(sbatch "${common[@]}" --job-name="$name" --array="$array" --output="$logs_pattern/%A-%a.log" \
    "${options[@]}" "$0" shard)
  array=${array%%;*}
  # Also where a shard failed: what it left, the last job makes.
  last=$(sbatch "${common[@]}" --job-name="$name, last" --output="$logs_pattern/%j.log" "${options[@]}" \
    --dependency="afterany:$array" "$0" last) || { scancel "$array"; exit 1; }
  printf '%s\n' "$array" "${last%%;*}"
  exit 0
fi
)";

constexpr const char* k_job_text = R"(
# The database and its locks need a disk of this machine's own; all else that is to last goes to the store.
tmp=$(mktemp -d -- "${SLURM_TMPDIR:-${TMPDIR:-/tmp}}/dsbuild.XXXXXXXX")
trap 'rm -rf -- "$tmp"' EXIT

# dsbuild ends after the image under way where it is told to by a signal. Slurm signals this shell alone.
limit='' child=''
trap 'limit=yes; [ -z "$child" ] || kill -USR1 "$child"' USR1
trap '[ -z "$child" ] || kill -TERM "$child"' TERM

# Runs a command to its end though signals come meanwhile, and keeps what it says of itself in $tmp/said.
run() {
  local code=0
  "$@" >"$tmp/said" &
  child=$!
  wait "$child" || code=$?
  while kill -0 "$child" 2>/dev/null; do
    code=0
    wait "$child" || code=$?
  done
  child=''
  cat -- "$tmp/said"
  return "$code"
}

# Before its time limit a job that made anything goes on as a new one; the others would never end.
go_on_later() {
  if [ -z "$limit" ] || grep -q '"built":0,' "$tmp/said"; then return; fi
  echo "the time limit is near: requeued, to go on with what is left"
  scontrol requeue "$SLURM_JOB_ID"
}

cd -- "$working_folder"
code=0
build=("$dsbuild" build "$recipe" --store "$store" --database "$tmp/database" --keep-going --json "${settings[@]}")
case $1 in
  shard)  # makes its share of the images; their files in a folder are the last job's to place
    share=(-o "$tmp/out" --no-files --shard "$SLURM_ARRAY_TASK_ID/$shards")
    local=$(node_store)
    [ -z "$local" ] || share+=(--local "$local")
    run "${build[@]}" "${share[@]}" || code=$?
    # A build that was killed could not bring what it had made.
    if [ "$code" -ne 0 ] && [ -n "$local" ] && [ -d "$local/records" ]; then
      "$dsbuild" store gather "$local" "$store" --database "$tmp/database" --json || code=$?
    fi
    go_on_later
    ;;
  last)  # makes what shards left, places the files, writes the manifest, leaves the database in the store
    run "${build[@]}" -o "$folder" || code=$?
    go_on_later
    # What it found so far would be lost by a signal: the time that is left may be enough for the rest.
    trap '' USR1
    if [ "$code" -eq 0 ]; then run "$dsbuild" verify "$folder" --database "$tmp/database" --json || code=$?; fi
    if [ "$code" -eq 0 ] && [ -n "$mark" ]; then rm -f -- "$mark"; fi
    ;;
esac
exit "$code"
)";

}  // namespace

std::string slurm_script(const SlurmJob& job) {
  std::string text =
      fmt::format("#!/bin/bash\n# {} by Slurm, in {} shares; written by dsbuild slurm.\n",
                  one_line(job.name), job.shards);
  text += k_use_text;
  const auto set = [&](const char* name, const std::string& value) {
    text += fmt::format("{}={}\n", name, value);
  };
  set("dsbuild", shell_quoted(job.program.string()));
  set("working_folder", shell_quoted(job.working_folder.string()));
  set("recipe", shell_quoted(job.recipe.string()));
  set("folder", shell_quoted(job.folder.string()));
  set("store", shell_quoted(job.store.string()));
  set("settings", array_of(job.settings));
  set("name", shell_quoted("dsbuild " + job.name));
  set("shards", std::to_string(job.shards));
  set("array",
      fmt::format("1-{}{}", job.shards, job.nodes > 0 ? fmt::format("%{}", job.nodes) : ""));
  set("options", array_of(job.sbatch_options));
  set("logs", shell_quoted(job.logs.string()));
  set("logs_pattern", shell_quoted(without_patterns(job.logs.string())));
  set("mark", job.mark.empty() ? "''" : shell_quoted(job.mark.string()));
  // Only a node knows what a job's variables are.
  text += fmt::format("node_store() {{ printf %s {}; }}\n", local_text(job.local));
  return text + k_submission_text + k_job_text;
}

}  // namespace ds
