// SPDX-License-Identifier: Apache-2.0
// The square of a number, where it is written once and used twice.
#pragma once

namespace lxd {

constexpr double square(double x) { return x * x; }

}  // namespace lxd
