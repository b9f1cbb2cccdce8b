/* SPDX-License-Identifier: Apache-2.0
 * Finds a device for runner.c. OpenCL is loaded when the program runs and its few functions are
 * declared here: compiling needs none of its headers, starting none of its libraries. */
#pragma once

#include <dlfcn.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* Of CL/cl.h. */
enum {
  success = 0,
  cpu_type = 2,
  gpu_type = 4,
  platform_name = 0x0902,
  device_type = 0x1000,
  device_name = 0x102B,
  driver_version = 0x102D,
  device_version = 0x102F,
  build_log = 0x1183,
  binary_sizes = 0x1165,
  read_write = 1,
  alloc_host = 16
};
static const uint64_t any_type = 0xFFFFFFFF;

/* OpenCL's functions, and the place of each in the table that every object of a driver points to:
 * a driver alone, without the system's loader, exports no other way to them (cl_khr_icd). */
typedef void* handle;
typedef int (*notify)(void);
static struct {
  int (*get_platforms)(unsigned, handle*, unsigned*);
  int (*platform_info)(handle, unsigned, size_t, void*, size_t*);
  int (*get_devices)(handle, uint64_t, unsigned, handle*, unsigned*);
  int (*device_info)(handle, unsigned, size_t, void*, size_t*);
  handle (*create_context)(const intptr_t*, unsigned, const handle*, notify, void*, int*);
  handle (*create_queue)(handle, handle, uint64_t, int*);
  handle (*create_buffer)(handle, uint64_t, size_t, void*, int*);
  int (*release_buffer)(handle);
  handle (*create_program)(handle, unsigned, const char**, const size_t*, int*);
  int (*build_program)(handle, unsigned, const handle*, const char*, notify, void*);
  int (*program_info)(handle, unsigned, size_t, void*, size_t*);
  int (*build_info)(handle, handle, unsigned, size_t, void*, size_t*);
  handle (*create_kernel)(handle, const char*, int*);
  int (*release_kernel)(handle);
  int (*set_argument)(handle, unsigned, size_t, const void*);
  int (*finish)(handle);
  int (*read)(handle, handle, unsigned, size_t, size_t, void*, unsigned, const handle*, handle*);
  int (*write)(handle, handle, unsigned, size_t, size_t, const void*, unsigned, const handle*,
               handle*);
  int (*run)(handle, handle, unsigned, const size_t*, const size_t*, const size_t*, unsigned,
             const handle*, handle*);
} cl;
static const struct {
  const char* name;
  unsigned place;
} functions[] = {{"clGetPlatformIDs", 0},
                 {"clGetPlatformInfo", 1},
                 {"clGetDeviceIDs", 2},
                 {"clGetDeviceInfo", 3},
                 {"clCreateContext", 4},
                 {"clCreateCommandQueue", 9},
                 {"clCreateBuffer", 14},
                 {"clReleaseMemObject", 18},
                 {"clCreateProgramWithSource", 26},
                 {"clBuildProgram", 30},
                 {"clGetProgramInfo", 32},
                 {"clGetProgramBuildInfo", 33},
                 {"clCreateKernel", 34},
                 {"clReleaseKernel", 37},
                 {"clSetKernelArg", 38},
                 {"clFinish", 47},
                 {"clEnqueueReadBuffer", 48},
                 {"clEnqueueWriteBuffer", 49},
                 {"clEnqueueNDRangeKernel", 59}};
enum { function_count = sizeof functions / sizeof functions[0] };
_Static_assert(sizeof cl == function_count * sizeof(void*), "a place for each");

/* The device that cases run on. */
struct device {
  handle id, context, queue;
  bool is_cpu;
};

static void die(const char* format, ...) {
  va_list list;
  va_start(list, format);
  fputs("runner: ", stderr);
  vfprintf(stderr, format, list);
  fputc('\n', stderr);
  va_end(list);
  exit(2);
}

