find_package(OpenCL REQUIRED)
ds_library(ds_opencl
  SOURCES cl_devices.cc cl_error.cc opencl.cc pocl_environment.cc program_cache.cc
  LIBS ds_base
  PRIVATE_LIBS OpenCL::OpenCL)
# It asks OpenCL's headers for the names of newer versions than the rest of the wrapper uses.
set_source_files_properties(cl_error.cc PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
