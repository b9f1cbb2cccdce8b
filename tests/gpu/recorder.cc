// SPDX-License-Identifier: Apache-2.0
#include "tests/gpu/recorder.h"

#define CL_TARGET_OPENCL_VERSION 120
#include "tracer/base/error.h"
#include "tracer/base/files.h"
#include "tracer/base/hash.h"

#include <CL/cl.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <dlfcn.h>
#include <map>
#include <optional>
#include <span>
#include <vector>

namespace ds::gpu {
namespace {

static_assert(std::endian::native == std::endian::little);

struct KernelState {
  cl_program program = nullptr;
  std::string name;
  std::vector<std::string> arguments;  ///< as cases.txt has them
  std::vector<cl_mem> buffers;         ///< by argument; null for a value
};

struct BufferState {
  std::uint64_t case_number = 0;
  std::size_t number = 0, size_bytes = 0;
  std::string role;  ///< kernel and argument of the last run with it
};

struct Run {
  std::string head, arguments;  ///< before and behind FIRST, ITEMS and GROUP
  std::size_t first = 0, items = 0, group = 0;
};

/// One for the process: OpenCL's functions have no place for more.
struct Recording {
  std::vector<std::string> texts;
  std::string lines = "dsbuild-gpu 1\n";
  std::vector<std::byte> data;
  std::map<Hash128, std::size_t> data_at;
  std::map<std::string, std::size_t> programs;  ///< number by its line's text and options
  std::map<cl_program, std::size_t> text_of, program_of;
  std::map<cl_kernel, KernelState> kernels;
  std::map<cl_mem, BufferState> buffers;
  std::uint64_t case_number = 0;
  std::size_t case_buffers = 0;
  bool in_case = false;
  std::optional<Run> run;  ///< not yet a line: the next one may go on from where it ends

