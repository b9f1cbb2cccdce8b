// SPDX-License-Identifier: Apache-2.0
#include "tracer/device/program_cache.h"

#include "tracer/base/error.h"
#include "tracer/base/files.h"
#include "tracer/device/pocl_environment.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <set>
#include <string>
#include <sys/stat.h>
#include <unistd.h>
#include <vector>

namespace ds {
namespace {

namespace fs = std::filesystem;

const ProgramIdentity k_identity{"source",  "options", "platform",   "device",
                                 "version", "driver",  "environment"};

/// Sets a variable, or unsets it for nullptr, until the end of a test.
class Variable {
 public:
  Variable(const char* name, const char* value) : name_(name) {
    if (const char* old = std::getenv(name)) old_ = old;
    set(value);
  }
  ~Variable() { set(old_ ? old_->c_str() : nullptr); }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;

 private:
  void set(const char* value) const {
    if (value != nullptr)
      ::setenv(name_, value, 1);
    else
      ::unsetenv(name_);
  }
  const char* name_;
  std::optional<std::string> old_;
};

fs::path only_file(const fs::path& folder) {
  return fs::directory_iterator(folder / "programs")->path();
}

TEST(ProgramCache, EveryFieldIsInTheKey) {
  std::set<std::string> keys{program_key(k_identity).hex()};
  const auto vary = [&](std::string ProgramIdentity::*field) {
    ProgramIdentity other = k_identity;
    other.*field += "x";
    keys.insert(program_key(other).hex());
  };
  vary(&ProgramIdentity::source);
  vary(&ProgramIdentity::options);
  vary(&ProgramIdentity::platform);
  vary(&ProgramIdentity::device);
  vary(&ProgramIdentity::device_version);
  vary(&ProgramIdentity::driver);
  vary(&ProgramIdentity::environment);
  EXPECT_EQ(keys.size(), 8u);
}

TEST(ProgramCache, FieldsDoNotFlowTogether) {
  EXPECT_NE(program_key({"ab", "c", "", "", "", "", ""}),
            program_key({"a", "bc", "", "", "", "", ""}));
}

TEST(ProgramCache, GivesBackWhatWasStored) {
  const TemporaryFolder folder;
  const Hash128 key = program_key(k_identity);
  EXPECT_EQ(load_program(folder.path(), key), std::nullopt);
  std::vector<std::byte> binary(1000);
  for (std::size_t i = 0; i < binary.size(); ++i)
    binary[i] = static_cast<std::byte>(i * 7);
  store_program(folder.path(), key, binary);
  EXPECT_EQ(load_program(folder.path(), key), binary);
}

TEST(ProgramCache, ATornFileIsNeverTaken) {
  const TemporaryFolder folder;
  const Hash128 key = program_key(k_identity);
  store_program(folder.path(), key, std::vector<std::byte>(100, std::byte{5}));
  const std::string whole = read_text_file(only_file(folder.path()));
  for (std::size_t size = 0; size < whole.size(); ++size) {
    write_file_atomic(only_file(folder.path()), whole.substr(0, size));
    EXPECT_EQ(load_program(folder.path(), key), std::nullopt) << size;
  }
  write_file_atomic(only_file(folder.path()), whole + "x");
  EXPECT_EQ(load_program(folder.path(), key), std::nullopt);
  for (std::size_t place = 0; place < whole.size(); ++place) {
    std::string changed = whole;
    changed[place] = static_cast<char>(changed[place] ^ 1);
    write_file_atomic(only_file(folder.path()), changed);
    EXPECT_EQ(load_program(folder.path(), key), std::nullopt) << place;
  }
}

TEST(ProgramCache, AFileUnderAnotherNameIsNotTaken) {
  const TemporaryFolder folder;
  const Hash128 key = program_key(k_identity), other{1, 2};
  store_program(folder.path(), key, std::vector<std::byte>(100));
  fs::rename(only_file(folder.path()), folder.path() / "programs" / (other.hex() + ".bin"));
  EXPECT_EQ(load_program(folder.path(), other), std::nullopt);
}

TEST(ProgramCache, AnUnwritableFolderIsAnError) {
  EXPECT_THROW(store_program("/proc/nowhere", Hash128{}, {}), Error);
  EXPECT_EQ(load_program("/proc/nowhere", Hash128{}), std::nullopt);
}

TEST(DefaultCacheFolder, FollowsTheXdgSpecification) {
  const TemporaryFolder folder;
  const std::string xdg = (folder.path() / "xdg").string(),
                    home = (folder.path() / "home").string();
  const Variable home_variable("HOME", home.c_str());
  {
    const Variable variable("XDG_CACHE_HOME", xdg.c_str());
    EXPECT_EQ(default_cache_folder(), fs::path(xdg) / "dsbuild");
    EXPECT_TRUE(fs::is_directory(fs::path(xdg) / "dsbuild"));
  }
  for (const char* unset : {static_cast<const char*>(nullptr), "", "relative"}) {
    const Variable variable("XDG_CACHE_HOME", unset);
    EXPECT_EQ(default_cache_folder(), fs::path(home) / ".cache" / "dsbuild");
  }
}

TEST(DefaultCacheFolder, FallsBackToAPrivateTemporaryFolder) {
  const TemporaryFolder folder;
  const Variable xdg("XDG_CACHE_HOME", nullptr), home("HOME", "/proc/nowhere");
  const Variable temporary("TMPDIR", folder.path().c_str());
  const fs::path found = default_cache_folder();
  EXPECT_EQ(found.parent_path(), folder.path());
  EXPECT_EQ(fs::status(found).permissions(), fs::perms::owner_all);
  EXPECT_EQ(default_cache_folder(), found);
  // What others can write there would be run as code.
  fs::permissions(found, fs::perms::all);
  EXPECT_THROW(default_cache_folder(), Error);
  fs::remove_all(found);
  fs::create_directory_symlink("/tmp", found);
  EXPECT_THROW(default_cache_folder(), Error);
}

TEST(PoclEnvironment, HoldsWhatChangesCodeAndNothingElse) {
  const Variable library("POCL_KERNELLIB_NAME", "sse2"), cache("POCL_CACHE_DIR", "/somewhere"),
      debug("POCL_DEBUG", "all");
  const std::string text = pocl_environment();
  EXPECT_THAT(text, testing::HasSubstr("POCL_KERNELLIB_NAME=sse2\n"));
  EXPECT_THAT(text, testing::Not(testing::HasSubstr("somewhere")));
  EXPECT_THAT(text, testing::Not(testing::HasSubstr("POCL_DEBUG")));
}

}  // namespace
}  // namespace ds
