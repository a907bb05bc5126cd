# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
# The Debian package (cpack -G DEB, by tools/packages.sh), and what packages bring that an installation from a checkout has
# already: models, and the furniture of the room "tiny". That is component `data`, which is installed only when it is named.
if(NOT TARGET ovimap)
  return()
endif()
install(DIRECTORY "${PROJECT_SOURCE_DIR}/.models/mobilesam" DESTINATION ${CMAKE_INSTALL_DATADIR}/ovimap/models
  COMPONENT data EXCLUDE_FROM_ALL)
install(DIRECTORY "${PROJECT_SOURCE_DIR}/.models/default-encoder" DESTINATION ${CMAKE_INSTALL_DATADIR}/ovimap/models
  COMPONENT encoder EXCLUDE_FROM_ALL)
install(CODE "execute_process(COMMAND python3 \"${PROJECT_SOURCE_DIR}/tools/packages/furniture.py\" \"$<TARGET_FILE:ovimap>\"
  \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_DATADIR}/ovimap/furniture\" COMMAND_ERROR_IS_FATAL ANY)"
  COMPONENT data EXCLUDE_FROM_ALL)
install(CODE "execute_process(COMMAND python3 \"${PROJECT_SOURCE_DIR}/tools/packages/licenses.py\" \"$<TARGET_FILE:ovimap>\"
  \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_DATADIR}/doc/ovimap\" --built-in COMMAND_ERROR_IS_FATAL ANY)"
  COMPONENT data EXCLUDE_FROM_ALL)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME ovimap)
set(CPACK_PACKAGE_VENDOR "The ovimap authors")
set(CPACK_PACKAGE_CONTACT "The ovimap authors <https://github.com/ovimap/ovimap/issues>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "RGB-D frames to a 3D map of objects that can be searched in words")
set(CPACK_PACKAGE_DESCRIPTION "The program, the web page of its viewer, and small networks for masks and words.")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_CMAKE_PROJECTS
  "${PROJECT_BINARY_DIR};ovimap;program;/;${PROJECT_BINARY_DIR};ovimap;data;/;${PROJECT_BINARY_DIR};ovimap;encoder;/")
set(CPACK_PRE_BUILD_SCRIPTS "${PROJECT_SOURCE_DIR}/cmake/DebianLayout.cmake")
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
execute_process(COMMAND sh -c ". /etc/os-release && printf %s \"\$VERSION_CODENAME\"" OUTPUT_VARIABLE release)
set(CPACK_DEBIAN_PACKAGE_RELEASE "1~${release}")  # its dependencies are those of this release
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS "${PROJECT_SOURCE_DIR}/.deps/onnxruntime/lib")
set(CPACK_DEBIAN_PACKAGE_DEPENDS ca-certificates)
set(CPACK_DEBIAN_PACKAGE_SUGGESTS sweethome3d-furniture)
set(CPACK_DEBIAN_COMPRESSION_TYPE zstd)  # networks are as good as random: xz takes minutes for nothing
include(CPack)
