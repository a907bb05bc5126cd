# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
# Every dependency is found here and nowhere else: system packages (tools/debian-packages.txt), and ONNX Runtime where
# tools/setup.sh put it, .deps/onnxruntime, or else of the system.
find_package(PkgConfig REQUIRED)
find_package(Threads REQUIRED)
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(TBB REQUIRED)
find_package(Ceres REQUIRED)
find_package(tsl-robin-map REQUIRED)
find_package(yaml-cpp REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(SQLiteCpp REQUIRED)
find_package(ZLIB REQUIRED)
find_package(CURL 7.85 REQUIRED)
find_package(OpenSSL REQUIRED COMPONENTS Crypto SSL)
find_package(meshoptimizer REQUIRED)
if(POLICY CMP0167)
  cmake_policy(SET CMP0167 NEW)  # Boost's own description of itself
endif()
find_package(Boost 1.74 REQUIRED)  # headers alone: Beast, Asio
pkg_check_modules(TURBOJPEG REQUIRED IMPORTED_TARGET libturbojpeg)
pkg_check_modules(SPNG REQUIRED IMPORTED_TARGET spng)
pkg_check_modules(SQLITE3 REQUIRED IMPORTED_TARGET sqlite3)
pkg_check_modules(ZSTD REQUIRED IMPORTED_TARGET libzstd)
pkg_check_modules(XXHASH REQUIRED IMPORTED_TARGET libxxhash)
pkg_check_modules(SENTENCEPIECE REQUIRED IMPORTED_TARGET sentencepiece)
pkg_check_modules(UTF8PROC REQUIRED IMPORTED_TARGET libutf8proc)

find_path(ONNXRUNTIME_INCLUDE_DIR onnxruntime_cxx_api.h
  HINTS "${PROJECT_SOURCE_DIR}/.deps/onnxruntime/include"
  PATH_SUFFIXES onnxruntime onnxruntime/core/session)
find_library(ONNXRUNTIME_LIBRARY onnxruntime HINTS "${PROJECT_SOURCE_DIR}/.deps/onnxruntime/lib")
if(NOT ONNXRUNTIME_INCLUDE_DIR OR NOT ONNXRUNTIME_LIBRARY)
  message(FATAL_ERROR "ONNX Runtime was not found. Run tools/setup.sh, or set "
    "ONNXRUNTIME_INCLUDE_DIR and ONNXRUNTIME_LIBRARY.")
endif()
add_library(onnxruntime_imported UNKNOWN IMPORTED GLOBAL)
set_target_properties(onnxruntime_imported PROPERTIES
  IMPORTED_LOCATION "${ONNXRUNTIME_LIBRARY}"
  INTERFACE_INCLUDE_DIRECTORIES "${ONNXRUNTIME_INCLUDE_DIR}")

# OpenNI's headers are enough: the library is loaded when a camera is asked for.
find_path(OPENNI2_INCLUDE_DIR OniCAPI.h PATH_SUFFIXES openni2 ni2)
if(NOT OPENNI2_INCLUDE_DIR)
  message(STATUS "OpenNI 2 was not found (libopenni2-dev): `ovimap run openni:` will say so")
endif()

if(OVIMAP_SYNTH)
  find_package(embree 4 QUIET)  # of Debian 13
  if(NOT embree_FOUND)
    find_package(embree 3 REQUIRED)
  endif()
  find_package(assimp REQUIRED)
  pkg_check_modules(MINIZIP REQUIRED IMPORTED_TARGET minizip)
endif()
if(OVIMAP_APPS)
  find_package(CLI11 REQUIRED)
endif()
if(OVIMAP_TESTS)
  find_package(GTest REQUIRED)
  include(GoogleTest)
endif()
if(OVIMAP_BENCH)
  find_package(benchmark REQUIRED)
endif()
if(OVIMAP_PYTHON)
  if(NOT Python_EXECUTABLE AND EXISTS "${PROJECT_SOURCE_DIR}/.venv/bin/python")
    set(Python_EXECUTABLE "${PROJECT_SOURCE_DIR}/.venv/bin/python")
  endif()
  find_package(Python 3.10 REQUIRED COMPONENTS Interpreter Development.Module)
  execute_process(COMMAND "${Python_EXECUTABLE}" -m nanobind --cmake_dir
    OUTPUT_VARIABLE nanobind_ROOT OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  find_package(nanobind CONFIG)
  if(NOT nanobind_FOUND)
    message(FATAL_ERROR "nanobind was not found. Run tools/setup.sh, or configure with -DOVIMAP_PYTHON=OFF.")
  endif()
endif()
