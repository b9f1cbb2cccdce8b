// SPDX-License-Identifier: Apache-2.0
#include "tracer/device/opencl.h"

#include "tracer/base/error.h"
#include "tracer/base/files.h"
#include "tracer/device/cl_error.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <cstdlib>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <functional>
#include <numeric>
#include <string>
#include <sys/file.h>
#include <thread>
#include <unistd.h>
#include <vector>

namespace ds {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;

constexpr const char* k_double_it = R"(
__kernel void double_it(__global const float* in, __global float* out, float scale) {
  out[get_global_id(0)] = in[get_global_id(0)] * scale;
}
)";

template <typename T>
std::vector<T> read_all(const Device& device, const Buffer& buffer) {
  std::vector<T> values(buffer.size_bytes() / sizeof(T));
  device.read(buffer, std::as_writable_bytes(std::span(values)));
  return values;
}

std::string error_text(const std::function<void()>& action, ErrorKind kind = ErrorKind::device) {
  try {
    action();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), kind);
    return error.what();
  }
  ADD_FAILURE() << "no error was thrown";
  return {};
}

/// Runs one test of this program again in a process of its own, with shell assignments before it.
/// Its exit status.
int run_child(const std::string& environment, const std::string& test) {
  const std::string self = fs::read_symlink("/proc/self/exe").string();
  const std::string command =
      environment + " '" + self + "' --gtest_filter='" + test + "' > /dev/null 2>&1";
  return std::system(command.c_str());
}

/// A folder of compiled programs: a fresh one, or that which a parent process names.
class CacheFolder {
 public:
  fs::path path() const {
    const char* given = std::getenv("DS_TEST_CACHE");
    return given != nullptr ? fs::path(given) : own_.path();
  }

 private:
  TemporaryFolder own_;
};

TEST(Opencl, FindsADevice) {
  const std::vector<DeviceInfo> devices = list_devices();
  ASSERT_FALSE(devices.empty());
  for (const DeviceInfo& device : devices) {
    EXPECT_FALSE(device.platform.empty());
    EXPECT_FALSE(device.name.empty());
    EXPECT_THAT(device.version, HasSubstr("OpenCL"));
    EXPECT_FALSE(device.driver.empty());
    EXPECT_GE(device.compute_units, 1u);
    EXPECT_GE(device.global_memory_bytes, device.max_allocation_bytes);
    EXPECT_GE(device.max_allocation_bytes, 1u << 20);
  }
}

TEST(Opencl, FindsADeviceWhereHomeCannotBeWritten) {
  const TemporaryFolder temporary;
  EXPECT_EQ(run_child("env -u XDG_CACHE_HOME -u POCL_CACHE_DIR HOME=/proc/nowhere TMPDIR='" +
                          temporary.path().string() + "'",
                      "Opencl.FindsADevice"),
            0);
  EXPECT_TRUE(fs::exists(temporary.path() / fmt::format("dsbuild-{}", ::geteuid()) / "pocl"));
}

TEST(Opencl, RemovesWhatEndedProcessesLeftAndNothingElse) {
  const TemporaryFolder temporary;
  const fs::path pocl = temporary.path() / "dsbuild" / "pocl";
  for (const char* name : {"1-0", "2-0"}) {
    fs::create_directories(pocl / name / "deep");
    std::ofstream(pocl / (std::string(name) + ".lock"));
  }
  const int held = ::open((pocl / "2-0.lock").c_str(), O_RDWR | O_CLOEXEC);
  ASSERT_EQ(::flock(held, LOCK_EX), 0);
  EXPECT_EQ(run_child("env -u POCL_CACHE_DIR XDG_CACHE_HOME='" + temporary.path().string() + "'",
                      "Opencl.FindsADevice"),
            0);
  EXPECT_FALSE(fs::exists(pocl / "1-0"));
  EXPECT_FALSE(fs::exists(pocl / "1-0.lock"));
  EXPECT_TRUE(fs::exists(pocl / "2-0" / "deep"));
  ::close(held);
}

TEST(Opencl, SelectsByNothingNumberAndPartOfTheName) {
  const std::vector<DeviceInfo> devices = list_devices();
  ASSERT_FALSE(devices.empty());
  EXPECT_EQ(Device("0").info().name, devices[0].name);
  const Device first("");
  EXPECT_EQ(first.info().name, devices[preferred_device(devices)].name);
  for (const DeviceInfo& device : devices)
    EXPECT_EQ(Device(device.is_cpu ? "cpu" : "GPU").info().is_cpu, device.is_cpu);
  if (std::all_of(devices.begin(), devices.end(), [](const DeviceInfo& d) { return d.is_cpu; })) {
    EXPECT_THAT(error_text([] { Device("gpu"); }, ErrorKind::usage),
                AllOf(HasSubstr("no GPU"), HasSubstr("0: " + devices[0].name)));
  }
  std::string upper = devices[0].name;
  for (char& c : upper)
    c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  if (devices.size() == 1) {
    EXPECT_EQ(Device(upper).info().name, devices[0].name);
  }
}

