// SPDX-License-Identifier: Apache-2.0
// Is the filter as sure as it should be: the normalised estimation error squared and the normalised innovation squared
// (NEES, NIS; Bar-Shalom, Li, Kirubarajan, Estimation with Applications to Tracking and Navigation, 2001, section 5.4).
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "tools/evaluate/associate.hpp"
#include "tools/evaluate/report.hpp"

namespace lxd {

// The error is R_true = R Exp(e_r), p_true = p + e_p, in the filter's own world. That world is tied to truth by the
// first pair, not by the best fit of the whole path: the filter starts with a covariance of next to nothing and lets it
// grow with the way, which is a statement about the error since the start; a best fit would spread the error over the
// path and find errors at the start that the filter cannot know. The price: truth's error at the first pair is in all
// others. Precondition: truth has orientations, a pair is there.
struct FilterError {
  using Vector = Eigen::Matrix<double, 6, 1>;
  Vector error;                         // [rotation (body) rad, position (world) m]
  const StampedCovariance* covariance;  // of that stamp; null: there is none
};
std::vector<FilterError> filter_errors(std::span<const PosePair> pairs, std::span<const StampedCovariance> covariances);

// Of the pose; nothing when there is no covariance or it is not positive definite.
std::optional<double> nees(const FilterError& error);

// The first error, which is none by construction, does not count. Precondition: there is one.
Consistency consistency(std::span<const FilterError> errors);

InnovationConsistency consistency(std::span<const StampedInnovation> innovations);

inline constexpr double kZ97_5 = 1.959964;         // quantile of the standard normal: two-sided 95 %
inline constexpr double kChiSquared6Low = 1.2373;  // 2.5 % and 97.5 % quantiles of chi^2(6), from tables
inline constexpr double kChiSquared6High = 14.4494;

// Quantile of chi^2 with `degrees` of freedom (Wilson & Hilferty, PNAS 1931); z is the standard normal's quantile.
double chi_squared_quantile(double degrees, double z);

}  // namespace lxd
