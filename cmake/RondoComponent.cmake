# One component = one folder under src/ = one static library.
#
#   rondo_component(koord/check DEPS base diag koord/syntax LIBS fmt::fmt)
#
# Every *.cc of the folder is compiled in; every *_test.cc becomes part of the component's test binary. DEPS (and
# TEST_DEPS, for the tests) is the layer graph: it is written to layers.txt, and the test `layers` fails on an include
# that it does not allow, and on an edge that no include needs.

set_property(GLOBAL PROPERTY RONDO_GRAPH "")

function(rondo_target_name component out)
  string(REPLACE "/" "_" name "rondo_${component}")
  set(${out} ${name} PARENT_SCOPE)
endfunction()

# Precompiled headers: built once by the first component, shared by the rest.
function(rondo_precompile target)
  if(NOT RONDO_PCH)
    return()
  endif()
  if(TARGET rondo_pch)
    target_precompile_headers(${target} REUSE_FROM rondo_pch)
    target_link_libraries(${target} PRIVATE fmt::fmt)  # is among them, and has options of its own
  endif()
endfunction()

function(rondo_component component)
  cmake_parse_arguments(ARG "" "" "DEPS;TEST_DEPS;LIBS;PUBLIC_LIBS;TEST_LIBS" ${ARGN})
  set(dir ${PROJECT_SOURCE_DIR}/src/${component})
  file(GLOB sources CONFIGURE_DEPENDS ${dir}/*.cc)
  file(GLOB tests CONFIGURE_DEPENDS ${dir}/*_test.cc)
  if(tests)
    list(REMOVE_ITEM sources ${tests})
  endif()
  rondo_target_name(${component} target)
  if(sources)
    set(scope PUBLIC)
    add_library(${target} STATIC ${sources})
    target_link_libraries(${target} PRIVATE ${ARG_LIBS})
    rondo_precompile(${target})
  else()
    set(scope INTERFACE)
    add_library(${target} INTERFACE)
  endif()
  target_include_directories(${target} ${scope} ${PROJECT_SOURCE_DIR}/src)
  target_link_libraries(${target} ${scope} ${ARG_PUBLIC_LIBS})
  foreach(dep IN LISTS ARG_DEPS)
    rondo_target_name(${dep} dep_target)
    target_link_libraries(${target} ${scope} ${dep_target})
  endforeach()
  list(JOIN ARG_DEPS "," deps)
  list(JOIN ARG_TEST_DEPS "," test_deps)
  set_property(GLOBAL APPEND PROPERTY RONDO_GRAPH "${component}:${deps}:${test_deps}")
  if(RONDO_TESTS AND tests)
    add_executable(${target}_test ${tests})
    target_link_libraries(${target}_test PRIVATE ${target} ${ARG_TEST_LIBS} GTest::gtest GTest::gmock GTest::gtest_main)
    foreach(dep IN LISTS ARG_TEST_DEPS)
      rondo_target_name(${dep} dep_target)
      target_link_libraries(${target}_test PRIVATE ${dep_target})
    endforeach()
    rondo_precompile(${target}_test)
    # One process for all tests of a component: starting one under sanitizers costs more than most tests do.
    add_test(NAME unit/${component} COMMAND ${target}_test WORKING_DIRECTORY ${PROJECT_SOURCE_DIR})
  endif()
endfunction()

function(rondo_write_graph)
  get_property(graph GLOBAL PROPERTY RONDO_GRAPH)
  list(JOIN graph "\n" text)
  file(WRITE ${CMAKE_BINARY_DIR}/layers.txt "${text}\n")
endfunction()
