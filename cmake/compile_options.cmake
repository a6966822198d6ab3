# One place for language level, warnings, instruction set and instrumentation.
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)

if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Release | Debug | RelWithDebInfo" FORCE)
endif()

if(NOT DEFINED CMAKE_CXX_COMPILER_LAUNCHER)
  find_program(LXD_CCACHE ccache)
  if(LXD_CCACHE)
    set(CMAKE_CXX_COMPILER_LAUNCHER ${LXD_CCACHE})
  endif()
endif()

if(LXD_MARCH STREQUAL "" AND CMAKE_SYSTEM_PROCESSOR STREQUAL "x86_64")
  set(LXD_MARCH "x86-64-v3")
endif()

add_library(lxd_options INTERFACE)
target_include_directories(lxd_options INTERFACE ${PROJECT_SOURCE_DIR})
target_compile_options(lxd_options INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion
                                             -Wnon-virtual-dtor -Woverloaded-virtual -Wimplicit-fallthrough
                                             -fno-math-errno -fno-trapping-math -ffp-contract=off)
# The same sums in the same order on every machine, so that its path does not depend on the processor: neither products fused into
# sums (above: ARM would, with gcc's default) nor Eigen's own vectors, whose width and order of adding are each processor's. What
# gcc makes vectors of keeps the order as written; for that, products of the filter's matrices (18 rows) are plain loops, not blocks.
target_compile_definitions(lxd_options INTERFACE EIGEN_DONT_VECTORIZE EIGEN_CACHEFRIENDLY_PRODUCT_THRESHOLD=32)
# The product's compiler is Debian's gcc: there a warning is an error. Not in instrumented builds, where gcc's flow analysis
# misjudges Eigen, and not with clang, which only instruments; there warnings inform.
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND NOT LXD_SANITIZE)
  target_compile_options(lxd_options INTERFACE -Werror -Wno-psabi)  # psabi: notes on ABIs before gcc 10
endif()
if(LXD_MARCH)
  target_compile_options(lxd_options INTERFACE -march=${LXD_MARCH})
endif()
if(CMAKE_SYSTEM_PROCESSOR STREQUAL "x86_64")
  target_compile_options(lxd_options INTERFACE -mno-fma)  # gcc 12 fuses alternate sums and differences in spite of the above
endif()

if(LXD_SANITIZE)
  target_compile_options(lxd_options INTERFACE -fsanitize=${LXD_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  target_link_options(lxd_options INTERFACE -fsanitize=${LXD_SANITIZE})
  target_compile_definitions(lxd_options INTERFACE LXD_SANITIZED=1)
endif()
# Every source sees the same definitions: Eigen and libstdc++ are headers, and half a program with checks breaks the other.
if(LXD_DEBUG_CHECKS)
  target_compile_definitions(lxd_options INTERFACE LXD_DEBUG_CHECKS=1 EIGEN_RUNTIME_NO_MALLOC _GLIBCXX_ASSERTIONS)
endif()
if(LXD_COVERAGE)
  target_compile_options(lxd_options INTERFACE --coverage -fprofile-update=atomic)
  target_link_options(lxd_options INTERFACE --coverage)
endif()

# Half of a source's compile time is reading the same headers: rooms and tests are compiled several sources at a time. Not in the
# debug preset, where one changed source should cost one.
set(LXD_UNITY_SOURCES 6)

# lxd_room(rt LINK a b [WITHOUT part/…]): the static library of a room, made of every source in its
# folder but those whose paths begin with one of the parts.
function(lxd_room name)
  cmake_parse_arguments(ROOM "" "" "LINK;WITHOUT" ${ARGN})
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*.cpp)
  foreach(left_out ${ROOM_WITHOUT})
    list(FILTER sources EXCLUDE REGEX "^${CMAKE_CURRENT_SOURCE_DIR}/${left_out}")
  endforeach()
  add_library(lxd_${name} STATIC ${sources})
  set_target_properties(lxd_${name} PROPERTIES UNITY_BUILD ${LXD_UNITY} UNITY_BUILD_BATCH_SIZE ${LXD_UNITY_SOURCES})
  target_link_libraries(lxd_${name} PUBLIC lxd_options ${ROOM_LINK})
endfunction()
