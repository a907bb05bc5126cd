# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
# Headers that nearly every file reads, parsed once: a third of the time of a cold build.
# Sources still include what they use; the preset dev builds without this and would show a lapse.
option(OVIMAP_PCH "Precompile the headers of the standard library, Eigen and GoogleTest" ON)

set(OVIMAP_COMMON_HEADERS <algorithm> <array> <cmath> <cstdint> <filesystem> <functional> <map> <memory> <optional> <set>
  <span> <string> <vector> <Eigen/Core> <Eigen/Geometry>)

if(OVIMAP_PCH)
  file(WRITE "${PROJECT_BINARY_DIR}/precompiled/empty.cpp" "")
  file(WRITE "${PROJECT_BINARY_DIR}/precompiled/main.cpp" "int main() {}\n")

  # Position-independent code for the libraries.
  add_library(ovimap_headers STATIC "${PROJECT_BINARY_DIR}/precompiled/empty.cpp")
  target_link_libraries(ovimap_headers PRIVATE ovimap_options Eigen3::Eigen)
  target_precompile_headers(ovimap_headers PRIVATE ${OVIMAP_COMMON_HEADERS})

  # And for programs, whose code is of the other kind.
  if(OVIMAP_TESTS)
    add_executable(ovimap_test_headers "${PROJECT_BINARY_DIR}/precompiled/main.cpp")
    target_link_libraries(ovimap_test_headers PRIVATE ovimap_options ovimap_glue_options Eigen3::Eigen GTest::gtest)
    target_precompile_headers(ovimap_test_headers PRIVATE ${OVIMAP_COMMON_HEADERS} <gtest/gtest.h>)
  endif()
endif()

# ovimap_precompiled(TARGET FROM): TARGET reads the headers that FROM precompiled.
function(ovimap_precompiled TARGET FROM)
  if(OVIMAP_PCH)
    target_precompile_headers(${TARGET} REUSE_FROM ${FROM})
  endif()
endfunction()
