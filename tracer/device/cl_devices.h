// SPDX-License-Identifier: Apache-2.0
// Inside the OpenCL wrapper only: what needs OpenCL's own types. Everybody else includes opencl.h.
#pragma once

#define CL_TARGET_OPENCL_VERSION 120
#include "tracer/base/error.h"
#include "tracer/device/cl_error.h"
#include "tracer/device/opencl.h"

#include <CL/cl.h>

#include <string>
#include <vector>

namespace ds {

/// Throws Error(device) with the call and the error's name.
inline void check_cl(cl_int code, const char* call) {
  if (code != CL_SUCCESS)
    fail(ErrorKind::device, "OpenCL: {} failed with {}", call, cl_error_name(code));
}

/// Text of an information query; `get` is clGetDeviceInfo and the like with its object and name
/// bound.
template <typename Get>
std::string info_text(Get get, const char* call) {
  std::size_t size = 0;
  check_cl(get(0, nullptr, &size), call);
  std::string text(size, '\0');
  check_cl(get(size, text.data(), nullptr), call);
  while (!text.empty() && (text.back() == '\0' || text.back() == '\n' || text.back() == ' '))
    text.pop_back();
  return text;
}

/// A device and what is known of it.
struct FoundDevice {
  cl_device_id id = nullptr;
  DeviceInfo info;
};

/// See `Device::Device`.
FoundDevice select_device(const std::string& selector);

}  // namespace ds
