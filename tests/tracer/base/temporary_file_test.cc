// SPDX-License-Identifier: Apache-2.0
#include "tracer/base/temporary_file.h"

#include "tracer/base/files.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <set>
#include <string>
#include <sys/wait.h>
#include <unistd.h>

namespace ds {
namespace {

namespace fs = std::filesystem;

constexpr const char* k_tell = "DS_TEST_TELLS_ITS_NAME_TO";

/// What is left of ".TOKEN.PROCESS.COUNT.tmp" where two machines have a process of one id.
std::string token_of(const std::string& name) {
  return name.substr(0, name.find('.', 1));
}

/// The name that another process takes for a file of `folder`.
std::string name_of_another_process(const fs::path& folder) {
  const fs::path told = folder / "told";
  const pid_t process = ::fork();
  if (process == 0) {
    ::setenv(k_tell, told.c_str(), 1);
    ::execl("/proc/self/exe", "self", "--gtest_filter=TemporaryNameTest.*", nullptr);
    ::_exit(127);
  }
  int status = 0;
  ::waitpid(process, &status, 0);
  return read_text_file(told);
}

TEST(TemporaryNameTest, ProcessesOfOneIdOnTwoMachinesHaveOtherNames) {
  if (const char* told = std::getenv(k_tell)) {
    write_file_atomic(told, TemporaryName("/x/target").path().filename().string());
    return;
  }
  const TemporaryFolder folder;
  std::set<std::string> tokens;
  for (int i = 0; i < 4; ++i) {
    const std::string name = name_of_another_process(folder.path());
    ASSERT_TRUE(name.starts_with('.') && name.ends_with(".tmp")) << name;
    EXPECT_GE(token_of(name).size(), 9U) << name;
    tokens.insert(token_of(name));
  }
  EXPECT_EQ(tokens.size(), 4U);
}

}  // namespace
}  // namespace ds
