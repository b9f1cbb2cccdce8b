// SPDX-License-Identifier: Apache-2.0
#include "builder/cmd/stop_signal.h"

#include <gtest/gtest.h>

#include <csignal>
#include <functional>
#include <sys/wait.h>
#include <unistd.h>

namespace ds {
namespace {

constexpr int k_survived = 7;

/// The signal that ends a child which runs this, or minus the code it returns.
int end_of(const std::function<int()>& body) {
  const pid_t child = ::fork();
  if (child == 0) ::_exit(body());
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFSIGNALED(status) ? WTERMSIG(status) : -WEXITSTATUS(status);
}

constexpr int k_signals[] = {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGXCPU, SIGUSR1, SIGUSR2};

/// As others send it, to the process, and time for it to arrive: until it is heeded, or long enough.
void send(int signal) {
  const bool first = !stopped_by_signal();
  ::kill(::getpid(), signal);
  for (int i = 0; i < 100 && !(first && stopped_by_signal()); ++i)
    ::usleep(1000);
}

/// What OpenCL's compiler does when it is loaded: it takes the signals for itself.
void take_signals() {
  for (const int signal : k_signals)
    std::signal(signal, [](int) {});
}

/// Two signals with a wait between them, then the end that main makes.
int end_of_two(int first, int second, useconds_t between_us) {
  return end_of([=] {
    watch_signals();
    stop_on_signal();
    take_signals();
    send(first);
    ::usleep(between_us);
    send(second);
    return stopped_by_signal() ? k_survived : 0;
  });
}

TEST(StopSignalTest, the_first_sets_it_and_is_what_the_process_dies_of) {
  for (const int signal : k_signals) {
    const auto body = [signal] {
      watch_signals();
      const std::atomic<bool>& stop = stop_on_signal();
      take_signals();
      if (stop) return 1;
      send(signal);
      if (!stop) return 2;
      die_of_stop_signal();
      return 3;
    };
    EXPECT_EQ(end_of(body), signal);
  }
}

TEST(StopSignalTest, before_anything_can_stop_it_ends_the_process) {
  for (const int signal : k_signals)
    EXPECT_EQ(end_of([signal] {
                watch_signals();
                take_signals();
                send(signal);
                return k_survived;
              }),
              signal);
}

TEST(StopSignalTest, without_one_nothing_dies) {
  EXPECT_EQ(end_of([] {
              watch_signals();
              stop_on_signal();
              die_of_stop_signal();
              return stopped_by_signal() ? 1 : k_survived;
            }),
            -k_survived);
}

TEST(StopSignalTest, a_second_one_ends_at_once) {
  EXPECT_EQ(end_of_two(SIGINT, SIGINT, 300'000), SIGINT);
  EXPECT_EQ(end_of_two(SIGINT, SIGTERM, 300'000), SIGTERM);
  EXPECT_EQ(end_of_two(SIGUSR1, SIGQUIT, 300'000), SIGQUIT);
}

TEST(StopSignalTest, one_wish_told_twice_is_one) {
  EXPECT_EQ(end_of_two(SIGTERM, SIGTERM, 0), -k_survived);
  EXPECT_EQ(end_of_two(SIGINT, SIGTERM, 20'000), -k_survived);
  // What a batch system or a terminal repeats is not a user's impatience.
  for (const int signal : {SIGHUP, SIGXCPU, SIGUSR1, SIGUSR2})
    EXPECT_EQ(end_of_two(signal, signal, 300'000), -k_survived);
}

TEST(StopSignalTest, ignored_at_the_start_stays_ignored) {
  for (const int signal : k_signals) {
    const auto body = [signal] {
      std::signal(signal, SIG_IGN);
      watch_signals();
      stop_on_signal();
      send(signal);
      die_of_stop_signal();
      return stopped_by_signal() ? 1 : k_survived;
    };
    EXPECT_EQ(end_of(body), -k_survived);
  }
}

}  // namespace
}  // namespace ds