/* Loads a library's functions: the process' own for NULL, as where oclgrind stands before it. */
static bool load(const char* file) {
  void* library = file != NULL ? dlopen(file, RTLD_NOW | RTLD_LOCAL) : RTLD_DEFAULT;
  if (file != NULL && library == NULL) return false;
  void** table = (void**)&cl;
  unsigned found = 0;
  for (; found < function_count; ++found)
    if ((table[found] = dlsym(library, functions[found].name)) == NULL) break;
  if (found == function_count) return true;
  void* (*extension)(const char*) = NULL;
  *(void**)&extension = file != NULL ? dlsym(library, "clGetExtensionFunctionAddress") : NULL;
  if (extension == NULL) return false;
  int (*platforms)(unsigned, handle*, unsigned*) = NULL;
  *(void**)&platforms = extension("clIcdGetPlatformIDsKHR");
  handle platform = NULL;
  unsigned count = 0;
  if (platforms == NULL || platforms(1, &platform, &count) != success || count == 0) return false;
  void* const* dispatch = *(void* const* const*)platform;
  for (unsigned i = 0; i < function_count; ++i)
    table[i] = dispatch[functions[i].place];
  cl.get_platforms = platforms;
  return true;
}

static void device_text(handle device, unsigned what, char* text, size_t size) {
  text[0] = 0;
  cl.device_info(device, what, size - 1, text, NULL);
  text[size - 1] = 0;
}

/* The device that is wanted among a library's; a GPU, if `gpu` and none is named. */
static bool find_device(const char* wanted, bool gpu, bool list, const char* library,
                        struct device* found) {
  handle platforms[16], devices[64];
  unsigned platform_count = 0, device_count = 0, seen = 0;
  if (cl.get_platforms(16, platforms, &platform_count) != success) return false;
  for (unsigned p = 0; p < platform_count && p < 16; ++p) {
    if (cl.get_devices(platforms[p], any_type, 64, devices, &device_count) != success) continue;
    for (unsigned d = 0; d < device_count && d < 64; ++d, ++seen) {
      char name[256], platform[256] = "", digits[16];
      uint64_t type = 0;
      device_text(devices[d], device_name, name, sizeof name);
      cl.platform_info(platforms[p], platform_name, sizeof platform - 1, platform, NULL);
      cl.device_info(devices[d], device_type, sizeof type, &type, NULL);
      snprintf(digits, sizeof digits, "%u", seen);
      if (list) printf("%u: %s (%s), by %s\n", seen, name, platform, library);
      const bool fits = wanted != NULL
                            ? strcmp(wanted, digits) == 0 || strcasestr(name, wanted) != NULL
                            : !gpu || (type & gpu_type) != 0;
      if (!fits || list) continue;
      char version[256], driver[256];
      device_text(devices[d], device_version, version, sizeof version);
      device_text(devices[d], driver_version, driver, sizeof driver);
      printf("device: %s\nplatform: %s, %s\ndriver: %s, by %s\n", name, platform, version, driver,
             library);
      found->id = devices[d];
      found->is_cpu = (type & cpu_type) != 0;
      return true;
    }
  }
  return false;
}

/* By `library` alone if it is given. `list` names what there is and opens nothing. */
static struct device open_device(const char* wanted, const char* library, bool list) {
  const char* own[] = {library};
  const char* known[] = {
      NULL,           "libOpenCL.so.1", "libnvidia-opencl.so.1", "libamdocl64.so", "libpocl.so.2",
      "libpocl.so.3", "libpocl.so"};
  const char** names = library != NULL ? own : known;
  const unsigned count = library != NULL ? 1 : sizeof known / sizeof known[0];
  struct device device = {NULL, NULL, NULL, false};
  for (int gpu = wanted == NULL && !list; gpu >= 0 && device.id == NULL; --gpu)
    for (unsigned i = 0; i < count && device.id == NULL; ++i)
      if (load(names[i]))
        find_device(wanted, gpu != 0, list, names[i] != NULL ? names[i] : "what was preloaded",
                    &device);
  if (list) return device;
  if (device.id == NULL)
    die("no OpenCL device%s%s", wanted != NULL ? " is " : "", wanted != NULL ? wanted : "");
  int code = success;
  device.context = cl.create_context(NULL, 1, &device.id, NULL, NULL, &code);
  if (code == success) device.queue = cl.create_queue(device.context, device.id, 0, &code);
  if (code != success) die("the device cannot be opened: %d", code);
  return device;
}
