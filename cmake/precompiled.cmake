# Half of a compilation would be reading the same headers, so those of the standard library, Eigen
# and GoogleTest are read once: for what is shipped in one precompiled header, for the tests in
# another. Only headers that do not change with our sources stand in them, and no source relies on
# it: SLOPER_PCH=OFF makes the same programs. ccache steps aside unless told: where it is the
# launcher, that is done here; where it poses as the compiler (/usr/lib/ccache), set
# CCACHE_SLOPPINESS=pch_defines,time_macros or SLOPER_PCH=OFF.
option(SLOPER_PCH "Read the headers of the standard library, Eigen and GoogleTest once for all sources" ON)

set(shared_headers <algorithm> <array> <cmath> <cstdint> <cstdio> <filesystem> <functional> <map> <memory> <numeric> <optional> <set> <sstream>
  <string> <unordered_map> <vector> <Eigen/Core> <Eigen/Geometry>)

if(SLOPER_PCH AND CMAKE_CXX_COMPILER_LAUNCHER MATCHES "ccache$")
  set(common ${PROJECT_SOURCE_DIR}) # paths below it are relative in what ccache compares
  cmake_path(IS_PREFIX common ${PROJECT_BINARY_DIR} inside)
  while(NOT inside)
    cmake_path(GET common PARENT_PATH common)
    cmake_path(IS_PREFIX common ${PROJECT_BINARY_DIR} inside)
  endwhile()
  list(PREPEND CMAKE_CXX_COMPILER_LAUNCHER env CCACHE_SLOPPINESS=pch_defines,time_macros CCACHE_BASEDIR=${common})
endif()

# A precompiled header for the targets that are given to sloper_use_precompiled; OPTIONS are those
# that they all have.
function(sloper_precompile name)
  cmake_parse_arguments(ARG "" "" "HEADERS;LINK;OPTIONS" ${ARGN})
  if(SLOPER_PCH)
    add_library(${name} OBJECT ${PROJECT_SOURCE_DIR}/cmake/precompiled.cpp)
    target_link_libraries(${name} PRIVATE sloper_options ${ARG_LINK})
    target_compile_options(${name} PRIVATE ${ARG_OPTIONS})
    target_precompile_headers(${name} PRIVATE ${ARG_HEADERS})
  endif()
endfunction()

function(sloper_use_precompiled header)
  if(SLOPER_PCH)
    foreach(target ${ARGN})
      target_precompile_headers(${target} REUSE_FROM ${header})
    endforeach()
  endif()
endfunction()
