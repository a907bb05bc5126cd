# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
# Compile options and sanitizers, carried by the interface target ovimap_options.
if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Build type" FORCE)
endif()
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY "${PROJECT_BINARY_DIR}/bin")

find_program(OVIMAP_CCACHE ccache)
if(OVIMAP_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  # Precompiled headers carry times of files, which ccache must be told to overlook.
  set(CMAKE_CXX_COMPILER_LAUNCHER "${CMAKE_COMMAND}" -E env
    CCACHE_SLOPPINESS=pch_defines,time_macros,include_file_mtime,include_file_ctime "${OVIMAP_CCACHE}")
endif()
find_program(OVIMAP_MOLD mold)

add_library(ovimap_options INTERFACE)
target_compile_options(ovimap_options INTERFACE -Wall -Wextra -Wshadow -Wnon-virtual-dtor
  $<$<BOOL:${OVIMAP_WERROR}>:-Werror>)
target_compile_options(ovimap_options INTERFACE -Wno-psabi)  # vectors go between inlined functions only (base/lanes.h)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # GCC 12 and 14 take copies of small vectors for reads past their end, 13 searches in strings.
  target_compile_options(ovimap_options INTERFACE -Wno-array-bounds -Wno-stringop-overread
    $<$<VERSION_GREATER_EQUAL:$<CXX_COMPILER_VERSION>,14>:-Wno-stringop-overflow>)  # or for writes
endif()
# Results must not depend on how the compiler fuses or reorders floating-point operations.
# Nobody here reads errno or floating-point exception flags; saying so lets loops be vectorised.
target_compile_options(ovimap_options INTERFACE -ffp-contract=off -fno-math-errno -fno-trapping-math)
if(CMAKE_SYSTEM_PROCESSOR STREQUAL "aarch64")
  target_compile_options(ovimap_options INTERFACE -U__ARM_FEATURE_FMA)  # by which Eigen would fuse there, and not elsewhere
endif()
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  target_compile_options(ovimap_options INTERFACE -fpch-preprocess)  # for ccache
  # GCC collects its garbage less often: an eighth less time, a quarter of a gigabyte more.
  target_compile_options(ovimap_options INTERFACE --param=ggc-min-heapsize=1000000)
endif()
if(OVIMAP_MOLD AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND NOT OVIMAP_SANITIZE)
  target_link_options(ovimap_options INTERFACE -fuse-ld=mold)
endif()
if(OVIMAP_SANITIZE)
  target_compile_options(ovimap_options INTERFACE
    -fsanitize=${OVIMAP_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  target_link_options(ovimap_options INTERFACE -fsanitize=${OVIMAP_SANITIZE})
endif()
if(OVIMAP_FUZZ)
  target_compile_options(ovimap_options INTERFACE -fsanitize=fuzzer-no-link)
endif()
if(OVIMAP_SANITIZE OR CMAKE_BUILD_TYPE STREQUAL "Debug")
  target_compile_definitions(ovimap_options INTERFACE OVIMAP_CHECKS=1)
endif()

# The program's commands and the tests only call what is fast: optimised lightly, they compile in two thirds of the time.
add_library(ovimap_glue_options INTERFACE)
target_compile_options(ovimap_glue_options INTERFACE $<$<CONFIG:Release>:-O1>)