TEST(Opencl, PrefersAStrictGpuThenACpu) {
  const auto preferred = [](std::initializer_list<std::pair<bool, bool>> cpu_and_strict) {
    std::vector<DeviceInfo> devices;
    for (const auto& [cpu, strict] : cpu_and_strict) {
      devices.emplace_back();
      devices.back().is_cpu = cpu;
      devices.back().is_strict = strict;
    }
    return preferred_device(devices);
  };
  EXPECT_EQ(preferred({{true, true}, {false, false}, {false, true}, {false, true}}), 2u);
  EXPECT_EQ(preferred({{false, false}, {true, true}, {true, true}}), 1u);
  EXPECT_EQ(preferred({{false, false}, {false, false}}), 0u);
  EXPECT_EQ(preferred({{true, false}}), 0u);
  for (const DeviceInfo& device : list_devices())
    EXPECT_TRUE(device.is_strict) << device.name;
}

TEST(Opencl, SelectorErrorsListWhatThereIs) {
  const std::string name = list_devices().at(0).name;
  EXPECT_THAT(error_text([] { Device("no such device"); }, ErrorKind::usage),
              AllOf(HasSubstr("\"no such device\""), HasSubstr("0: " + name)));
  EXPECT_THAT(error_text([] { Device("99"); }, ErrorKind::usage),
              AllOf(HasSubstr("number 99"), HasSubstr(name)));
  EXPECT_THAT(error_text([] { Device("99999999999999999999999"); }, ErrorKind::usage),
              HasSubstr(name));
}

