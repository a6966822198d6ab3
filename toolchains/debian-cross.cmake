# What the two ARM toolchain files share: Debian 12's cross compiler and a sysroot made by toolchains/make-sysroot.
# The including file has set LXD_TRIPLET, CMAKE_SYSTEM_PROCESSOR and LXD_QEMU.
set(CMAKE_SYSTEM_NAME Linux)

if(NOT LXD_SYSROOT)
  set(LXD_SYSROOT $ENV{LXD_SYSROOT})
endif()
if(NOT EXISTS "${LXD_SYSROOT}/usr/lib/${LXD_TRIPLET}")
  message(FATAL_ERROR "LXD_SYSROOT is '${LXD_SYSROOT}'; wanted: a folder made by toolchains/make-sysroot for ${LXD_TRIPLET}")
endif()
list(APPEND CMAKE_TRY_COMPILE_PLATFORM_VARIABLES LXD_SYSROOT)

set(CMAKE_SYSROOT ${LXD_SYSROOT})
set(CMAKE_C_COMPILER ${LXD_TRIPLET}-gcc)
set(CMAKE_CXX_COMPILER ${LXD_TRIPLET}-g++)
set(CMAKE_LIBRARY_ARCHITECTURE ${LXD_TRIPLET})
set(CMAKE_FIND_ROOT_PATH ${LXD_SYSROOT})
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
# A library of the sysroot finds its own libraries there while linking.
set(CMAKE_EXE_LINKER_FLAGS_INIT "-Wl,-rpath-link,${LXD_SYSROOT}/usr/lib/${LXD_TRIPLET}")
set(CMAKE_CROSSCOMPILING_EMULATOR ${LXD_QEMU};-L;${LXD_SYSROOT})

# pkg-config must answer for the sysroot and never for the host.
set(ENV{PKG_CONFIG_SYSROOT_DIR} ${LXD_SYSROOT})
set(ENV{PKG_CONFIG_LIBDIR} ${LXD_SYSROOT}/usr/lib/${LXD_TRIPLET}/pkgconfig:${LXD_SYSROOT}/usr/share/pkgconfig)
