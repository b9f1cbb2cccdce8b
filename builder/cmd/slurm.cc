// SPDX-License-Identifier: Apache-2.0
#include "builder/cmd/plan_text.h"
#include "builder/cmd/run_program.h"
#include "builder/cmd/sbatch_options.h"
#include "builder/cmd/slurm_script.h"
#include "builder/cmd/slurm_state.h"
#include "builder/cmd/verbs.h"
#include "builder/store/host.h"
#include "builder/store/store_database.h"
#include "tracer/base/error.h"
#include "tracer/base/files.h"
#include "tracer/base/hash.h"
#include "tracer/base/log.h"
#include "tracer/base/shell_quoted.h"
#include "tracer/base/streams.h"

#include <fmt/chrono.h>

#include <chrono>
#include <cstdlib>
#include <pwd.h>
#include <regex>
#include <sstream>
#include <system_error>
#include <unistd.h>

namespace ds {
namespace {

namespace fs = std::filesystem;

constexpr int k_shards = 8;
constexpr int k_shards_a_node = 4;  ///< so that no node waits long for the last one's share

std::string user_name() {
  const passwd* user = ::getpwuid(::getuid());
  return user != nullptr ? user->pw_name : std::to_string(::getuid());
}

/// On one node several users, and jobs of several stores, may keep what they make in one folder.
std::string local_store_of(const std::string& folder, const fs::path& store) {
  static const std::regex k_place(R"(/.*|\$[A-Za-z_][A-Za-z0-9_]*(/.*)?)");
  if (!std::regex_match(folder, k_place))
    fail(ErrorKind::usage,
         "slurm --local: wanted a folder that every node has, /scratch or '$TMPDIR/x', got {}",
         folder);
  return fmt::format("{}/dsbuild-{}-{}", folder, user_name(),
                     hash_text(store.string()).hex().substr(0, 16));
}

SlurmJob job_of(const Arguments& arguments, const Dataset& dataset) {
  SlurmJob job;
  job.program = fs::read_symlink("/proc/self/exe");
  job.working_folder = fs::current_path();
  job.recipe = fs::absolute(arguments.target).lexically_normal();
  job.folder = dataset.folder;
  job.store = dataset.store ? dataset.store->folder()
              : arguments.store_folder.empty()
                  ? dataset.folder / ".dsbuild"
                  : fs::absolute(arguments.store_folder).lexically_normal();
  job.name = dataset.recipe.name;
  job.nodes = arguments.nodes;
  job.shards = arguments.shards > 0  ? arguments.shards
               : arguments.nodes > 0 ? k_shards_a_node * arguments.nodes
                                     : k_shards;
  for (const std::string& assignment : arguments.overrides)
    job.settings.insert(job.settings.end(), {"--set", assignment});
  if (!arguments.device.empty())
    job.settings.insert(job.settings.end(), {"--device", arguments.device});
  job.sbatch_options = arguments.sbatch_options;
  job.logs = slurm_folder(job.store);
  if (!arguments.local_folder.empty())
    job.local = local_store_of(arguments.local_folder, job.store);
  return job;
}

/// Goes unless jobs were submitted.
class OwnMark {
 public:
  OwnMark(const Dataset& dataset, const SlurmJob& job) {
    mark_.shards = job.shards;
    mark_.recipe = job.recipe;
    mark_.folder = job.folder;
    mark_.since = fmt::format("{:%Y-%m-%d %H:%M:%S}", fmt::gmtime(std::time(nullptr)));
    mark_.user = user_name();
    mark_.host = host_name();
    mark_.process = ::getpid();
    std::optional<SlurmMark> before = find_slurm_mark(*dataset.store);
    if (before) refuse_unless_gone(*dataset.store, *before);
    if (!make_slurm_mark(*dataset.store, before, mark_)) {
      const auto winner = find_slurm_mark(*dataset.store);
      fail(ErrorKind::usage, "{}: {} began at the same moment", dataset.store->folder().string(),
           winner ? jobs_text(*winner) : "another dsbuild slurm");
    }
    if (before)
      warn(fmt::format("{}: {}, ended before it was whole: this goes on where they were",
                       dataset.store->folder().string(), jobs_text(*before)));
  }
  ~OwnMark() {
    if (mark_.jobs.empty()) ::unlink(mark_.file.c_str());
  }
  OwnMark(const OwnMark&) = delete;
  OwnMark& operator=(const OwnMark&) = delete;

