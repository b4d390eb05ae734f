# 64-bit Arm on Linux: Debian's cross compiler, or Clang with its libraries; other libraries from where
# scripts/arm64-sysroot unpacks them. Programs run in qemu's user mode.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_LIBRARY_ARCHITECTURE aarch64-linux-gnu)

if(NOT CMAKE_CXX_COMPILER)
    set(CMAKE_C_COMPILER aarch64-linux-gnu-gcc)
    set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)
endif()
# Clang's.
set(CMAKE_C_COMPILER_TARGET aarch64-linux-gnu)
set(CMAKE_CXX_COMPILER_TARGET aarch64-linux-gnu)

set(VERNIER_ARM64_SYSROOT ${CMAKE_CURRENT_LIST_DIR}/../../build/arm64-sysroot CACHE PATH "Where scripts/arm64-sysroot unpacked")
get_filename_component(root ${VERNIER_ARM64_SYSROOT} ABSOLUTE)
list(APPEND CMAKE_TRY_COMPILE_PLATFORM_VARIABLES VERNIER_ARM64_SYSROOT)
foreach(language C CXX)
    set(CMAKE_${language}_STANDARD_INCLUDE_DIRECTORIES ${root}/usr/include ${root}/usr/include/aarch64-linux-gnu)
endforeach()
set(libraries ${root}/usr/lib/aarch64-linux-gnu ${root}/lib/aarch64-linux-gnu)
list(TRANSFORM libraries PREPEND "-L" OUTPUT_VARIABLE link_paths)
list(JOIN link_paths " " link_paths)
foreach(kind EXE SHARED)
    set(CMAKE_${kind}_LINKER_FLAGS_INIT "${link_paths}")
endforeach()

set(CMAKE_FIND_ROOT_PATH ${root} /usr/aarch64-linux-gnu)
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
foreach(kind LIBRARY INCLUDE PACKAGE)
    set(CMAKE_FIND_ROOT_PATH_MODE_${kind} ONLY)
endforeach()

list(JOIN libraries ":" load_path)
set(CMAKE_CROSSCOMPILING_EMULATOR qemu-aarch64 -L /usr/aarch64-linux-gnu -E LD_LIBRARY_PATH=${load_path})
