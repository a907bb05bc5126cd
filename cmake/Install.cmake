# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
include(CMakePackageConfigHelpers)

get_property(modules GLOBAL PROPERTY OVIMAP_MODULES)
install(TARGETS ${modules} EXPORT ovimapTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(DIRECTORY "${PROJECT_SOURCE_DIR}/src/ovimap" DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}
  FILES_MATCHING PATTERN "*.h" PATTERN "*_fixture.h" EXCLUDE PATTERN "test_support.h" EXCLUDE PATTERN "testdata" EXCLUDE)
# ONNX Runtime travels along when it is no system library, in a folder of ours: another program's may be of another version.
file(REAL_PATH "${ONNXRUNTIME_LIBRARY}" onnxruntime_file)
cmake_path(IS_PREFIX PROJECT_SOURCE_DIR "${onnxruntime_file}" NORMALIZE onnxruntime_is_ours)
if(onnxruntime_is_ours)
  install(FILES "${onnxruntime_file}" DESTINATION ${CMAKE_INSTALL_LIBDIR}/ovimap RENAME libonnxruntime.so.1 COMPONENT program)
endif()
if(TARGET ovimap)
  install(CODE "execute_process(COMMAND \"$<TARGET_FILE:ovimap>\" manual
    \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_DATADIR}\" COMMAND_ERROR_IS_FATAL ANY)" COMPONENT program)
endif()
install(EXPORT ovimapTargets NAMESPACE ovimap:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/ovimap)
configure_package_config_file("${PROJECT_SOURCE_DIR}/cmake/ovimapConfig.cmake.in"
  "${PROJECT_BINARY_DIR}/ovimapConfig.cmake" INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/ovimap)
write_basic_package_version_file("${PROJECT_BINARY_DIR}/ovimapConfigVersion.cmake"
  COMPATIBILITY SameMinorVersion)
install(FILES "${PROJECT_BINARY_DIR}/ovimapConfig.cmake" "${PROJECT_BINARY_DIR}/ovimapConfigVersion.cmake"
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/ovimap)
