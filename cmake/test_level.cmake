# lxd_test_level(unit): one GoogleTest executable, lxd-unit-tests, of every *_test.cpp in the calling folder and of
# tests/support. The label of its tests is the level; of those with RealTime or Thread in their name `unit-realtime` or
# `unit-threads`, so that `ctest -L unit` picks the level and `ctest -L threads` what a sanitizer wants to see (-L is a
# regular expression). A folder without sources makes no executable. lxd_test_level(replay RUNS_PROGRAM): its tests run
# lxd-slam, mostly on the recording of tests/CMakeLists.txt; both are made first.
set(LXD_TESTS_MATCHING "" CACHE STRING "Build only those test sources that contain this regular expression; empty: all")

set(LXD_TEST_OPTIONS "" CACHE STRING "Compiler options of the tests' own sources, behind all others: -O1 where compiling them is what takes time")

set(LXD_TEST_TIMEOUT_S 300)  # of one test: far above the slowest under a sanitizer; only a hang meets it

set(LXD_TESTS_NAMED "" CACHE STRING "Build only those unit tests whose file name matches this regular expression; empty: all")

# Those of the sources in which the regular expression occurs.
function(lxd_sources_with out expression)
  set(kept "")
  foreach(source ${ARGN})
    file(STRINGS ${source} hits REGEX "${expression}" LIMIT_COUNT 1)
    if(hits)
      list(APPEND kept ${source})
    endif()
  endforeach()
  set(${out} ${kept} PARENT_SCOPE)
endfunction()

# Those that include the simulator, also by way of tests/support, or run it.
function(lxd_uses_simulator out)
  file(GLOB headers CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/tests/support/*.hpp)
  lxd_sources_with(simulated "tools/simulator/" ${headers})
  set(expression "tools/simulator/|\"simulate {")
  foreach(header ${simulated})
    get_filename_component(name ${header} NAME)
    string(APPEND expression "|tests/support/${name}")
  endforeach()
  lxd_sources_with(users "${expression}" ${ARGN})
  set(${out} ${users} PARENT_SCOPE)
endfunction()

# The tests to build; without the simulator not those that need it.
function(lxd_matching_sources out)
  set(kept ${ARGN})
  if(NOT LXD_SIMULATOR)
    lxd_uses_simulator(simulating ${kept})
    list(REMOVE_ITEM kept ${simulating})
  endif()
  if(LXD_TESTS_NAMED)
    list(FILTER kept INCLUDE REGEX "/(${LXD_TESTS_NAMED})[^/]*$")
  endif()
  if(LXD_TESTS_MATCHING)
    lxd_sources_with(kept "${LXD_TESTS_MATCHING}" ${kept})
  endif()
  set(${out} ${kept} PARENT_SCOPE)
endfunction()

function(lxd_discover target filter label)
  gtest_discover_tests(${target} TEST_FILTER "${filter}" DISCOVERY_MODE PRE_TEST DISCOVERY_TIMEOUT 60
                       PROPERTIES TIMEOUT ${LXD_TEST_TIMEOUT_S} LABELS ${label} ${ARGN})
endfunction()

# In an emulator a test alone costs more to start than to run: the executable in parts, each with a report of its tests.
function(lxd_add_emulated target)
  set(parts 4)
  math(EXPR last "${parts} - 1")
  foreach(part RANGE ${last})
    add_test(NAME ${target}.${part} COMMAND ${target} --gtest_brief=1
             --gtest_output=xml:${PROJECT_BINARY_DIR}/${target}-${part}.junit.xml)
    math(EXPR timeout_s "10 * ${LXD_TEST_TIMEOUT_S}")
    set_tests_properties(${target}.${part} PROPERTIES LABELS emulated TIMEOUT ${timeout_s}
                         ENVIRONMENT "GTEST_TOTAL_SHARDS=${parts};GTEST_SHARD_INDEX=${part}")
  endforeach()
endfunction()

function(lxd_test_level level)
  cmake_parse_arguments(LEVEL "RUNS_PROGRAM" "" "" ${ARGN})
  file(GLOB tests CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*_test.cpp)
  file(GLOB support CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/tests/support/*.cpp)
  lxd_matching_sources(sources ${tests})
  if(NOT sources)
    return()
  endif()
  set(target lxd-${level}-tests)
  add_executable(${target} ${sources} ${support})
  set_target_properties(${target} PROPERTIES UNITY_BUILD ${LXD_UNITY} UNITY_BUILD_BATCH_SIZE ${LXD_UNITY_SOURCES})
  target_compile_definitions(${target} PRIVATE LXD_TEST_BOXROOM="${LXD_TEST_BOXROOM}"
                                               LXD_TEST_DATA="${PROJECT_SOURCE_DIR}/tests/data")
  target_compile_options(${target} PRIVATE ${LXD_TEST_OPTIONS})
  target_link_libraries(${target} PRIVATE lxd_tools GTest::gtest GTest::gtest_main rapidcheck)
  if(TARGET lxd_alloc_hook)
    target_link_libraries(${target} PRIVATE lxd_alloc_hook)
  endif()
  if(LEVEL_RUNS_PROGRAM)
    add_dependencies(${target} lxd-slam lxd_test_boxroom)
  endif()
  # A preset that picks few tests does not build the simulator when none of them wants it.
  lxd_uses_simulator(simulating ${sources})
  if(simulating)
    target_link_libraries(${target} PRIVATE lxd_simulator)
    if(LEVEL_RUNS_PROGRAM)
      add_dependencies(${target} lxd-slam-simulate)
    endif()
  endif()
  add_dependencies(lxd_tests ${target})
  if(CMAKE_CROSSCOMPILING_EMULATOR)
    lxd_add_emulated(${target})
    return()
  endif()
  lxd_discover(${target} "*Real?ime*" ${level}-realtime)
  lxd_discover(${target} "*Thread*-*Real?ime*" ${level}-threads)
  # Suites named Live… keep pace with wires: nothing else runs beside them.
  lxd_discover(${target} "Live*-*Real?ime*:*Thread*" ${level}-live RUN_SERIAL TRUE)
  lxd_discover(${target} "-*Real?ime*:*Thread*:Live*" ${level})
endfunction()
