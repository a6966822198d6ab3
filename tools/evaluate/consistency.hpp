// SPDX-License-Identifier: Apache-2.0
// Is the filter as sure as it should be: the normalised estimation error squared (NEES; Bar-Shalom, Li, Kirubarajan,
// Estimation with Applications to Tracking and Navigation, 2001, section 5.4).
#pragma once

#include <span>

#include "tools/evaluate/associate.hpp"
#include "tools/evaluate/report.hpp"

namespace lxd {

// The error is R_true = R Exp(e_r), p_true = p + e_p, in the filter's own world. That world is tied to truth by the
// first pair, not by the best fit of the whole path: the filter starts with a covariance of next to nothing and lets it
// grow with the way, which is a statement about the error since the start; a best fit would spread the error over the
// path and find errors at the start that the filter cannot know. The price: truth's error at the first pair is in all
// others. The first pair, which has no error by construction, does not count. Precondition: truth has orientations, a
// pair is there.
Consistency consistency(std::span<const PosePair> pairs, std::span<const StampedCovariance> covariances);

// Quantile of chi^2 with `degrees` of freedom (Wilson & Hilferty, PNAS 1931); z is the standard normal's quantile.
double chi_squared_quantile(double degrees, double z);

}  // namespace lxd
