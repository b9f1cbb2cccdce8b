// SPDX-License-Identifier: Apache-2.0
#include "tracer/base/streams.h"

#include "tracer/base/files.h"
#include "tracer/base/log.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <fcntl.h>
#include <functional>
#include <sys/wait.h>
#include <unistd.h>

namespace ds {
namespace {

/// The exit code of a child that runs this with standard output and error at the given paths.
int exit_code_of(const std::function<int()>& body, const std::string& out, const std::string& err) {
  std::fflush(nullptr);
  const pid_t child = ::fork();
  if (child == 0) {
    ::dup2(::open(out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600), STDOUT_FILENO);
    ::dup2(::open(err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600), STDERR_FILENO);
    ::_exit(body());
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST(StreamsTest, only_a_lost_result_is_a_loss) {
  const auto code = [](Stream to) {
    return [to] {
      say(to, "{}\n", std::string(100'000, 'x'));
      return lost_result() ? 1 : 0;
    };
  };
  EXPECT_EQ(exit_code_of(code(Stream::result), "/dev/full", "/dev/null"), 1);
  EXPECT_EQ(exit_code_of(code(Stream::report), "/dev/full", "/dev/null"), 0);
  EXPECT_EQ(exit_code_of(code(Stream::people), "/dev/null", "/dev/full"), 0);
  EXPECT_EQ(exit_code_of(code(Stream::result), "/dev/null", "/dev/full"), 0);
}

TEST(StreamsTest, a_short_result_is_lost_when_it_is_flushed) {
  const auto body = [] {
    say(Stream::result, "short\n");
    return lost_result() == "No space left on device" ? 1 : 0;
  };
  EXPECT_EQ(exit_code_of(body, "/dev/full", "/dev/null"), 1);
}

TEST(StreamsTest, closed_descriptors_are_reserved_and_stay_unusable) {
  const TemporaryFolder folder;
  const std::string file = (folder.path() / "file").string();
  const auto body = [&] {
    for (const int closed : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
      ::close(closed);
    reserve_standard_streams();
    const int opened = ::open(file.c_str(), O_WRONLY | O_CREAT, 0600);
    say(Stream::people, "for people\n");
    say(Stream::result, "a result\n");
    return opened > STDERR_FILENO && lost_result() == "Bad file descriptor" ? 0 : 1;
  };
  EXPECT_EQ(exit_code_of(body, "/dev/null", "/dev/null"), 0);
  EXPECT_EQ(read_text_file(file), "");
}

TEST(StreamsTest, a_warning_is_said_once) {
  const TemporaryFolder folder;
  const std::string file = (folder.path() / "err").string();
  const auto body = [] {
    for (int i = 0; i < 3; ++i) {
      warn("a.exr: negative");
      warn("b.exr: negative");
    }
    return 0;
  };
  EXPECT_EQ(exit_code_of(body, "/dev/null", file), 0);
  EXPECT_EQ(read_text_file(file),
            "dsbuild: warning: a.exr: negative\ndsbuild: warning: b.exr: negative\n");
}

}  // namespace
}  // namespace ds
