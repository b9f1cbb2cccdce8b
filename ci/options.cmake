# SPDX-License-Identifier: Apache-2.0
# Flags every target of the project is compiled with, and the two functions that declare targets.

add_library(ds_options INTERFACE)
target_include_directories(ds_options INTERFACE "${CMAKE_SOURCE_DIR}" "${CMAKE_BINARY_DIR}/generated")
# Strict arithmetic on the host too: what it computes (normalised models, tone maps) is in the pixels.
target_compile_options(ds_options INTERFACE -ffp-contract=off -fno-fast-math
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion -Wold-style-cast -Wnon-virtual-dtor
  -Woverloaded-virtual -Wcast-qual -Wformat=2 -Wundef -Wimplicit-fallthrough)
# GCC 12 warns of overlapping copies in its own std::string at -O3 (GCC bug 105651), and of copies out of its bounds
# (105329) where precompiled headers make it forget that they are the system's.
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  target_compile_options(ds_options INTERFACE -Wno-restrict -Wno-array-bounds -Wno-stringop-overread -Wno-stringop-overflow)
endif()
# Files compiled together are included by one, and GCC takes their anonymous namespaces for those of headers.
if(DS_UNITY AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  target_compile_options(ds_options INTERFACE -Wno-subobject-linkage)
endif()
if(DS_WERROR)
  target_compile_options(ds_options INTERFACE -Werror)
endif()
if(DS_SANITIZE)
  target_compile_options(ds_options INTERFACE -fsanitize=${DS_SANITIZE} -fno-omit-frame-pointer)
  target_link_options(ds_options INTERFACE -fsanitize=${DS_SANITIZE})
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")  # GCC 12 warns of std::regex itself where it is instrumented
    target_compile_options(ds_options INTERFACE -Wno-maybe-uninitialized)
  endif()
endif()

# Reading the headers of the standard library and of GoogleTest is half of what a file costs to compile. With DS_PCH they
# are read once, for libraries and for tests. Presets without it show an include that is missing.
if(DS_PCH)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    target_compile_options(ds_options INTERFACE -fpch-preprocess)  # ccache needs it
  endif()
  set(standard_headers <algorithm> <array> <bit> <charconv> <chrono> <cmath> <filesystem> <functional> <limits> <map>
    <memory> <numeric> <optional> <random> <set> <span> <string> <string_view> <vector> <fmt/format.h>)
  file(CONFIGURE OUTPUT "${CMAKE_BINARY_DIR}/precompiled.cc" CONTENT "")
  add_library(ds_precompiled OBJECT "${CMAKE_BINARY_DIR}/precompiled.cc")
  target_link_libraries(ds_precompiled PRIVATE ds_options fmt::fmt)
  target_precompile_headers(ds_precompiled PRIVATE ${standard_headers})
  if(BUILD_TESTING)
    add_library(ds_test_precompiled OBJECT "${CMAKE_BINARY_DIR}/precompiled.cc")
    target_link_libraries(ds_test_precompiled PRIVATE ds_options fmt::fmt GTest::gtest GTest::gmock)
    target_precompile_headers(ds_test_precompiled PRIVATE ${standard_headers} <gmock/gmock.h> <gtest/gtest.h>)
  endif()
endif()

# ds_library(NAME SOURCES a.cc ... LIBS b ... [COLD]): one static library for one folder. One that is COLD runs so little
# that compiling it is what takes time: at -O1, a quarter less.
function(ds_library name)
  cmake_parse_arguments(A "COLD" "" "SOURCES;LIBS;PRIVATE_LIBS" ${ARGN})
  add_library(${name} STATIC ${A_SOURCES})
  target_link_libraries(${name} PUBLIC ds_options fmt::fmt ${A_LIBS} PRIVATE ${A_PRIVATE_LIBS})
  if(DS_PCH)
    target_precompile_headers(${name} REUSE_FROM ds_precompiled)
  endif()
  if(DS_UNITY)
    set_target_properties(${name} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 8)
  endif()
  if(A_COLD)
    target_compile_options(${name} PRIVATE "$<$<AND:$<CONFIG:Release>,$<COMPILE_LANGUAGE:CXX>>:-O1>")
  endif()
endfunction()

# Builds the tests that trace no pictures: what sanitizers are run with (ci/deep).
add_custom_target(tests_without_pictures)

# ds_test(NAME SOURCES a_test.cc ... LIBS b ... [LABELS slow render] [DEEP Suite.Test ...]): one GoogleTest program, one
# CTest entry a test. Those of DEEP, too long for each change, have the label deep as well.
# DS_SOURCE_DIR holds the project's root, so that tests find assets and ../shared/data.
function(ds_test name)
  cmake_parse_arguments(A "" "" "SOURCES;LIBS;LABELS;DEEP" ${ARGN})
  add_executable(${name} ${A_SOURCES})
  target_link_libraries(${name} PRIVATE ${A_LIBS} ds_options GTest::gtest GTest::gmock GTest::gtest_main)
  target_compile_definitions(${name} PRIVATE DS_SOURCE_DIR="${CMAKE_SOURCE_DIR}")
  if(DS_PCH)
    target_precompile_headers(${name} REUSE_FROM ds_test_precompiled)
  endif()
  if(NOT "render" IN_LIST A_LABELS)
    add_dependencies(tests_without_pictures ${name})
  endif()
  # Of a list gtest_discover_tests takes the first alone; ctest -L and -LE look for a part of a label.
  string(REPLACE ";" "_" labels "${A_LABELS}")
  if(A_DEEP)
    string(REPLACE ";" ":" deep "${A_DEEP}")
    gtest_discover_tests(${name} DISCOVERY_TIMEOUT 60 TEST_FILTER "${deep}" TEST_LIST ${name}_deep
      PROPERTIES LABELS "${labels}_deep")
    set(others TEST_FILTER "-${deep}")
  endif()
  gtest_discover_tests(${name} DISCOVERY_TIMEOUT 60 ${others} PROPERTIES LABELS "${labels}")
endfunction()
