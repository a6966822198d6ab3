// SPDX-License-Identifier: Apache-2.0
// Words on standard error that never fail the caller: a full log must not cost a run its map.
#pragma once

#include <cstdio>
#include <utility>

#include <fmt/format.h>

namespace lxd {

template <typename... T>
void say(fmt::format_string<T...> text, T&&... values) {
  (void)std::fputs(fmt::format(text, std::forward<T>(values)...).c_str(), stderr);
}

}  // namespace lxd