  void end_run();
  void line(const std::string& text);
  std::size_t place(std::span<const std::byte> bytes);
};

Recording& recording() {
  static Recording all;
  return all;
}

void Recording::end_run() {
  if (run)
    lines += fmt::format("{} {} {} {}{}\n", run->head, run->first, run->items, run->group,
                         run->arguments);
  run.reset();
}

void Recording::line(const std::string& text) {
  end_run();
  lines += text + "\n";
}

/// Where data.bin has these bytes.
std::size_t Recording::place(std::span<const std::byte> bytes) {
  const auto [entry, added] = data_at.try_emplace(hash_bytes(bytes), data.size());
  if (added) {
    data.insert(data.end(), bytes.begin(), bytes.end());
    data.resize((data.size() + 15) / 16 * 16);
  }
  return entry->second;
}

std::uint64_t hash_words(std::span<const std::byte> bytes) {
  DS_ASSERT(bytes.size() % 4 == 0);
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (std::size_t i = 0; i < bytes.size(); i += 4) {
    std::uint32_t word = 0;
    std::memcpy(&word, bytes.data() + i, 4);
    hash = (hash ^ word) * 0x100000001b3u;
  }
  return hash;
}

std::span<const std::byte> span_of(const void* bytes, std::size_t size) {
  return {static_cast<const std::byte*>(bytes), size};
}

/// The buffer, if this case made it.
BufferState* own_buffer(cl_mem memory) {
  const auto found = recording().buffers.find(memory);
  return found != recording().buffers.end() && found->second.case_number == recording().case_number
             ? &found->second
             : nullptr;
}

void record_write(BufferState& buffer, const void* bytes, std::size_t size) {
  const auto content = span_of(bytes, size);
  Recording& all = recording();
  if (std::all_of(content.begin(), content.end(), [](std::byte b) { return b == std::byte{}; }))
    all.line(fmt::format("zero {} {}", buffer.number, size));
  else
    all.line(fmt::format("write {} {} {}", buffer.number, size, all.place(content)));
}

void record_read(const BufferState& buffer, const void* bytes, std::size_t size) {
  const auto content = span_of(bytes, size);
  const std::string at =
      size <= k_whole_bytes ? std::to_string(recording().place(content)) : std::string("-");
  recording().line(fmt::format("read {} {} {:016x} {} {}", buffer.number, size, hash_words(content),
                               at, buffer.role));
}

/// False where a buffer is an argument that the case did not make.
bool record_run(KernelState& kernel, std::size_t first, std::size_t items, std::size_t group) {
  Recording& all = recording();
  std::string arguments;
  for (std::size_t i = 0; i < kernel.arguments.size(); ++i) {
    if (kernel.buffers[i] != nullptr) {
      BufferState* buffer = own_buffer(kernel.buffers[i]);
      if (buffer == nullptr) return false;
      buffer->role = fmt::format("{}:{}", kernel.name, i);
      kernel.arguments[i] = fmt::format("b{}", buffer->number);
    }
    arguments += " " + kernel.arguments[i];
  }
  const std::string head = fmt::format("run {} {}", all.program_of.at(kernel.program), kernel.name);
  if (all.run && all.run->head == head && all.run->arguments == arguments &&
      all.run->group == group && all.run->first + all.run->items == first) {
    all.run->items += items;
    return true;
  }
  all.end_run();
  all.run = Run{head, arguments, first, items, group};
  return true;
}

/// The function of the library that this program's stands before.
template <typename Function>
Function* real(Function*, const char* name) {
  void* const found = ::dlsym(RTLD_NEXT, name);
  DS_ASSERT(found != nullptr);
  return reinterpret_cast<Function*>(found);
}

}  // namespace

void begin_case(std::string_view name) {
  Recording& all = recording();
  DS_ASSERT(!all.in_case);
  ++all.case_number;
  all.case_buffers = 0;
  all.in_case = true;
  all.line(fmt::format("case {}", name));
}

void time_case(std::uint64_t count, std::string_view unit, std::string_view kernel) {
  recording().line(fmt::format("time {} {} {}", count, unit, kernel));
}

void end_case() {
  DS_ASSERT(recording().in_case);
  recording().line("end");
  recording().in_case = false;
}

void write_pack(const std::filesystem::path& folder) {
  const Recording& all = recording();
  make_folders(folder / "texts");
  for (std::size_t i = 0; i < all.texts.size(); ++i)
    write_file_atomic(folder / "texts" / fmt::format("{}.cl", i), all.texts[i]);
  write_file_atomic(folder / "data.bin", all.data);
  write_file_atomic(folder / "cases.txt", all.lines);
}

}  // namespace ds::gpu

