/* SPDX-License-Identifier: Apache-2.0
 * Stands before OpenCL (LD_PRELOAD) and makes a device that crashes or hangs: at a buffer of DS_SHIM_BYTES bytes or
 * more, which only the scenes of one model of supervisor_test.py have. DS_SHIM says how: "segv", "abort", "exit",
 * "kill" or "hang"; with DS_SHIM_ONCE=FILE only while there is no such file, which is made then. */
#define _GNU_SOURCE
#define CL_TARGET_OPENCL_VERSION 120
#include <CL/cl.h>

#include <dlfcn.h>
#include <fcntl.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static void misbehave(size_t size) {
  const char *how = getenv("DS_SHIM"), *least = getenv("DS_SHIM_BYTES"),
             *once = getenv("DS_SHIM_ONCE");
  if (how == NULL || least == NULL || size < strtoull(least, NULL, 10)) return;
  if (once != NULL && open(once, O_CREAT | O_EXCL, 0600) < 0) return;
  signal(SIGSEGV, SIG_DFL); /* PoCL's own handler returns */
  if (strcmp(how, "segv") == 0) raise(SIGSEGV);
  if (strcmp(how, "abort") == 0) abort();
  if (strcmp(how, "exit") == 0) _exit(7);
  if (strcmp(how, "kill") == 0) raise(SIGKILL);
  for (;;)
    pause();
}

cl_mem clCreateBuffer(cl_context context, cl_mem_flags flags, size_t size, void* host,
                      cl_int* code) {
  misbehave(size);
  cl_mem (*next)(cl_context, cl_mem_flags, size_t, void*, cl_int*);
  void* symbol = dlsym(RTLD_NEXT, "clCreateBuffer");
  memcpy(&next, &symbol, sizeof next);
  return next(context, flags, size, host, code);
}
