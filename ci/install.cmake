# SPDX-License-Identifier: Apache-2.0
# What `cmake --install` and the Debian package (`cpack`) put where: program, module, assets, recipes, manual page,
# completions, licence. The program finds the others by its own place.
include(GNUInstallDirs)
install(TARGETS dsbuild)
install(TARGETS dsbuild_images LIBRARY DESTINATION lib/dsbuild)
install(DIRECTORY "${CMAKE_SOURCE_DIR}/assets" "${CMAKE_SOURCE_DIR}/recipes" DESTINATION "${CMAKE_INSTALL_DATADIR}/dsbuild")
install(FILES "${CMAKE_SOURCE_DIR}/README.md" "${CMAKE_SOURCE_DIR}/CHANGELOG.md" DESTINATION "${CMAKE_INSTALL_DOCDIR}")
install(FILES "${CMAKE_SOURCE_DIR}/LICENSE" DESTINATION "${CMAKE_INSTALL_DOCDIR}" RENAME copyright)
# The notices of what is compiled in: libraries that are headers, as Debian's packages have them.
foreach(library tinygltf nlohmann-json3 cli11 tomlplusplus)
  string(REGEX REPLACE "^(tinygltf|cli11|tomlplusplus)$" "lib\\1" package "${library}")
  install(FILES "/usr/share/doc/${package}-dev/copyright" DESTINATION "${CMAKE_INSTALL_DOCDIR}/notices" RENAME "${library}")
endforeach()

# Written by the program itself, from its table of verbs.
set(texts "${CMAKE_BINARY_DIR}/texts")
set(files)
foreach(pair bash:dsbuild zsh:_dsbuild fish:dsbuild.fish man:dsbuild.1)
  string(REPLACE ":" ";" pair "${pair}")
  list(GET pair 0 kind)
  list(GET pair 1 name)
  set(file "${texts}/${kind}/${name}")
  add_custom_command(OUTPUT "${file}"
    COMMAND "${CMAKE_COMMAND}" -E make_directory "${texts}/${kind}"
    COMMAND dsbuild completions ${kind} > "${file}"
    DEPENDS dsbuild VERBATIM)
  list(APPEND files "${file}")
endforeach()
add_custom_target(shell_texts ALL DEPENDS ${files})
install(FILES "${texts}/bash/dsbuild" DESTINATION "${CMAKE_INSTALL_DATADIR}/bash-completion/completions")
install(FILES "${texts}/zsh/_dsbuild" DESTINATION "${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions")
install(FILES "${texts}/fish/dsbuild.fish" DESTINATION "${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d")
install(FILES "${texts}/man/dsbuild.1" DESTINATION "${CMAKE_INSTALL_MANDIR}/man1")

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME dsbuild)
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "make for image datasets: renders what is stale, and says what is in it")
set(CPACK_PACKAGE_CONTACT "dsbuild's authors <dsbuild@localhost>")
set(CPACK_PACKAGE_FILE_NAME "dsbuild_${PROJECT_VERSION}")
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
# Loaded by the OpenCL loader, so that no library names it.
set(CPACK_DEBIAN_PACKAGE_DEPENDS "pocl-opencl-icd | opencl-icd")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
include(CPack)