// OpenCL's functions that make, fill and read what cases need. Errors are the real ones' own.
extern "C" {

using ds::gpu::real;
using ds::gpu::recording;

cl_program clCreateProgramWithSource(cl_context context, cl_uint count, const char** strings,
                                     const size_t* lengths, cl_int* code) {
  const cl_program program = real(&clCreateProgramWithSource, "clCreateProgramWithSource")(
      context, count, strings, lengths, code);
  DS_ASSERT(count == 1 && lengths != nullptr);
  std::vector<std::string>& texts = recording().texts;
  const std::string text(strings[0], lengths[0]);
  const auto found = std::find(texts.begin(), texts.end(), text);
  recording().text_of[program] = static_cast<std::size_t>(found - texts.begin());
  if (found == texts.end()) texts.push_back(text);
  return program;
}

/// A program that was compiled before comes without its text: let it be compiled again.
cl_program clCreateProgramWithBinary(cl_context, cl_uint, const cl_device_id*, const size_t*,
                                     const unsigned char**, cl_int*, cl_int* code) {
  *code = CL_INVALID_BINARY;
  return nullptr;
}

cl_int clBuildProgram(cl_program program, cl_uint count, const cl_device_id* devices,
                      const char* options, void(CL_CALLBACK* notify)(cl_program, void*),
                      void* user) {
  ds::gpu::Recording& all = recording();
  const std::string line = fmt::format("{} {}", all.text_of.at(program), options);
  const auto [entry, added] = all.programs.try_emplace(line, all.programs.size());
  if (added) all.line(fmt::format("program {} {}", entry->second, line));
  all.program_of[program] = entry->second;
  return real(&clBuildProgram, "clBuildProgram")(program, count, devices, options, notify, user);
}

cl_kernel clCreateKernel(cl_program program, const char* name, cl_int* code) {
  const cl_kernel kernel = real(&clCreateKernel, "clCreateKernel")(program, name, code);
  recording().kernels[kernel] = {program, name, {}, {}};
  return kernel;
}

cl_int clSetKernelArg(cl_kernel kernel, cl_uint index, size_t size, const void* value) {
  ds::gpu::KernelState& state = recording().kernels.at(kernel);
  if (state.arguments.size() <= index) {
    state.arguments.resize(index + 1);
    state.buffers.resize(index + 1);
  }
  cl_mem memory = nullptr;
  if (size == sizeof memory) std::memcpy(&memory, value, size);
  state.buffers[index] = recording().buffers.contains(memory) ? memory : nullptr;
  if (state.buffers[index] == nullptr)
    state.arguments[index] =
        fmt::format("v{}@{}", size, recording().place(ds::gpu::span_of(value, size)));
  return real(&clSetKernelArg, "clSetKernelArg")(kernel, index, size, value);
}

cl_mem clCreateBuffer(cl_context context, cl_mem_flags flags, size_t size, void* host,
                      cl_int* code) {
  const cl_mem memory = real(&clCreateBuffer, "clCreateBuffer")(context, flags, size, host, code);
  ds::gpu::Recording& all = recording();
  if (memory == nullptr) return memory;
  all.buffers[memory] = {all.in_case ? all.case_number : 0, all.case_buffers, size, {}};
  if (all.in_case) all.line(fmt::format("buffer {} {}", all.case_buffers++, size));
  return memory;
}

cl_int clEnqueueWriteBuffer(cl_command_queue queue, cl_mem memory, cl_bool blocking, size_t offset,
                            size_t size, const void* bytes, cl_uint waits, const cl_event* wait,
                            cl_event* event) {
  if (recording().in_case) {
    ds::gpu::BufferState* buffer = ds::gpu::own_buffer(memory);
    if (buffer == nullptr || offset != 0) return CL_INVALID_MEM_OBJECT;
    ds::gpu::record_write(*buffer, bytes, size);
  }
  return real(&clEnqueueWriteBuffer, "clEnqueueWriteBuffer")(queue, memory, blocking, offset, size,
                                                             bytes, waits, wait, event);
}

cl_int clEnqueueNDRangeKernel(cl_command_queue queue, cl_kernel kernel, cl_uint dimensions,
                              const size_t* offset, const size_t* items, const size_t* group,
                              cl_uint waits, const cl_event* wait, cl_event* event) {
  DS_ASSERT(dimensions == 1 && offset != nullptr && group != nullptr);
  if (recording().in_case &&
      !ds::gpu::record_run(recording().kernels.at(kernel), *offset, *items, *group))
    return CL_INVALID_KERNEL_ARGS;
  return real(&clEnqueueNDRangeKernel, "clEnqueueNDRangeKernel")(queue, kernel, dimensions, offset,
                                                                 items, group, waits, wait, event);
}

cl_int clEnqueueReadBuffer(cl_command_queue queue, cl_mem memory, cl_bool blocking, size_t offset,
                           size_t size, void* bytes, cl_uint waits, const cl_event* wait,
                           cl_event* event) {
  const cl_int code = real(&clEnqueueReadBuffer, "clEnqueueReadBuffer")(
      queue, memory, blocking, offset, size, bytes, waits, wait, event);
  if (!recording().in_case || code != CL_SUCCESS) return code;
  const ds::gpu::BufferState* buffer = ds::gpu::own_buffer(memory);
  if (buffer == nullptr || offset != 0 || blocking != CL_TRUE) return CL_INVALID_MEM_OBJECT;
  ds::gpu::record_read(*buffer, bytes, size);
  return code;
}

/// Cases have no line for it, and the tracer fills only what counts rays.
cl_int clEnqueueFillBuffer(cl_command_queue, cl_mem, const void*, size_t, size_t, size_t, cl_uint,
                           const cl_event*, cl_event*) {
  return CL_INVALID_OPERATION;
}

}  // extern "C"
