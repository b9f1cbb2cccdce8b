// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

namespace ds {

/// Build options of strict programs: divide and sqrt round correctly. Contraction of a * b + c
/// cannot be switched off here (OpenCL has no such option): every program starts with `#pragma
/// OPENCL FP_CONTRACT OFF`.
inline constexpr const char* k_strict_options =
    "-cl-std=CL1.2 -cl-fp32-correctly-rounded-divide-sqrt";
/// Build options of `math = "fast"`: any rounding, contraction, no care for denormals.
inline constexpr const char* k_fast_options =
    "-cl-std=CL1.2 -cl-fast-relaxed-math -cl-denorms-are-zero";

/// One OpenCL device of this machine.
struct DeviceInfo {
  std::string platform, name;
  std::string version;  ///< CL_DEVICE_VERSION; PoCL writes the CPU it compiles for into it
  std::string driver;
  bool is_cpu = false;
  /// Single floats as strict programs want them: rounded to nearest, division and square root too,
  /// fused multiply-add, denormals, NaN (CL_DEVICE_SINGLE_FP_CONFIG).
  bool is_strict = false;
  unsigned float_lanes = 1;  ///< floats in the widest vector it has instructions for
  unsigned compute_units = 0;
  std::uint64_t global_memory_bytes = 0, max_allocation_bytes = 0;
};

/// Every device of every platform, in the loader's order. Empty where there is no platform or no
/// device.
///
/// The first call of this or of `Device` in a process sets environment variables for PoCL (see
/// `prepare_pocl_environment`): make it before other threads use getenv or setenv. Throws Error(io)
/// where no cache folder can be made.
std::vector<DeviceInfo> list_devices();

/// The device to take where none is named: the first GPU that is strict, for it is the faster one
/// and gives the same bits; else the first CPU, else the first. `devices` holds at least one.
std::size_t preferred_device(std::span<const DeviceInfo> devices);

/// Throws what `Device` throws for a selector that fits none or several, without making one.
void check_selector(const std::string& selector);

/// Device memory; a handle, copies share it. Freed with the last handle. Use it with the device
/// that made it.
class Buffer {
 public:
  Buffer() = default;
  std::size_t size_bytes() const;

 private:
  friend class Device;
  friend class Kernel;
  struct State;
  std::shared_ptr<State> state_;
};

/// A compiled program; a handle, copies share it.
class Program {
 public:
  Program() = default;
  /// Whether it was loaded from the cache folder; false: compiled from its source.
  bool from_cache() const;

 private:
  friend class Device;
  friend class Kernel;
  struct State;
  std::shared_ptr<State> state_;
};

/// One kernel function and its arguments; a handle, copies share the arguments. Arguments stay set
/// between runs; buffers that are set stay alive. Not safe from two threads at once.
class Kernel {
 public:
  Kernel() = default;

  /// Throws Error(device) where the kernel has no such argument or takes another size.
  void set(unsigned index, const Buffer& buffer);
  void set_bytes(unsigned index, std::span<const std::byte> value);
  /// A scalar or vector as OpenCL C lays it out: 4-byte scalars, or structs and arrays of them.
  template <typename T>
  requires(std::is_trivially_copyable_v<T> && !std::is_pointer_v<T> &&
           sizeof(T) % 4 == 0) void set(unsigned index, const T& value) {
    set_bytes(index, std::as_bytes(std::span(&value, 1)));
  }

 private:
  friend class Device;
  struct State;
  std::shared_ptr<State> state_;
};

/// A device with its context and one in-order queue. Use one a thread; different Devices are
/// independent, also on the same hardware. All functions throw Error(device) with the OpenCL call
/// and its error's name.
class Device {
 public:
  /// `selector`: "" = `preferred_device`; a number = index into `list_devices()`; "cpu" or "gpu" =
  /// the first of that kind; anything else = part of a device's name in any case, which must fit
  /// one device only. Throws Error(usage), with a list of what there is, where none fits, and
  /// Error(device) where there is none at all.
  explicit Device(const std::string& selector);
  ~Device();
  Device(Device&&) noexcept;
  Device& operator=(Device&&) noexcept;

  /// The same device by a queue of its own, so that one thread works with this and another with
  /// that; each one's buffers and programs are the other's too.
  Device beside() const;

  const DeviceInfo& info() const;

  /// Uninitialised memory. Size 0 gives a buffer of the least size, whose `size_bytes` is 0. On CPU
  /// devices the memory is the host's, aligned to 128 bytes at least (less crashes PoCL's vector
  /// code) and never copied between the two.
  Buffer make_buffer(std::size_t size_bytes) const;
  /// A copy of `bytes`.
  Buffer upload(std::span<const std::byte> bytes) const;
  template <typename T>
  requires std::is_trivially_copyable_v<T> Buffer upload(const std::vector<T>& values)
  const { return upload(std::as_bytes(std::span(values))); }
  /// The buffer's bytes from `offset` on, which may be fewer than it has, never more.
  void read(const Buffer& buffer, std::span<std::byte> bytes, std::size_t offset = 0) const;
  /// To the buffer's start; `bytes` may be shorter than the buffer, never longer.
  void write(const Buffer& buffer, std::span<const std::byte> bytes) const;
  void fill_zero(const Buffer& buffer) const;

  /// Compiles, or loads what an earlier process compiled from the same text with the same options
  /// for the same device and driver. `cache_folder` "" = `default_cache_folder()`. A cache that
  /// cannot be read or written costs time only. A compile error is one Error(device) that holds the
  /// build log without its warnings. The machine code of every kernel in the program is made here,
  /// none at the first run: leave out of the source what will not run.
  Program build(const std::string& source, const std::string& options,
                const std::filesystem::path& cache_folder) const;
  Kernel kernel(const Program& program, const char* name) const;

  /// Runs work-items global_offset .. global_offset + global_size - 1 and waits for them.
  /// `global_size` must be a multiple of `local_size`, both at least 1.
  void run(const Kernel& kernel, std::size_t global_offset, std::size_t global_size,
           std::size_t local_size) const;

 private:
  struct State;
  explicit Device(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace ds
