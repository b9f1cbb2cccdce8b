/* SPDX-License-Identifier: Apache-2.0
 * Stands before OpenCL (LD_PRELOAD) and makes a device that crashes or hangs: at a buffer of DS_SHIM_BYTES bytes or
 * more, which only the scenes of one model of supervisor_test.py have. DS_SHIM says how: "segv", "abort", "exit",
 * "kill" or "hang"; with DS_SHIM_ONCE=FILE only while there is no such file, which is made then. DS_SHIM_FILE=END: instead
 * where a finished file takes a name that ends so; DS_SHIM_EXIT: instead as the process that builds exits. */
#define _GNU_SOURCE
#define CL_TARGET_OPENCL_VERSION 120
#include <CL/cl.h>

#include <dlfcn.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <unistd.h>

static void misbehave(void) {
  const char *how = getenv("DS_SHIM"), *once = getenv("DS_SHIM_ONCE");
  if (how == NULL) return;
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
  const char* least = getenv("DS_SHIM_BYTES");
  if (least != NULL && size >= strtoull(least, NULL, 10)) misbehave();
  cl_mem (*next)(cl_context, cl_mem_flags, size_t, void*, cl_int*);
  void* symbol = dlsym(RTLD_NEXT, "clCreateBuffer");
  memcpy(&next, &symbol, sizeof next);
  return next(context, flags, size, host, code);
}

int rename(const char* from, const char* to) {
  const char* end = getenv("DS_SHIM_FILE");
  const size_t size = end == NULL ? 0 : strlen(end), all = strlen(to);
  if (size > 0 && size <= all && strcmp(to + all - size, end) == 0) misbehave();
  int (*next)(const char*, const char*);
  void* symbol = dlsym(RTLD_NEXT, "rename");
  memcpy(&next, &symbol, sizeof next);
  return next(from, to);
}

/* Only what builds is to die with its parent. */
__attribute__((destructor)) static void leave(void) {
  int signal_of_parent = 0;
  if (getenv("DS_SHIM_EXIT") == NULL || prctl(PR_GET_PDEATHSIG, &signal_of_parent) != 0) return;
  if (signal_of_parent == SIGKILL) misbehave();
}
