// SPDX-License-Identifier: Apache-2.0
#include "builder/cmd/supervisor.h"

#include "builder/cmd/stop_signal.h"
#include "tracer/base/streams.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <ctime>
#include <new>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace ds {
namespace {

/// More processes in a row that die without an image made are no image's fault.
constexpr int k_most_in_vain = 10;

/// Memory that both processes see. Only the one that builds writes, while it lives.
struct WatchedState {
  std::atomic<std::uint64_t> beats;  ///< signs of life
  std::atomic<double> hang_seconds;
  std::atomic<bool> ended;  ///< it has told all it has to tell
  std::atomic<std::uint64_t> to_make, built, traced, developed, samples;
  std::atomic<bool> in_image;
  char image[4096];  ///< its id, and a zero; longer ones are cut
};

WatchedState* g_shared = nullptr;
EarlierProcesses g_earlier;

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

/// Waits for the process, passes on what it is told, and ends it where it hangs.
struct Watch {
  pid_t process;
  sigset_t signals;
  bool hung = false, told_to_stop = false;
  int status = 0;
  rusage use = {};

  void wait() {
    // A second at a time is counted, so that a process stopped with this one did not hang.
    double idle = 0;
    std::uint64_t beats = g_shared->beats;
    while (::wait4(process, &status, WNOHANG, &use) != process) {
      constexpr timespec second = {1, 0};
      siginfo_t info = {};
      const int signal = ::sigtimedwait(&signals, &info, &second);
      if (signal > 0 && signal != SIGCHLD) {
        told_to_stop = true;
        ::kill(process, signal);
      }
      if (const std::uint64_t now = g_shared->beats; now != beats || !g_shared->in_image) {
        beats = now;
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

  std::optional<Death> death() const {
    if (hung)
      return Death{fmt::format("showed no sign of life for {} s", g_shared->hang_seconds.load()),
                   SIGKILL, 1};
    if (WIFSIGNALED(status)) {
      const int signal = WTERMSIG(status);
      return Death{fmt::format("died of signal {} ({})", signal, ::strsignal(signal)), signal, 1};
    }
    if (!g_shared->ended)
      return Death{
          fmt::format("ended with exit code {} in the middle of its work", WEXITSTATUS(status)), 0,
          std::max(1, WEXITSTATUS(status))};
    return std::nullopt;
  }
};

/// By the signal only where that is a wish: the other process has left its core already.
int end_as(const Death& death) {
  if (is_stop(death.signal) || death.signal == SIGKILL) die_of_signal(death.signal);
  return death.signal != 0 ? 128 + death.signal : death.code;
}

void add_up() {
  if (g_earlier.deaths == 0) g_earlier.to_make = g_shared->to_make;
  g_earlier.traced += g_shared->traced;
  g_earlier.developed += g_shared->developed;
  g_earlier.samples += g_shared->samples;
}

/// Enters the death of a process with the image it was at; how often that happened at this image.
int blame(const std::string& id, const std::string& how) {
  ++g_earlier.deaths;
  const auto known = std::find_if(g_earlier.crashed.begin(), g_earlier.crashed.end(),
                                  [&](const CrashedImage& image) { return image.id == id; });
  if (known == g_earlier.crashed.end()) {
    g_earlier.crashed.push_back({id, how, 1});
    return 1;
  }
  known->how = how;
  return ++known->times;
}

/// What follows on a death: nothing where another process is to be begun, else how this one ends.
std::optional<int> after(const Watch& watch, const Death& death, int& in_vain) {
  const std::string id = g_shared->image;
  const bool is_final = watch.told_to_stop || is_stop(death.signal) ||
                        (death.signal == SIGKILL && !watch.hung && used_up_its_time(watch.use));
  if (is_final) return end_as(death);
  if (!g_shared->in_image) {
    say(Stream::people, "dsbuild: error: the process that builds {}\n", death.how);
    return end_as(death);
  }
  if (::isatty(STDERR_FILENO) == 1) say(Stream::people, "\n");  // behind the line that moved
  add_up();
  in_vain = g_shared->built > 0 ? 0 : in_vain + 1;
  const bool again = blame(id, death.how) < k_most_crashes;
  say(Stream::people, "dsbuild: warning: {}: the process that made it {}{}\n", id, death.how,
      again ? "; it is tried once more" : ", again");
  if (in_vain < k_most_in_vain) return std::nullopt;
  say(Stream::people,
      "dsbuild: error: {} processes in a row died with no image made: it is not the images; is the "
      "device well (--device)?\n",
      in_vain);
  return end_as(death);
}

}  // namespace

std::optional<int> watch_over_build() {
  void* const memory = ::mmap(nullptr, sizeof(WatchedState), PROT_READ | PROT_WRITE,
                              MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) return std::nullopt;
  const sigset_t signals = signals_to_wait_for();
  sigset_t before;
  ::pthread_sigmask(SIG_BLOCK, &signals, &before);
  const pid_t watching = ::getpid();
  for (int in_vain = 0;;) {
    g_shared = new (memory) WatchedState{};
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
    const std::optional<Death> death = watch.death();
    if (!death) return WEXITSTATUS(watch.status);
    if (const std::optional<int> code = after(watch, *death, in_vain)) return code;
  }
}

EarlierProcesses earlier_processes() {
  return g_earlier;
}

void tell_end_of_build() {
  if (g_shared != nullptr) g_shared->ended = true;
}

WatchedObserver::WatchedObserver(BuildObserver& observer, double hang_seconds)
    : observer_(observer) {
  if (g_shared != nullptr) g_shared->hang_seconds = hang_seconds;
}

WatchedObserver::~WatchedObserver() {
  if (g_shared != nullptr) g_shared->in_image = false;
}

void WatchedObserver::started(std::uint64_t images, std::uint64_t samples) {
  if (g_shared != nullptr) g_shared->to_make = images;
  observer_.started(images, samples);
}

void WatchedObserver::image_started(const PlannedImage& image) {
  if (g_shared != nullptr) {
    const std::string& id = image.spec.id;
    const std::size_t size = std::min(id.size(), sizeof(g_shared->image) - 1);
    std::memcpy(g_shared->image, id.data(), size);
    g_shared->image[size] = '\0';
    g_shared->in_image = true;
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
    g_shared->traced += work.traced ? 1U : 0U;
    g_shared->developed += work.developed ? 1U : 0U;
    g_shared->samples += work.samples;
  }
  observer_.image_done(image, work);
}

void WatchedObserver::image_failed(const PlannedImage& image, const std::string& why) {
  if (g_shared != nullptr) ++g_shared->beats;
  observer_.image_failed(image, why);
}

void WatchedObserver::waiting() {
  if (g_shared != nullptr) ++g_shared->beats;
  observer_.waiting();
}

}  // namespace ds
