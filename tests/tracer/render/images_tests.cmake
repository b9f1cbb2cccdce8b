find_package(ZLIB REQUIRED)
ds_test(images_test
  SOURCES camera_effects_test.cc develop_test.cc image_meaning_test.cc images_test.cc strict_math_test.cc
  LIBS ds_images ZLIB::ZLIB PkgConfig::OIIO)
