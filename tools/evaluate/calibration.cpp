// SPDX-License-Identifier: Apache-2.0
// Normalised squares, shares within one to three sigma, and the reliability by decile.
#include "tools/evaluate/calibration.hpp"

#include <algorithm>
#include <cmath>
#include <span>

namespace lxd {
namespace {

constexpr std::size_t kDeciles = 10;

double squared_ratio(const ClaimedError& e) { return (e.error_m / e.sigma_m) * (e.error_m / e.sigma_m); }

double share_within(std::span<const ClaimedError> errors, double sigmas) {
  const auto within =
      std::ranges::count_if(errors, [=](const ClaimedError& e) { return e.error_m <= sigmas * e.sigma_m; });
  return static_cast<double>(within) / static_cast<double>(errors.size());
}

CalibrationBin bin_of(std::span<const ClaimedError> errors) {
  CalibrationBin bin{errors.size(), 0, 0};
  for (const ClaimedError& e : errors) {
    bin.claimed_rms_m += e.sigma_m * e.sigma_m;
    bin.actual_rms_m += e.error_m * e.error_m;
  }
  const auto count = static_cast<double>(errors.size());
  bin.claimed_rms_m = std::sqrt(bin.claimed_rms_m / count);
  bin.actual_rms_m = std::sqrt(bin.actual_rms_m / count);
  return bin;
}

std::vector<CalibrationBin> deciles_of(std::span<const ClaimedError> sorted) {
  std::vector<CalibrationBin> bins;
  for (std::size_t i = 0; i < kDeciles; ++i) {
    const std::size_t begin = i * sorted.size() / kDeciles, end = (i + 1) * sorted.size() / kDeciles;
    if (begin < end) bins.push_back(bin_of(sorted.subspan(begin, end - begin)));
  }
  return bins;
}

void add_squares(MeshCalibration& result, std::span<const ClaimedError> errors) {
  std::vector<double> squares;
  for (const ClaimedError& e : errors) squares.push_back(squared_ratio(e));
  const auto middle = squares.begin() + static_cast<std::ptrdiff_t>(squares.size() / 2);
  std::ranges::nth_element(squares, middle);
  result.median_square = *middle;
  for (const double square : squares) result.mean_square += square / static_cast<double>(squares.size());
  result.error_ratio = std::sqrt(result.median_square / kMedianOfChiSquared1);
}

}  // namespace

MeshCalibration calibration(std::vector<ClaimedError> errors, double reach_m) {
  MeshCalibration result;
  std::erase_if(errors, [](const ClaimedError& e) { return !(e.sigma_m > 0); });
  result.samples = errors.size();
  if (errors.empty()) return result;
  for (std::size_t i = 0; i < result.share_within.size(); ++i)
    result.share_within[i] = share_within(errors, static_cast<double>(i + 1));
  result.beyond_reach = std::erase_if(errors, [=](const ClaimedError& e) { return e.error_m >= reach_m; });
  if (errors.empty()) return result;
  std::ranges::stable_sort(errors, {}, &ClaimedError::sigma_m);  // equal claims must not be sorted by their errors
  result.deciles = deciles_of(errors);
  add_squares(result, errors);
  return result;
}

}  // namespace lxd
