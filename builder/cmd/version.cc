// SPDX-License-Identifier: Apache-2.0
#include "builder/cmd/version.h"

#include "builder/plan/dataset_manifest.h"
#include "tracer/base/error.h"
#include "tracer/device/opencl.h"

#include "commit.h"

#include <set>

namespace ds {
namespace {

/// The levels of the x86-64 psABI, by those of their features that clang 14 knows by name, too: no
/// processor has these and lacks another of the level.
std::string processor_level() {
#if defined(__x86_64__)
  const bool v2 = __builtin_cpu_supports("sse4.2") && __builtin_cpu_supports("popcnt");
  const bool v3 = v2 && __builtin_cpu_supports("avx2") && __builtin_cpu_supports("bmi") &&
                  __builtin_cpu_supports("bmi2") && __builtin_cpu_supports("fma");
  const bool v4 = v3 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
                  __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
                  __builtin_cpu_supports("avx512vl");
  return v4 ? "x86-64-v4" : v3 ? "x86-64-v3" : v2 ? "x86-64-v2" : "x86-64";
#elif defined(__aarch64__)
  return "aarch64";
#else
  return "of another kind";
#endif
}

std::string platforms_text() {
  std::set<std::string> platforms;
  try {
    for (const DeviceInfo& device : list_devices())
      platforms.insert(fmt::format("{}, driver {}", device.platform, device.driver));
  } catch (const Error& error) {
    return fmt::format("none ({})", error.what());
  }
  return platforms.empty() ? "no device" : fmt::format("{}", fmt::join(platforms, "; "));
}

}  // namespace

std::string version_text() {
  return fmt::format("dsbuild {} (commit {})\nprocessor: {}\nOpenCL: {}", program_version(),
                     k_commit, processor_level(), platforms_text());
}

}  // namespace ds
