# Debian's CMake files of OpenImageIO demand its tools package; pkg-config needs the library only.
pkg_check_modules(OIIO REQUIRED IMPORTED_TARGET GLOBAL OpenImageIO)
# Loaded when it is needed (image_codec.h). Two copies of error.cc are fine: it keeps nothing.
add_library(dsbuild_images MODULE image_codec_oiio.cc "${CMAKE_SOURCE_DIR}/tracer/base/error.cc")
target_link_libraries(dsbuild_images PRIVATE ds_options fmt::fmt PkgConfig::OIIO)
set_target_properties(dsbuild_images PROPERTIES PREFIX "" LIBRARY_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}")

ds_library(ds_images
  SOURCES camera_effects.cc develop.cc exr_header.cc image_claims.cc image_files.cc image_meaning.cc images.cc loaded_images.cc plane_file.cc png_chunks.cc strict_math.cc tiff_directory.cc
  LIBS ds_base
  PRIVATE_LIBS ds_mesh ${CMAKE_DL_LIBS})
add_dependencies(ds_images dsbuild_images)
