// SPDX-License-Identifier: Apache-2.0
#include "builder/cmd/supervisor.h"

#include "builder/cmd/arguments.h"
#include "builder/cmd/error_text.h"
#include "builder/cmd/plan_text.h"
#include "builder/cmd/stop_signal.h"
#include "tracer/base/error.h"
#include "tracer/base/streams.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <ctime>
#include <new>
#include <stdexcept>
#include <string>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>
#include <utility>

namespace ds {
namespace {

/// More processes in a row that die without an image made are no image's fault.
constexpr int k_most_in_vain = 10;
/// Processes in a row that hang or die outside of images, before the build is given up.
constexpr int k_most_idle = 2;

/// Where in its work a process is.
enum class Phase { before_images, in_image, behind_images };

/// Memory that both processes see. Only the one that builds writes, while it lives.
struct WatchedState {
  std::atomic<std::uint64_t> beats;  ///< signs of life
  std::atomic<double> hang_seconds;
  std::atomic<bool> ended;  ///< it has told all it has to tell
  std::atomic<int> code;    ///< its exit code, then
  std::atomic<std::uint64_t> to_make, to_trace, built, failed;
  std::atomic<Phase> phase;
  char image[4096];   ///< its id, and a zero; longer ones are cut
  char device[1024];  ///< likewise
};

template <std::size_t Size>
void put_text(char (&to)[Size], const std::string& text) {
  const std::size_t size = std::min(text.size(), Size - 1);
  std::memcpy(to, text.data(), size);
  to[size] = '\0';
}

WatchedState* g_shared = nullptr;
EarlierProcesses g_earlier;
bool g_json = false;  ///< the report is asked for

/// Why a process ended that did not end by itself.
struct Death {
  std::string how;
  int signal = 0;  ///< 0: it ended by exit
  int code = 1;
};

bool is_stop(int signal) {
  const auto signals = stop_signals();
  return std::find(signals.begin(), signals.end(), signal) != signals.end();
}

/// Those to pass on: a process that ignores one at start is not to be told by us.
sigset_t signals_to_wait_for() {
  sigset_t set;
  ::sigemptyset(&set);
  ::sigaddset(&set, SIGCHLD);
  for (const int signal : stop_signals()) {
    struct sigaction before = {};
    if (::sigaction(signal, nullptr, &before) == 0 && before.sa_handler != SIG_IGN)
      ::sigaddset(&set, signal);
  }
  return set;
}

/// `ulimit -t` is a process's own: another one would begin anew.
bool used_up_its_time(const rusage& use) {
  rlimit limit = {};
  if (::getrlimit(RLIMIT_CPU, &limit) != 0 || limit.rlim_max == RLIM_INFINITY) return false;
  return static_cast<rlim_t>(use.ru_utime.tv_sec + use.ru_stime.tv_sec + 1) >= limit.rlim_max;
}

/// What a process has computed so far; 0 where the system does not tell.
std::int64_t cpu_nanoseconds(pid_t process) {
  clockid_t clock = {};
  timespec time = {};
  if (::clock_getcpuclockid(process, &clock) != 0 || ::clock_gettime(clock, &time) != 0) return 0;
  return std::int64_t{time.tv_sec} * 1'000'000'000 + time.tv_nsec;
}

/// Waits for the process, passes on what it is told, and ends it where it hangs.
struct Watch {
  pid_t process;
  sigset_t signals;
  bool hung = false;
  int told = 0;  ///< the last signal that was passed on
  int status = 0;
  rusage use = {};
  std::uint64_t beats = 0;
  std::int64_t cpu = 0;

  /// Within an image it tells how far it is, and a device's driver may compute for ever. Outside of
  /// one it reads, hashes and waits for other builds, which takes as long as it takes: there what it
  /// computes is a sign too.
  bool shows_life() {
    const bool beat = std::exchange(beats, g_shared->beats.load()) != beats;
    const std::int64_t cpu_before = std::exchange(cpu, cpu_nanoseconds(process));
    return beat || (g_shared->phase != Phase::in_image && cpu != cpu_before);
  }

  void pass_on(int signal) {
    told = signal;
    ::kill(process, signal);
    ::kill(process, SIGCONT);  // one that is stopped would never hear of it
  }

  void wait() {
    // A second at a time is counted, so that a process stopped with this one did not hang.
    double idle = 0;
    while (::wait4(process, &status, WNOHANG, &use) != process) {
      constexpr timespec second = {1, 0};
      siginfo_t info = {};
      const int signal = ::sigtimedwait(&signals, &info, &second);
      if (signal > 0 && signal != SIGCHLD) pass_on(signal);
      if (shows_life()) {
        idle = 0;
      } else if (signal < 0 && errno == EAGAIN) {
        idle += 1;
      }
      const double most = g_shared->hang_seconds;
      if (most <= 0 || idle < most || hung) continue;
      hung = true;
      ::kill(process, SIGKILL);
    }
  }

