# Build settings shared by every target, and the three ways a folder declares what it builds:
#   vernier_library(name SOURCES ... [PUBLIC ...] [PRIVATE ...])   a static library of the house
#   vernier_executable(name SOURCES ... [LIBS ...])                a program
#   vernier_test(name LABELS ... SOURCES ... [LIBS ...])           a GoogleTest program run by CTest

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_C_STANDARD 99)
set(CMAKE_C_EXTENSIONS OFF)
# The driver is loaded into other people's processes: everything in it is position independent and hidden.
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_CXX_VISIBILITY_PRESET hidden)
set(CMAKE_C_VISIBILITY_PRESET hidden)
set(CMAKE_VISIBILITY_INLINES_HIDDEN ON)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)

if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
    set(CMAKE_BUILD_TYPE Release CACHE STRING "Build type" FORCE)
endif()

find_program(VERNIER_CCACHE ccache)
if(VERNIER_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
    set(CMAKE_C_COMPILER_LAUNCHER ${VERNIER_CCACHE})
    set(CMAKE_CXX_COMPILER_LAUNCHER ${VERNIER_CCACHE})
endif()

set(VERNIER_SANITIZE "" CACHE STRING "Sanitizers for every target, e.g. address,undefined or thread")

option(VERNIER_FUZZ "Build the fuzz targets (Clang): see scripts/fuzz" OFF)

add_library(vernier_settings INTERFACE)
if(VERNIER_FUZZ)
    target_compile_options(vernier_settings INTERFACE -fsanitize=fuzzer-no-link)
endif()
target_include_directories(vernier_settings INTERFACE ${PROJECT_SOURCE_DIR})
# One scene gives one image on every CPU: the compiler may neither fuse nor reorder floating-point operations.
target_compile_options(vernier_settings INTERFACE
    -ffp-contract=off -fno-fast-math -Wall -Wextra -Wshadow -Werror
    $<$<COMPILE_LANGUAGE:CXX>:-Wnon-virtual-dtor -Woverloaded-virtual>
    # g++ 12 warns about "text" + std::to_string(n) where nothing is wrong (GCC bug 105651).
    $<$<COMPILE_LANG_AND_ID:CXX,GNU>:-Wno-restrict>)
if(CMAKE_SYSTEM_PROCESSOR STREQUAL aarch64)
    # Vectors of NEON are objects to g++, which misses that a loop's first turn fills those declared before it.
    target_compile_options(vernier_settings INTERFACE $<$<COMPILE_LANG_AND_ID:CXX,GNU>:-Wno-maybe-uninitialized>)
endif()
# Tiles of 64 pixels are what is fast; 16 and 32 are for scripts/same-bits, which shows that no pixel depends on it.
set(VERNIER_TILE_SIZE 64 CACHE STRING "Pixels on a side of a tile: 16, 32 or 64")
if(NOT VERNIER_TILE_SIZE EQUAL 64)
    target_compile_definitions(vernier_settings INTERFACE VERNIER_TILE_SIZE=${VERNIER_TILE_SIZE})
endif()
if(VERNIER_SANITIZE)
    target_compile_options(vernier_settings INTERFACE
        -fsanitize=${VERNIER_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer -g1)
    # Programs in C link libraries in C++: what the sanitizers of those need, the C driver of Clang leaves out.
    set(VERNIER_SANITIZE_LINK -fsanitize=${VERNIER_SANITIZE})
    if(CMAKE_CXX_COMPILER_ID MATCHES Clang)
        list(APPEND VERNIER_SANITIZE_LINK -fsanitize-link-c++-runtime -lstdc++)
    endif()
    target_link_options(vernier_settings INTERFACE ${VERNIER_SANITIZE_LINK})
endif()

# For small structures g++ for x86 takes "rep stos" and "rep movs", which cost some 80 cycles to start: too much for what
# runs once per batch of fragments.
set(VERNIER_SMALL_COPIES "")
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
    set(VERNIER_SMALL_COPIES
        $<$<COMPILE_LANG_AND_ID:CXX,GNU>:-mmemset-strategy=unrolled_loop:256:noalign,libcall:-1:noalign>
        $<$<COMPILE_LANG_AND_ID:CXX,GNU>:-mmemcpy-strategy=unrolled_loop:256:noalign,libcall:-1:noalign>)
endif()

find_package(Threads REQUIRED)

# For a folder in which nothing is timed: what is under test is optimised fully all the same, being in libraries of its own,
# and the folder takes a quarter less time to build.
macro(vernier_build_quickly)
    add_compile_options($<$<CONFIG:Release>:-O1>)
endmacro()

function(vernier_library name)
    cmake_parse_arguments(ARG "" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
    add_library(${name} STATIC ${ARG_SOURCES})
    target_link_libraries(${name} PUBLIC $<BUILD_INTERFACE:vernier_settings> ${ARG_PUBLIC} PRIVATE ${ARG_PRIVATE})
endfunction()

function(vernier_executable name)
    cmake_parse_arguments(ARG "" "" "SOURCES;LIBS" ${ARGN})
    add_executable(${name} ${ARG_SOURCES})
    target_link_libraries(${name} PRIVATE vernier_settings ${ARG_LIBS})
endfunction()

function(vernier_test name)
    cmake_parse_arguments(ARG "" "TIMEOUT" "SOURCES;LIBS;LABELS" ${ARGN})
    find_package(GTest REQUIRED)
    add_executable(${name} ${ARG_SOURCES})
    target_link_libraries(${name} PRIVATE vernier_settings ${ARG_LIBS} GTest::gtest GTest::gmock GTest::gtest_main)
    if(NOT ARG_TIMEOUT)
        set(ARG_TIMEOUT 300)
    endif()
    add_test(NAME ${name} COMMAND ${name})
    set_tests_properties(${name} PROPERTIES LABELS "${ARG_LABELS}" TIMEOUT ${ARG_TIMEOUT})
endfunction()
