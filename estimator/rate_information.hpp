// SPDX-License-Identifier: Apache-2.0
// What a sweep says of the body's rates, velocity and turning, by how its points are skewed.
//
// The rows are not independent: the surfaces they are held against have errors in common. For the pose that matters
// little, it is known far better than the prediction anyway. For the rates it does: a few millimetres that the first
// and the last returns of a sweep do not share are centimetres a second, the deskew by such rates puts them into the
// map, and the next sweep finds them confirmed. So of what the rows tell of the rates beyond the pose, no more is
// believed than so many independent rows would tell.
#pragma once

#include <cstddef>

#include "estimator/degeneracy.hpp"

namespace lxd {

// Of so many rows.
double doubted_share(std::size_t rows);

// With A = [A_xx A_xr; A_rx A_rr] of pose x and rates r, S = A_rr - A_rx A_xx^-1 A_xr is what the rows tell of the
// rates when the pose is left free. A_rr loses the share of S that is not believed, the gradient as much: the rates
// measured stay where they were, with a larger variance, and the pose for given rates is measured as before. rows: how
// many the sums are of.
void limit_rates(std::size_t rows, NormalEquations& sums);

}  // namespace lxd
