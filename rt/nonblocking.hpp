// SPDX-License-Identifier: Apache-2.0
// Marks a function of the real-time path: it neither allocates, locks, throws nor makes a blocking system call. clang
// (20 and later) then checks it at compile time (-Wfunction-effects) and, built with -fsanitize=realtime, at run time;
// gcc sees nothing. It stands last in the declarator: void step() noexcept LXD_NONBLOCKING;
#pragma once

#if defined(__clang__)
#if __has_cpp_attribute(clang::nonblocking)
#define LXD_NONBLOCKING [[clang::nonblocking]]
// Around a call of a library function that is known not to block but is not declared so; the comment there says how it
// is known. Only the compile-time check is silenced: -fsanitize=realtime still looks.
#define LXD_KNOWN_NONBLOCKING_BEGIN \
  _Pragma("clang diagnostic push") _Pragma("clang diagnostic ignored \"-Wfunction-effects\"")
#define LXD_KNOWN_NONBLOCKING_END _Pragma("clang diagnostic pop")
#endif
#endif

#ifndef LXD_NONBLOCKING
#define LXD_NONBLOCKING
#define LXD_KNOWN_NONBLOCKING_BEGIN
#define LXD_KNOWN_NONBLOCKING_END
#endif
