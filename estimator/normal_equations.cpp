// SPDX-License-Identifier: Apache-2.0
#include "estimator/normal_equations.hpp"

#include <algorithm>
#include <cmath>

namespace lxd {
namespace {

constexpr double kMedianToSigma = 1.4826;   // of a normal distribution
constexpr double kKernelSigmas = 2.5;       // of the Geman-McClure kernel in the end
constexpr double kFirstKernelSigmas = 8.0;  // and in the first iteration
constexpr double kKernelShrink = 0.65;      // from one iteration to the next

}  // namespace

double geman_mcclure(double squared_ratio, double squared_kernel) {
  const double w = squared_kernel / (squared_kernel + squared_ratio);
  return w * w;
}

double residual_scale(std::span<const PointResidual> residuals, std::span<float> scratch) {
  if (residuals.empty()) return 1.0;
  const auto ratios = scratch.first(residuals.size());
  for (std::size_t i = 0; i < residuals.size(); ++i)
    ratios[i] = static_cast<float>(std::abs(residuals[i].r_m) / std::sqrt(residuals[i].variance_m2));
  const auto middle = ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2);
  std::nth_element(ratios.begin(), middle, ratios.end());
  return std::max(1.0, kMedianToSigma * static_cast<double>(*middle));
}

double kernel_sigmas(int iteration) {
  return std::max(kKernelSigmas, kFirstKernelSigmas * std::pow(kKernelShrink, iteration));
}

double RobustWeight::of(const PointResidual& residual) const {
  const double variance = scale * scale * residual.variance_m2;
  return geman_mcclure(residual.r_m * residual.r_m / variance, kernel_sigmas * kernel_sigmas) / variance;
}

NormalEquations accumulate(std::span<const PointResidual> residuals, double scale, double kernel_sigmas) {
  const RobustWeight weight{scale, kernel_sigmas};
  NormalEquations sums;
  for (const PointResidual& residual : residuals) {
    const double w = weight.of(residual);
    const LidarVector weighted = w * residual.row;
    sums.information.noalias() += weighted * residual.row.transpose();
    sums.gradient += residual.r_m * weighted;
    sums.weight += w;
  }
  return sums;
}

}  // namespace lxd
