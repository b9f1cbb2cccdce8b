// SPDX-License-Identifier: Apache-2.0
#include "tracer/device/opencl.h"

#include "tracer/base/error.h"
#include "tracer/base/log.h"
#include "tracer/device/cl_devices.h"
#include "tracer/device/cl_error.h"
#include "tracer/device/pocl_environment.h"
#include "tracer/device/program_cache.h"

#include <algorithm>
#include <sstream>
#include <type_traits>
#include <utility>

namespace ds {
namespace {

namespace fs = std::filesystem;

struct Release {
  void operator()(cl_context context) const { clReleaseContext(context); }
  void operator()(cl_command_queue queue) const { clReleaseCommandQueue(queue); }
  void operator()(cl_program program) const { clReleaseProgram(program); }
  void operator()(cl_kernel kernel) const { clReleaseKernel(kernel); }
  void operator()(cl_mem memory) const { clReleaseMemObject(memory); }
};
/// Owns one reference of an OpenCL object.
template <typename T>
using Handle = std::unique_ptr<std::remove_pointer_t<T>, Release>;

/// The build log without its warnings, which PoCL writes by the hundred around one error.
std::string build_errors(cl_program program, cl_device_id device) {
  const std::string log = info_text(
      [&](std::size_t size, void* to, std::size_t* got) {
        return clGetProgramBuildInfo(program, device, CL_PROGRAM_BUILD_LOG, size, to, got);
      },
      "clGetProgramBuildInfo");
  std::istringstream lines(log);
  std::string errors;
  for (std::string line; std::getline(lines, line);)
    if (!line.starts_with("warning:")) errors += (errors.empty() ? "" : "\n") + line;
  return errors;
}

std::vector<std::byte> binary_of(cl_program program) {
  std::size_t size = 0;
  check_cl(clGetProgramInfo(program, CL_PROGRAM_BINARY_SIZES, sizeof size, &size, nullptr),
           "clGetProgramInfo");
  std::vector<std::byte> binary(size);
  std::byte* to = binary.data();
  check_cl(clGetProgramInfo(program, CL_PROGRAM_BINARIES, sizeof to, &to, nullptr),
           "clGetProgramInfo");
  return binary;
}

/// Nothing where the driver refuses the binary, as after an update that kept its version number.
Handle<cl_program> program_from_binary(cl_context context, cl_device_id device,
                                       const std::vector<std::byte>& binary,
                                       const std::string& options) {
  const std::size_t size = binary.size();
  const auto* bytes = reinterpret_cast<const unsigned char*>(binary.data());
  cl_int status = CL_SUCCESS, code = CL_SUCCESS;
  Handle<cl_program> program(
      clCreateProgramWithBinary(context, 1, &device, &size, &bytes, &status, &code));
  if (code != CL_SUCCESS || status != CL_SUCCESS) return nullptr;
  if (clBuildProgram(program.get(), 1, &device, options.c_str(), nullptr, nullptr) != CL_SUCCESS)
    return nullptr;
  return program;
}

Handle<cl_program> program_from_source(cl_context context, cl_device_id device,
                                       const std::string& source, const std::string& options) {
  const char* text = source.data();
  const std::size_t size = source.size();
  cl_int code = CL_SUCCESS;
  Handle<cl_program> program(clCreateProgramWithSource(context, 1, &text, &size, &code));
  check_cl(code, "clCreateProgramWithSource");
  // Else PoCL says on standard error how many there are: of vectors wider than the CPU's, hundreds.
  const std::string quiet = options + " -w";
  code = clBuildProgram(program.get(), 1, &device, quiet.c_str(), nullptr, nullptr);
  if (code != CL_SUCCESS)
    fail(ErrorKind::device, "OpenCL: clBuildProgram failed with {}, options \"{}\", build log:\n{}",
         cl_error_name(code), options, build_errors(program.get(), device));
  return program;
}

}  // namespace

struct Buffer::State {
  Handle<cl_mem> memory;
  std::size_t size_bytes = 0;
};

struct Program::State {
  Handle<cl_program> program;
  bool from_cache = false;
};

struct Kernel::State {
  Handle<cl_kernel> kernel;
  std::string name;
  std::vector<Buffer> arguments;  ///< by index; empty handles where the argument is no buffer
};

struct Device::State {
  FoundDevice device;
  Handle<cl_context> context;
  Handle<cl_command_queue> queue;
};

std::size_t Buffer::size_bytes() const {
  return state_ ? state_->size_bytes : 0;
}

bool Program::from_cache() const {
  DS_ASSERT(state_);
  return state_->from_cache;
}

void Kernel::set(unsigned index, const Buffer& buffer) {
  DS_ASSERT(state_ && buffer.state_);
  cl_mem memory = buffer.state_->memory.get();
  const cl_int code = clSetKernelArg(state_->kernel.get(), index, sizeof(cl_mem), &memory);
  if (code != CL_SUCCESS)
    fail(ErrorKind::device,
         "OpenCL: clSetKernelArg failed with {}: kernel {}, argument {}, a buffer",
         cl_error_name(code), state_->name, index);
  if (state_->arguments.size() <= index) state_->arguments.resize(index + 1);
  state_->arguments[index] = buffer;
}

void Kernel::set_bytes(unsigned index, std::span<const std::byte> value) {
  DS_ASSERT(state_);
  const cl_int code = clSetKernelArg(state_->kernel.get(), index, value.size(), value.data());
  if (code != CL_SUCCESS)
    fail(ErrorKind::device,
         "OpenCL: clSetKernelArg failed with {}: kernel {}, argument {}, a value of {} bytes",
         cl_error_name(code), state_->name, index, value.size());
}

Device::Device(const std::string& selector) : state_(std::make_unique<State>()) {
  state_->device = select_device(selector);
  cl_int code = CL_SUCCESS;
  state_->context.reset(clCreateContext(nullptr, 1, &state_->device.id, nullptr, nullptr, &code));
  check_cl(code, "clCreateContext");
  state_->queue.reset(clCreateCommandQueue(state_->context.get(), state_->device.id, 0, &code));
  check_cl(code, "clCreateCommandQueue");
}
Device::Device(std::unique_ptr<State> state) : state_(std::move(state)) {}
Device::~Device() = default;
Device::Device(Device&&) noexcept = default;
Device& Device::operator=(Device&&) noexcept = default;

Device Device::beside() const {
  auto state = std::make_unique<State>();
  state->device = state_->device;
  check_cl(clRetainContext(state_->context.get()), "clRetainContext");
  state->context.reset(state_->context.get());
  cl_int code = CL_SUCCESS;
  state->queue.reset(clCreateCommandQueue(state->context.get(), state->device.id, 0, &code));
  check_cl(code, "clCreateCommandQueue");
  return Device(std::move(state));
}

const DeviceInfo& Device::info() const {
  return state_->device.info;
}

Buffer Device::make_buffer(std::size_t size_bytes) const {
  const std::uint64_t limit = info().max_allocation_bytes;
  if (size_bytes > limit)
    fail(ErrorKind::device, "{}: a buffer of {} bytes is over the device's limit of {}",
         info().name, size_bytes, limit);
  Buffer buffer;
  buffer.state_ = std::make_shared<Buffer::State>();
  buffer.state_->size_bytes = size_bytes;
  // Host memory of the driver's own is aligned as its vector code needs; CL_MEM_USE_HOST_PTR would
  // leave that to us.
  const cl_mem_flags flags =
      CL_MEM_READ_WRITE | (info().is_cpu ? CL_MEM_ALLOC_HOST_PTR : cl_mem_flags{0});
  cl_int code = CL_SUCCESS;
  const std::size_t least = 16;
  buffer.state_->memory.reset(
      clCreateBuffer(state_->context.get(), flags, std::max(size_bytes, least), nullptr, &code));
  if (code != CL_SUCCESS)
    fail(ErrorKind::device, "OpenCL: clCreateBuffer failed with {}: {} bytes on {}",
         cl_error_name(code), size_bytes, info().name);
  return buffer;
}

Buffer Device::upload(std::span<const std::byte> bytes) const {
  Buffer buffer = make_buffer(bytes.size());
  write(buffer, bytes);
  return buffer;
}

void Device::read(const Buffer& buffer, std::span<std::byte> bytes, std::size_t offset) const {
  DS_ASSERT(buffer.state_ && offset <= buffer.size_bytes() &&
            bytes.size() <= buffer.size_bytes() - offset);
  if (bytes.empty()) return;
  check_cl(clEnqueueReadBuffer(state_->queue.get(), buffer.state_->memory.get(), CL_TRUE, offset,
                               bytes.size(), bytes.data(), 0, nullptr, nullptr),
           "clEnqueueReadBuffer");
}

void Device::write(const Buffer& buffer, std::span<const std::byte> bytes) const {
  DS_ASSERT(buffer.state_ && bytes.size() <= buffer.size_bytes());
  if (bytes.empty()) return;
  check_cl(clEnqueueWriteBuffer(state_->queue.get(), buffer.state_->memory.get(), CL_TRUE, 0,
                                bytes.size(), bytes.data(), 0, nullptr, nullptr),
           "clEnqueueWriteBuffer");
}

void Device::fill_zero(const Buffer& buffer) const {
  DS_ASSERT(buffer.state_);
  if (buffer.size_bytes() == 0) return;
  const std::uint8_t zero = 0;
  check_cl(clEnqueueFillBuffer(state_->queue.get(), buffer.state_->memory.get(), &zero, sizeof zero,
                               0, buffer.size_bytes(), 0, nullptr, nullptr),
           "clEnqueueFillBuffer");
  check_cl(clFinish(state_->queue.get()), "clFinish");
}

Program Device::build(const std::string& source, const std::string& options,
                      const fs::path& cache_folder) const {
  const DeviceInfo& device = info();
  if (!device.is_strict && options.starts_with(k_strict_options))
    fail(
        ErrorKind::device,
        "{} ({}) rounds as it likes, and pictures are to be the same on every device: wanted one "
        "that rounds divisions and square roots correctly and has fused multiply-add and denormals",
        device.name, device.platform);
  Program program;
  program.state_ = std::make_shared<Program::State>();
  Program::State& state = *program.state_;
  const fs::path folder = cache_folder.empty() ? default_cache_folder() : cache_folder;
  const Hash128 key = program_key({source, options, device.platform, device.name, device.version,
                                   device.driver, pocl_environment()});
  if (const auto binary = load_program(folder, key)) {
    state.program = program_from_binary(state_->context.get(), state_->device.id, *binary, options);
    state.from_cache = state.program != nullptr;
  }
  if (state.program) return program;
  state.program = program_from_source(state_->context.get(), state_->device.id, source, options);
  try {
    store_program(folder, key, binary_of(state.program.get()));
  } catch (const Error& error) {
    warn(fmt::format("a compiled program is not kept: {}", error.what()));
  }
  return program;
}

Kernel Device::kernel(const Program& program, const char* name) const {
  DS_ASSERT(program.state_);
  Kernel kernel;
  kernel.state_ = std::make_shared<Kernel::State>();
  kernel.state_->name = name;
  cl_int code = CL_SUCCESS;
  kernel.state_->kernel.reset(clCreateKernel(program.state_->program.get(), name, &code));
  if (code != CL_SUCCESS)
    fail(ErrorKind::device, "OpenCL: clCreateKernel failed with {}: kernel {}", cl_error_name(code),
         name);
  return kernel;
}

void Device::run(const Kernel& kernel, std::size_t global_offset, std::size_t global_size,
                 std::size_t local_size) const {
  DS_ASSERT(kernel.state_ && local_size >= 1 && global_size >= local_size &&
            global_size % local_size == 0);
  const cl_int code =
      clEnqueueNDRangeKernel(state_->queue.get(), kernel.state_->kernel.get(), 1, &global_offset,
                             &global_size, &local_size, 0, nullptr, nullptr);
  if (code != CL_SUCCESS)
    fail(ErrorKind::device,
         "OpenCL: clEnqueueNDRangeKernel failed with {}: kernel {}, {} work-items in groups of {}",
         cl_error_name(code), kernel.state_->name, global_size, local_size);
  check_cl(clFinish(state_->queue.get()), "clFinish");
}

}  // namespace ds
