# 64-bit ARM boards: cmake --toolchain toolchains/aarch64.cmake -DLXD_SYSROOT=…
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(LXD_TRIPLET aarch64-linux-gnu)
set(LXD_QEMU qemu-aarch64-static)
include(${CMAKE_CURRENT_LIST_DIR}/debian-cross.cmake)
