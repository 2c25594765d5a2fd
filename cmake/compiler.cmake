# Compiler settings of every target of this project.
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)

find_program(CCACHE ccache)
if(CCACHE)
  # ccache can use precompiled headers only with this sloppiness. It has no effect on our sources, which do not use
  # __TIME__. Comments must count: gcc includes a header with #pragma once again if its text is not the text in the
  # precompiled header, so one from the cache with other comments leads to redefinitions.
  set(CMAKE_CXX_COMPILER_LAUNCHER
      ${CMAKE_COMMAND} -E env CCACHE_SLOPPINESS=pch_defines,time_macros CCACHE_COMMENTS=1 ${CCACHE})
endif()

# Headers take most of the compile time. With SPAWNFIELD_UNITY the source files of a folder form one translation unit,
# in which they also see the unnamed namespaces of each other. Two warnings about that are off. The dev preset compiles
# each file alone, with all warnings.
option(SPAWNFIELD_UNITY "Compile the source files of a folder together, so that the first build is faster" ON)
function(compile_by_folder target)
  if(NOT SPAWNFIELD_UNITY)
    return()
  endif()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  get_target_property(sources ${target} SOURCES)
  foreach(source ${sources})
    cmake_path(GET source PARENT_PATH folder)
    cmake_path(GET folder FILENAME folder)
    set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${folder})
  endforeach()
endfunction()

# Asserts stay on in optimised builds.
string(REPLACE "-DNDEBUG" "" CMAKE_CXX_FLAGS_RELEASE "${CMAKE_CXX_FLAGS_RELEASE}")
string(REPLACE "-DNDEBUG" "" CMAKE_CXX_FLAGS_RELWITHDEBINFO "${CMAKE_CXX_FLAGS_RELWITHDEBINFO}")

# Every x86 processor since 2009 can count bits and round in one instruction. The results are the same.
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  set(SPAWNFIELD_ARCH x86-64-v2 CACHE STRING "Value of -march=; empty for the default of the compiler")
endif()
if(SPAWNFIELD_ARCH)
  add_compile_options(-march=${SPAWNFIELD_ARCH})
endif()

# -ffp-contract=off: a fused multiply-add would give other numbers, and so other bytes on some machines.
# -fno-math-errno and -fno-trapping-math: nobody reads errno after a square root, nor the flags of floating-point
# exceptions. The results are the same; the rasters are 1 to 5 % faster.
add_library(spawnfield_options INTERFACE)
target_compile_options(spawnfield_options INTERFACE
  -fopenmp-simd -ffp-contract=off -fno-math-errno -fno-trapping-math -Wall -Wextra -Wconversion -Wno-sign-conversion
  $<IF:$<BOOL:$<TARGET_PROPERTY:UNITY_BUILD>>,$<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>,-Wshadow>
  $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>  # gcc 12 warns about std::string + std::string (GCC bug 105329)
  $<$<CXX_COMPILER_ID:Clang>:-Wno-pass-failed>  # a loop that clang does not vectorise is only slower
  $<$<BOOL:${SPAWNFIELD_WERROR}>:-Werror>)
# Eigen's asserts cost more than ours. They stay on in debug builds, whose tests are enough to find such errors.
target_compile_definitions(spawnfield_options INTERFACE $<$<NOT:$<CONFIG:Debug>>:EIGEN_NO_DEBUG>)

# A sanitizer looks for faults in the library, its modules and the program. Only these link spawnfield_sanitizer; all
# other code compiles to the objects of the release, which ccache has or will need again.
add_library(spawnfield_sanitizer INTERFACE)
if(SPAWNFIELD_SANITIZE)
  set(sanitizer_options -O1 -g1 -fsanitize=${SPAWNFIELD_SANITIZE} -fno-omit-frame-pointer
    $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)  # in instrumented code gcc 12 warns about its own <regex>
  if(SPAWNFIELD_SANITIZE MATCHES "undefined")
    # These checks of each access to memory double the time of the compiler and of the tests. The address sanitizer
    # finds null pointers and accesses outside of objects, too.
    list(APPEND sanitizer_options
      -fno-sanitize-recover=undefined -fno-sanitize=null,alignment,object-size,vptr)
  endif()
  target_compile_options(spawnfield_sanitizer INTERFACE ${sanitizer_options})
  add_link_options(-fsanitize=${SPAWNFIELD_SANITIZE})
endif()
