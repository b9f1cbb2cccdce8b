find_package(OpenCL REQUIRED)
ds_library(ds_opencl
  SOURCES cl_devices.cc cl_error.cc opencl.cc pocl_environment.cc program_cache.cc
  LIBS ds_base
  PRIVATE_LIBS OpenCL::OpenCL)