  const fs::path& file() const { return mark_.file; }
  void submitted(std::vector<std::string> jobs) {
    mark_.jobs = std::move(jobs);
    add_jobs(mark_);
  }

 private:
  static void refuse_unless_gone(const Store& store, const SlurmMark& mark) {
    const SlurmState state = state_of(mark);
    if (state == SlurmState::running)
      fail(ErrorKind::usage, "{}: {}, fill this store now; wait for them, or end them by scancel",
           store.folder().string(), jobs_text(mark));
    if (state == SlurmState::unknown)
      fail(ErrorKind::io, "{}: {}, may fill this store now: squeue does not say; remove {} if not",
           store.folder().string(), jobs_text(mark), mark.file.string());
  }

  SlurmMark mark_;
};

nlohmann::json to_json(const SlurmJob& job) {
  return {{"shards", job.shards},
          {"logs", job.logs.string()},
          {"folder", job.folder.string()},
          {"store", job.store.string()}};
}

/// --print: nothing is submitted.
void print_script(const SlurmJob& job, bool json) {
  if (!json) return write_text(Stream::result, slurm_script(job));
  nlohmann::json object = to_json(job);
  object["script_text"] = slurm_script(job);
  print_json(object);
}

/// Plans once, so that no shard reads every model anew: the database is left in the store.
PlanCounts plan_once(Dataset& dataset, const fs::path& folder, Disk& disk) {
  Inputs inputs(*dataset.database, Stamps::trust);
  const PlanCounts counts = count(make_plan(dataset, inputs, false));
  put_database(*dataset.store, *dataset.database, folder, disk);
  return counts;
}

std::vector<std::string> submit(const fs::path& script) {
  const ProgramAnswer answer = run_program({"bash", script.string()});
  std::istringstream lines(answer.said);
  std::vector<std::string> jobs;
  for (std::string id; lines >> id;)
    jobs.push_back(id);
  if (answer.code != 0 || jobs.size() != 2)
    fail(ErrorKind::io, "slurm: sbatch takes the jobs of {} not (exit code {})", script.string(),
         answer.code);
  return jobs;
}

}  // namespace

int run_slurm(const Arguments& arguments) {
  check_sbatch_options(arguments.sbatch_options);
  std::error_code error;
  if (fs::is_directory(arguments.target, error))
    fail(ErrorKind::usage, "slurm: wanted a recipe, found the folder {}", arguments.target);
  RealDisk disk;
  if (arguments.print) {
    const Dataset dataset = open_dataset(arguments.request(), Access::look, disk);
    print_script(job_of(arguments, dataset), arguments.json);
    return 0;
  }
  if (!find_program("sbatch"))
    fail(ErrorKind::io, "slurm: no sbatch on PATH, so no Slurm; --print writes the script");
  const TemporaryFolder own;
  DatasetRequest request = arguments.request();
  request.database_folder = own.path();
  request.local_folder.clear();  // that is the nodes'
  Dataset dataset = open_dataset(request, Access::build, disk);
  refuse_read_only(dataset.store->folder(), "jobs keep there what they make");
  SlurmJob job = job_of(arguments, dataset);
  OwnMark mark(dataset, job);
  job.mark = mark.file();
  const PlanCounts counts = plan_once(dataset, own.path(), disk);
  const fs::path script = mark.file().string() + ".sh";
  write_file_atomic(script, slurm_script(job));
  const std::vector<std::string> jobs = submit(script);
  mark.submitted(jobs);
  if (arguments.json) {
    nlohmann::json object = to_json(counts);
    object.update(to_json(job));
    object.update({{"jobs", jobs}, {"script", script.string()}});
    print_json(object);
    return 0;
  }
  std::string settings;
  for (const std::string& assignment : arguments.overrides)
    settings += " --set " + shell_quoted(assignment);
  say(Stream::report,
      "{}\nsubmitted: job {}, {} shares, and job {} behind it; logs: {}\n"
      "how far they are: dsbuild status {} -o {}{}\n",
      summary(counts), jobs[0], job.shards, jobs[1], job.logs.string(),
      shell_quoted(job.recipe.string()), shell_quoted(job.folder.string()), settings);
  return 0;
}

}  // namespace ds
