# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0

# ovimap_module(NAME SOURCES a.cpp... [PUBLIC targets...] [PRIVATE targets...] [TESTS a_test.cpp...] [ALONE b.cpp...])
# One static library ovimap_NAME (alias ovimap::NAME), and one test program for its tests.
# Sources of a module are listed without their folder. CMAKE_UNITY_BUILD compiles several of them as one, but for those
# that are ALONE as well: file-local names of the others must differ.
function(ovimap_module NAME)
  cmake_parse_arguments(ARG "" "" "SOURCES;PUBLIC;PRIVATE;TESTS;ALONE" ${ARGN})
  if(ARG_ALONE)
    set_source_files_properties(${ARG_ALONE} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
  endif()
  set(target ovimap_${NAME})
  add_library(${target} STATIC ${ARG_SOURCES})
  add_library(ovimap::${NAME} ALIAS ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${NAME})
  target_include_directories(${target} PUBLIC
    "$<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/src>" "$<INSTALL_INTERFACE:include>")
  target_compile_features(${target} PUBLIC cxx_std_20)
  target_link_libraries(${target} PUBLIC ${ARG_PUBLIC}
    PRIVATE ${ARG_PRIVATE} $<BUILD_INTERFACE:ovimap_options>)
  ovimap_precompiled(${target} ovimap_headers)
  set_property(GLOBAL APPEND PROPERTY OVIMAP_MODULES ${target})
  if(OVIMAP_TESTS AND ARG_TESTS)
    ovimap_test(${target}_test SOURCES ${ARG_TESTS} LINKS ${target})
  endif()
endfunction()

# ovimap_test(NAME SOURCES a_test.cpp... LINKS targets...)
# Tests that need the real recordings look in OVIMAP_DATA_DIR and skip with a message when it is absent.
function(ovimap_test NAME)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINKS" ${ARGN})
  add_executable(${NAME} ${ARG_SOURCES})
  target_link_libraries(${NAME} PRIVATE ${ARG_LINKS} ovimap_options ovimap_glue_options GTest::gtest
    GTest::gtest_main)
  ovimap_precompiled(${NAME} ovimap_test_headers)
  target_compile_definitions(${NAME} PRIVATE OVIMAP_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
  gtest_discover_tests(${NAME} DISCOVERY_TIMEOUT 60 PROPERTIES TIMEOUT ${OVIMAP_TEST_SECONDS})
endfunction()
