# 32-bit ARM boards (ARMv7, hard float): cmake --toolchain toolchains/armhf.cmake -DLXD_SYSROOT=…
set(CMAKE_SYSTEM_PROCESSOR armv7l)
set(LXD_TRIPLET arm-linux-gnueabihf)
set(LXD_QEMU qemu-arm-static)
include(${CMAKE_CURRENT_LIST_DIR}/debian-cross.cmake)
