// SPDX-License-Identifier: Apache-2.0
#include "tracer/device/cl_devices.h"

#include "tracer/base/nearest.h"
#include "tracer/device/pocl_environment.h"

#include <CL/cl_ext.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstdint>
#include <optional>
#include <utility>

namespace ds {
namespace {

std::string device_text(cl_device_id device, cl_device_info name) {
  return info_text([&](std::size_t size, void* to,
                       std::size_t* got) { return clGetDeviceInfo(device, name, size, to, got); },
                   "clGetDeviceInfo");
}

template <typename T>
T device_value(cl_device_id device, cl_device_info name) {
  T value{};
  check_cl(clGetDeviceInfo(device, name, sizeof value, &value, nullptr), "clGetDeviceInfo");
  return value;
}

DeviceInfo describe(cl_platform_id platform, cl_device_id device) {
  DeviceInfo info;
  info.platform = info_text(
      [&](std::size_t size, void* to, std::size_t* got) {
        return clGetPlatformInfo(platform, CL_PLATFORM_NAME, size, to, got);
      },
      "clGetPlatformInfo");
  info.name = device_text(device, CL_DEVICE_NAME);
  info.version = device_text(device, CL_DEVICE_VERSION);
  info.driver = device_text(device, CL_DRIVER_VERSION);
  info.is_cpu = (device_value<cl_device_type>(device, CL_DEVICE_TYPE) & CL_DEVICE_TYPE_CPU) != 0;
  constexpr cl_device_fp_config strict = CL_FP_DENORM | CL_FP_INF_NAN | CL_FP_ROUND_TO_NEAREST |
                                         CL_FP_FMA | CL_FP_CORRECTLY_ROUNDED_DIVIDE_SQRT;
  const auto floats = device_value<cl_device_fp_config>(device, CL_DEVICE_SINGLE_FP_CONFIG);
  // Oclgrind computes as its host does, fma and division too, and does not say so (ci/bits compares).
  info.is_strict = (floats & strict) == strict || info.platform == "Oclgrind";
  info.float_lanes = device_value<cl_uint>(device, CL_DEVICE_NATIVE_VECTOR_WIDTH_FLOAT);
  info.compute_units = device_value<cl_uint>(device, CL_DEVICE_MAX_COMPUTE_UNITS);
  info.global_memory_bytes = device_value<cl_ulong>(device, CL_DEVICE_GLOBAL_MEM_SIZE);
  info.max_allocation_bytes = device_value<cl_ulong>(device, CL_DEVICE_MAX_MEM_ALLOC_SIZE);
  return info;
}

std::vector<cl_platform_id> platforms() {
  cl_uint count = 0;
  const cl_int code = clGetPlatformIDs(0, nullptr, &count);
  if (code == CL_PLATFORM_NOT_FOUND_KHR || count == 0) return {};  // the loader found no driver
  check_cl(code, "clGetPlatformIDs");
  std::vector<cl_platform_id> ids(count);
  check_cl(clGetPlatformIDs(count, ids.data(), nullptr), "clGetPlatformIDs");
  return ids;
}

std::vector<FoundDevice> find_devices() {
  prepare_pocl_environment();
  std::vector<FoundDevice> found;
  for (cl_platform_id platform : platforms()) {
    cl_uint count = 0;
    const cl_int code = clGetDeviceIDs(platform, CL_DEVICE_TYPE_ALL, 0, nullptr, &count);
    if (code == CL_DEVICE_NOT_FOUND || (code == CL_SUCCESS && count == 0)) continue;
    check_cl(code, "clGetDeviceIDs");
    std::vector<cl_device_id> ids(count);
    check_cl(clGetDeviceIDs(platform, CL_DEVICE_TYPE_ALL, count, ids.data(), nullptr),
             "clGetDeviceIDs");
    for (cl_device_id id : ids)
      found.push_back({id, describe(platform, id)});
  }
  return found;
}

std::string lower(std::string text) {
  for (char& c : text)
    c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

std::string listing(const std::vector<FoundDevice>& devices) {
  std::string text;
  for (std::size_t i = 0; i < devices.size(); ++i)
    text += fmt::format("{}{}: {} ({})", i == 0 ? "" : ", ", i, devices[i].info.name,
                        devices[i].info.platform);
  return text;
}

std::optional<std::size_t> whole_number(const std::string& text) {
  std::size_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool all_digits =
      std::all_of(text.begin(), text.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
  if (!all_digits || error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

/// What a wrong word was meant to be, of the words of the devices' names: "nvidia", "h100".
std::string meant_word(const std::string& selector, const std::vector<FoundDevice>& devices) {
  std::vector<std::string> words;
  for (const FoundDevice& device : devices)
    for (std::string word; const char c : lower(device.info.name) + " ") {
      if (std::isalnum(static_cast<unsigned char>(c)) != 0)
        word += c;
      else if (!word.empty())
        words.push_back(std::exchange(word, ""));
    }
  const std::vector<std::string_view> known(words.begin(), words.end());
  return did_you_mean(selector, known);
}

std::vector<DeviceInfo> infos(const std::vector<FoundDevice>& devices) {
  std::vector<DeviceInfo> result;
  for (const FoundDevice& device : devices)
    result.push_back(device.info);
  return result;
}

}  // namespace

std::size_t preferred_device(std::span<const DeviceInfo> devices) {
  const auto gpu = std::find_if(devices.begin(), devices.end(),
                                [](const DeviceInfo& d) { return !d.is_cpu && d.is_strict; });
  if (gpu != devices.end()) return static_cast<std::size_t>(gpu - devices.begin());
  const auto cpu =
      std::find_if(devices.begin(), devices.end(), [](const DeviceInfo& d) { return d.is_cpu; });
  return cpu != devices.end() ? static_cast<std::size_t>(cpu - devices.begin()) : 0;
}

FoundDevice select_device(const std::string& selector) {
  const std::vector<FoundDevice> devices = find_devices();
  if (devices.empty())
    fail(
        ErrorKind::device,
        "no OpenCL device found: install a driver, such as pocl-opencl-icd for this machine's CPU");
  if (selector.empty()) return devices[preferred_device(infos(devices))];
  if (const std::string word = lower(selector); word == "cpu" || word == "gpu") {
    const auto found = std::find_if(devices.begin(), devices.end(), [&](const FoundDevice& device) {
      return device.info.is_cpu == (word == "cpu");
    });
    if (found != devices.end()) return *found;
    fail(ErrorKind::usage, "--device: there is no {} among the OpenCL devices; there {} {}",
         word == "cpu" ? "CPU" : "GPU", devices.size() == 1 ? "is" : "are", listing(devices));
  }
  if (const std::optional<std::size_t> index = whole_number(selector)) {
    if (*index < devices.size()) return devices[*index];
    fail(ErrorKind::usage, "--device: no OpenCL device has the number {}; there {} {}", selector,
         devices.size() == 1 ? "is" : "are", listing(devices));
  }
  std::vector<FoundDevice> fitting;
  for (const FoundDevice& device : devices)
    if (lower(device.info.name).find(lower(selector)) != std::string::npos)
      fitting.push_back(device);
  if (fitting.size() == 1) return fitting.front();
  if (fitting.empty())
    fail(ErrorKind::usage, "--device: no OpenCL device has \"{}\" in its name{}; there {} {}",
         selector, meant_word(selector, devices), devices.size() == 1 ? "is" : "are",
         listing(devices));
  fail(ErrorKind::usage,
       "--device: {} OpenCL devices have \"{}\" in their name, wanted one (its number tells it "
       "from the others); there are {}",
       fitting.size(), selector, listing(devices));
}

void check_selector(const std::string& selector) {
  select_device(selector);
}

std::vector<DeviceInfo> list_devices() {
  return infos(find_devices());
}

}  // namespace ds
