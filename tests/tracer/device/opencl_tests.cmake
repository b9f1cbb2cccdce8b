ds_test(opencl_test
  SOURCES arithmetic_test.cc opencl_test.cc program_cache_test.cc
  LIBS ds_opencl)
