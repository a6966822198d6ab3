// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace lxd {

constexpr double square(double x) { return x * x; }

}  // namespace lxd