  /// How one ended that has told all: a driver may hang or crash as the process goes.
  std::optional<int> code() const {
    if (!g_shared->ended) return std::nullopt;
    if (WIFEXITED(status)) return WEXITSTATUS(status);
    if (!hung && is_stop(WTERMSIG(status))) return std::nullopt;
    say(Stream::people, "dsbuild: warning: the process that built {} when all was done\n",
        death().how);
    return g_shared->code;
  }

  Death death() const {
    if (hung)
      return {fmt::format("showed no sign of life for {} s", g_shared->hang_seconds.load()), 0, 1};
    if (WIFSIGNALED(status)) {
      const int signal = WTERMSIG(status);
      return {fmt::format("died of signal {} ({})", signal, ::strsignal(signal)), signal, 1};
    }
    return {fmt::format("ended with exit code {} in the middle of its work", WEXITSTATUS(status)),
            0, std::max(1, WEXITSTATUS(status))};
  }
};

/// As a wish to end ends every process.
int end_as(const Death& death) {
  if (death.signal != 0) die_of_signal(death.signal);
  return death.code;
}

void add_up() {
  ++g_earlier.deaths;
  g_earlier.to_make = std::max(g_earlier.to_make, g_shared->to_make.load());
  g_earlier.samples_to_trace = std::max(g_earlier.samples_to_trace, g_shared->to_trace.load());
  g_earlier.made = g_earlier.journal->read();
  if (g_shared->device[0] != '\0') g_earlier.device = g_shared->device;
}

/// The end where another process would be for nothing: what is made is recorded.
int give_up(const std::exception& error) {
  say(Stream::people, "dsbuild: error: {}\n", error.what());
  nlohmann::json report = error_json(error);
  std::uint64_t built = 0, traced = 0, developed = 0, samples = 0;
  for (const auto& [id, image] : g_earlier.made) {
    if (!image.placed) continue;
    ++built;
    traced += image.work.traced ? 1U : 0U;
    developed += image.work.developed ? 1U : 0U;
    samples += image.work.samples;
  }
  const std::chrono::duration<double> time = std::chrono::steady_clock::now() - g_earlier.began;
  report.update({{"built", built},
                 {"traced", traced},
                 {"developed", developed},
                 {"traced_samples", samples},
                 {"deaths", g_earlier.deaths},
                 {"seconds", time.count()},
                 {"device", g_earlier.device}});
  if (g_json) print_json(report);
  return report["exit_code"].get<int>();
}

/// Enters the death of a process with the image it was at; how often that happened at this image.
int blame(const std::string& id, const std::string& how) {
  const auto known = std::find_if(g_earlier.crashed.begin(), g_earlier.crashed.end(),
                                  [&](const CrashedImage& image) { return image.id == id; });
  if (known == g_earlier.crashed.end()) {
    g_earlier.crashed.push_back({id, how, 1});
    return 1;
  }
  known->how = how;
  return ++known->times;
}

/// Processes in a row that came to nothing.
struct InVain {
  int crashed = 0;  ///< with an image, and made none
  int idle = 0;     ///< hung or died before their first image, or behind their last
};

const char* phase_text() {
  switch (g_shared->phase) {
    case Phase::before_images:
      return "before its first image";
    case Phase::in_image:
      return "in an image";
    case Phase::behind_images:
      return "behind its last image, as the manifest is written";
  }
  return "";
}

/// What follows on a process that hung or died outside of its images.
std::optional<int> after_idling(const Death& death, InVain& in_vain) {
  const std::string what = fmt::format("the process that builds {} {}", death.how, phase_text());
  if (++in_vain.idle >= k_most_idle)
    return give_up(
        std::runtime_error(what + ", again; what is made is kept: build again to go on"));
  say(Stream::people, "dsbuild: warning: {}; another one goes on\n", what);
  return std::nullopt;
}

/// What follows on one that did in an image.
std::optional<int> after_image(const Death& death, InVain& in_vain) {
  const std::string id = g_shared->image;
  if (g_shared->built == 0) ++in_vain.crashed;
  const bool again = blame(id, death.how) < k_most_crashes;
  say(Stream::people, "dsbuild: warning: {}: the process that made it {}{}\n", id, death.how,
      again ? "; it is tried once more" : ", again");
  if (in_vain.crashed < k_most_in_vain) return std::nullopt;
  return give_up(Error(ErrorKind::device,
                       fmt::format("{} processes in a row died with no image made: it is not the "
                                   "images; is the device well (--device)?",
                                   in_vain.crashed)));
}

/// What follows on a death: nothing where another process is to be begun, else how this one ends.
std::optional<int> after(const Watch& watch, const Death& death, InVain& in_vain) {
  const bool out_of_time = death.signal == SIGKILL && used_up_its_time(watch.use);
  if (watch.hung && watch.told != 0) return end_as({death.how, watch.told, 1});
  if (watch.told != 0 || is_stop(death.signal) || out_of_time) return end_as(death);
  if (::isatty(STDERR_FILENO) == 1) say(Stream::people, "\n");  // behind the line that moved
  if (g_shared->built > 0) in_vain = {};
  add_up();
  return g_shared->phase == Phase::in_image ? after_image(death, in_vain)
                                            : after_idling(death, in_vain);
}

}  // namespace

std::optional<int> watch_over_build(bool json) {
  void* const memory = ::mmap(nullptr, sizeof(WatchedState), PROT_READ | PROT_WRITE,
                              MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) return std::nullopt;
  const sigset_t signals = signals_to_wait_for();
  sigset_t before;
  ::pthread_sigmask(SIG_BLOCK, &signals, &before);
  const pid_t watching = ::getpid();
  g_earlier.began = std::chrono::steady_clock::now();
  static MadeJournal journal;
  g_earlier.journal = &journal;
  g_json = json;
  double hang_seconds = Arguments{}.stall_seconds;
  for (InVain in_vain;;) {
    g_shared = new (memory) WatchedState{};
    g_shared->hang_seconds = hang_seconds;
    const pid_t process = ::fork();
    if (process <= 0) {
      ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
      if (process < 0) {
        g_shared = nullptr;
        return std::nullopt;
      }
      // Who kills the one means both. The other may have died before it was asked for.
      ::prctl(PR_SET_PDEATHSIG, SIGKILL);
      if (::getppid() != watching) ::_exit(1);
      return std::nullopt;
    }
    Watch watch{process, signals};
    watch.wait();
    hang_seconds = g_shared->hang_seconds;
    if (const std::optional<int> code = watch.code()) return code;
    if (const std::optional<int> code = after(watch, watch.death(), in_vain)) return code;
  }
}

EarlierProcesses earlier_processes() {
  return g_earlier;
}

void expect_signs_of_life(double hang_seconds) {
  if (hang_seconds != 0 && hang_seconds < k_least_stall_seconds)
    fail(
        ErrorKind::usage,
        "build --stall: wanted at least {} seconds, or 0 for never, got {}: compiling a program or "
        "reading a large model takes seconds without a sign of life",
        k_least_stall_seconds, hang_seconds);
  if (g_shared != nullptr) g_shared->hang_seconds = hang_seconds;
}

void tell_device(const std::string& device) {
  if (g_shared != nullptr) put_text(g_shared->device, device);
}

void tell_end_of_build(int code) {
  if (g_shared == nullptr) return;
  g_shared->code = code;
  g_shared->ended = true;
}

WatchedObserver::WatchedObserver(BuildObserver& observer) : observer_(observer) {}

WatchedObserver::~WatchedObserver() {
  if (g_shared != nullptr) g_shared->phase = Phase::behind_images;
}

void WatchedObserver::started(std::uint64_t images, std::uint64_t samples) {
  if (g_shared != nullptr) {
    g_shared->to_make = images;
    g_shared->to_trace = samples;
    g_shared->failed = 0;  // those that never began
  }
  observer_.started(images, samples);
}

void WatchedObserver::image_started(const PlannedImage& image) {
  if (g_shared != nullptr) {
    put_text(g_shared->image, image.spec.id);
    g_shared->phase = Phase::in_image;
    ++g_shared->beats;
  }
  observer_.image_started(image);
}

void WatchedObserver::progress(const PlannedImage& image, const TraceProgress& progress) {
  if (g_shared != nullptr) ++g_shared->beats;
  observer_.progress(image, progress);
}

void WatchedObserver::image_done(const PlannedImage& image, const ImageWork& work) {
  if (g_shared != nullptr) {
    ++g_shared->beats;
    ++g_shared->built;
  }
  observer_.image_done(image, work);
}

void WatchedObserver::image_failed(const PlannedImage& image, const std::string& why) {
  if (g_shared != nullptr) {
    ++g_shared->beats;
    ++g_shared->failed;
  }
  observer_.image_failed(image, why);
}

void WatchedObserver::waiting() {
  if (g_shared != nullptr) ++g_shared->beats;
  observer_.waiting();
}

void WatchedObserver::all_tried() {
  if (g_shared != nullptr) {
    ++g_shared->beats;
    g_shared->phase = Phase::behind_images;
  }
  observer_.all_tried();
}

}  // namespace ds
