// SPDX-License-Identifier: Apache-2.0
// Marks a function of the real-time path: it neither allocates, locks, throws nor makes a blocking system call. clang
// (20 and later) then checks it at compile time (-Wfunction-effects) and, built with -fsanitize=realtime, at run time;
// gcc sees nothing. It stands last in the declarator: void step() noexcept LXD_NONBLOCKING;
#pragma once

#if defined(__clang__) && defined(__has_cpp_attribute)
#if __has_cpp_attribute(clang::nonblocking)
#define LXD_NONBLOCKING [[clang::nonblocking]]
#endif
#endif

#ifndef LXD_NONBLOCKING
#define LXD_NONBLOCKING
#endif
