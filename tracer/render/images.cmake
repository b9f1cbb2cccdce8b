# Debian's CMake files of OpenImageIO demand its tools package; pkg-config needs the library only.
pkg_check_modules(OIIO REQUIRED IMPORTED_TARGET OpenImageIO)
ds_library(ds_images
  SOURCES develop.cc image_files.cc images.cc strict_math.cc
  LIBS ds_base
  PRIVATE_LIBS PkgConfig::OIIO)
