// SPDX-License-Identifier: Apache-2.0
#include "builder/cmd/plan_text.h"
#include "builder/cmd/verbs.h"
#include "tracer/base/streams.h"
#include "tracer/device/opencl.h"

#include <nlohmann/json.hpp>

namespace ds {

int run_devices(const Arguments& arguments) {
  const std::vector<DeviceInfo> devices = list_devices();
  const std::size_t preferred = devices.empty() ? 0 : preferred_device(devices);
  nlohmann::json array = nlohmann::json::array();
  for (std::size_t i = 0; i < devices.size(); ++i) {
    const DeviceInfo& device = devices[i];
    array.push_back({{"number", i},
                     {"platform", device.platform},
                     {"name", device.name},
                     {"version", device.version},
                     {"driver", device.driver},
                     {"cpu", device.is_cpu},
                     {"strict", device.is_strict},
                     {"default", i == preferred},
                     {"compute_units", device.compute_units},
                     {"global_memory_bytes", device.global_memory_bytes}});
    if (!arguments.json)
      say(Stream::result, "{}: {} ({}, {}, driver {}), {} compute units, {:.1f} GiB{}{}\n", i,
          device.name, device.platform, device.is_cpu ? "CPU" : "GPU", device.driver,
          device.compute_units,
          static_cast<double>(device.global_memory_bytes) / (1024.0 * 1024.0 * 1024.0),
          device.is_strict ? "" : "; rounds as it likes: of no use here",
          devices.size() > 1 && i == preferred ? "; taken where none is named" : "");
  }
  if (arguments.json)
    print_json({{"devices", array}});
  else if (devices.empty())
    say(Stream::result,
        "no OpenCL device: install one, on a CPU for instance Debian's pocl-opencl-icd\n");
  return devices.empty() ? 1 : 0;
}

}  // namespace ds