TEST(Opencl, BuffersKeepTheirBytes) {
  const Device device("");
  std::vector<std::uint32_t> values(100'003);
  std::iota(values.begin(), values.end(), 7u);
  const Buffer buffer = device.upload(values);
  EXPECT_EQ(buffer.size_bytes(), values.size() * 4);
  EXPECT_EQ(read_all<std::uint32_t>(device, buffer), values);
  device.fill_zero(buffer);
  EXPECT_EQ(read_all<std::uint32_t>(device, buffer), std::vector<std::uint32_t>(values.size()));
  device.write(buffer, std::as_bytes(std::span(values).first(2)));
  EXPECT_EQ(read_all<std::uint32_t>(device, buffer)[1], 8u);
  EXPECT_EQ(read_all<std::uint32_t>(device, buffer)[2], 0u);
  const Buffer empty = device.upload(std::vector<float>{});
  EXPECT_EQ(empty.size_bytes(), 0u);
  device.fill_zero(empty);
}

TEST(Opencl, BuffersOfCpuDevicesAreAlignedForVectors) {
  const CacheFolder cache;
  const Device device("");
  const Program program = device.build(
      "__kernel void address(__global const char* p, __global uint* out) { *out = (uint)(size_t)p "
      "& 127u; }",
      k_strict_options, cache.path());
  Kernel kernel = device.kernel(program, "address");
  for (const std::size_t size : {0u, 1u, 13u, 4096u, 1'000'001u}) {
    const Buffer probe = device.make_buffer(size), out = device.make_buffer(4);
    kernel.set(0, probe);
    kernel.set(1, out);
    device.run(kernel, 0, 1, 1);
    EXPECT_EQ(read_all<std::uint32_t>(device, out)[0], 0u) << size;
  }
}

TEST(Opencl, TooLargeABufferIsAnError) {
  const Device device("");
  EXPECT_THAT(error_text([&] { device.make_buffer(std::size_t{1} << 60); }),
              HasSubstr("1152921504606846976"));
}

TEST(Opencl, RunsAKernelWithOffsetAndScalar) {
  const CacheFolder cache;
  const Device device("");
  const Program program = device.build(k_double_it, k_strict_options, cache.path());
  const Buffer in = device.upload(std::vector<float>{1, 2, 3, 4, 5, 6, 7, 8});
  const Buffer out = device.make_buffer(in.size_bytes());
  device.fill_zero(out);
  Kernel kernel = device.kernel(program, "double_it");
  kernel.set(0, in);
  kernel.set(1, out);
  kernel.set(2, 2.5f);
  device.run(kernel, 2, 4, 2);
  EXPECT_EQ(read_all<float>(device, out), (std::vector<float>{0, 0, 7.5f, 10, 12.5f, 15, 0, 0}));
}

TEST(Opencl, WrongArgumentsAndNamesAreErrors) {
  const CacheFolder cache;
  const Device device("");
  const Program program = device.build(k_double_it, k_strict_options, cache.path());
  EXPECT_THAT(error_text([&] { device.kernel(program, "halve_it"); }),
              AllOf(HasSubstr("CL_INVALID_KERNEL_NAME"), HasSubstr("halve_it")));
  Kernel kernel = device.kernel(program, "double_it");
  EXPECT_THAT(error_text([&] { kernel.set(9, 1.0f); }), HasSubstr("CL_INVALID_ARG_INDEX"));
  EXPECT_THAT(error_text([&] { kernel.set(2, std::array<float, 4>{}); }),
              HasSubstr("CL_INVALID_ARG_SIZE"));
  EXPECT_THAT(error_text([&] { device.run(kernel, 0, 8, 8); }),
              AllOf(HasSubstr("clEnqueueNDRangeKernel"), HasSubstr("CL_INVALID_KERNEL_ARGS")));
}

TEST(Opencl, ACompileErrorShowsTheLogOnce) {
  const CacheFolder cache;
  const Device device("");
  const std::string text = error_text([&] {
    device.build("__kernel void f(__global int* p) { *p = no_such_name; }", "", cache.path());
  });
  EXPECT_THAT(text, AllOf(HasSubstr("CL_BUILD_PROGRAM_FAILURE"), HasSubstr("no_such_name")));
  EXPECT_FALSE(fs::exists(cache.path() / "programs"));
}

TEST(Opencl, TheSecondBuildComesFromTheCacheAndWorks) {
  const TemporaryFolder cache;
  for (const bool second : {false, true}) {
    const Device device("");
    const Program program = device.build(k_double_it, k_strict_options, cache.path());
    EXPECT_EQ(program.from_cache(), second);
    const Buffer in = device.upload(std::vector<float>{1.5f}), out = device.make_buffer(4);
    Kernel kernel = device.kernel(program, "double_it");
    kernel.set(0, in);
    kernel.set(1, out);
    kernel.set(2, 2.0f);
    device.run(kernel, 0, 1, 1);
    EXPECT_EQ(read_all<float>(device, out)[0], 3.0f);
  }
  const Device device("");
  EXPECT_FALSE(device.build(k_double_it, k_fast_options, cache.path()).from_cache());
  EXPECT_FALSE(
      device.build(std::string(k_double_it) + " ", k_strict_options, cache.path()).from_cache());
}

TEST(Opencl, ATornCacheFileIsBuiltAnew) {
  const TemporaryFolder cache;
  const Device device("");
  device.build(k_double_it, k_strict_options, cache.path());
  const fs::path file = fs::directory_iterator(cache.path() / "programs")->path();
  fs::resize_file(file, fs::file_size(file) - 1);
  EXPECT_FALSE(device.build(k_double_it, k_strict_options, cache.path()).from_cache());
  EXPECT_TRUE(device.build(k_double_it, k_strict_options, cache.path()).from_cache());
}

TEST(Opencl, ACacheThatCannotBeWrittenIsNoError) {
  const Device device("");
  EXPECT_FALSE(device.build(k_double_it, k_strict_options, "/proc/nowhere").from_cache());
}

TEST(Opencl, ProcessesMayStartAtOnceOnAnEmptyCache) {
  const TemporaryFolder cache;
  std::array<int, 4> status{};
  std::vector<std::thread> threads;
  for (int& one : status)
    threads.emplace_back([&] {
      one = run_child("DS_TEST_CACHE='" + cache.path().string() + "'",
                      "Opencl.RunsAKernelWithOffsetAndScalar");
    });
  for (std::thread& thread : threads)
    thread.join();
  EXPECT_EQ(status, (std::array<int, 4>{}));
  const fs::directory_iterator files(cache.path() / "programs");
  EXPECT_EQ(std::distance(begin(files), end(files)), 1);
}

TEST(Opencl, ErrorsHaveNames) {
  EXPECT_EQ(cl_error_name(-5), "CL_OUT_OF_RESOURCES");
  EXPECT_EQ(cl_error_name(-11), "CL_BUILD_PROGRAM_FAILURE");
  EXPECT_EQ(cl_error_name(-9999), "error -9999");
}

}  // namespace
}  // namespace ds
