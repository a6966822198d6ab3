// SPDX-License-Identifier: Apache-2.0
// NEES of a path against its own covariances.
#include "tools/evaluate/consistency.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <Eigen/Cholesky>

#include "tools/evaluate/align.hpp"

namespace lxd {
namespace {

constexpr double kZ97_5 = 1.959964;  // standard normal: two-sided 95 %
constexpr int kPoseDimensions = 6;
constexpr double kChiSquared6Low = 1.2373;  // 2.5 % and 97.5 % quantiles of chi^2(6), from tables
constexpr double kChiSquared6High = 14.4494;
constexpr Duration kStampTolerance = Duration::from_ns(1000);

using Vector6d = Eigen::Matrix<double, 6, 1>;

Vector6d error_of(const Pose& estimate, const Pose& truth) {
  const Eigen::AngleAxisd rotation(Eigen::Quaterniond(estimate.R.transpose() * truth.R));
  Vector6d error;
  error << rotation.angle() * rotation.axis(), truth.p - estimate.p;
  return error;
}

const StampedCovariance* find_at(std::span<const StampedCovariance> covariances, RigTime stamp) {
  const auto at = std::ranges::lower_bound(covariances, stamp - kStampTolerance, {}, &StampedCovariance::stamp);
  return at != covariances.end() && at->stamp <= stamp + kStampTolerance ? &*at : nullptr;
}

template <typename Matrix, typename Vector>
std::optional<double> nees(const Matrix& covariance, const Vector& error) {
  const Eigen::LLT<typename Matrix::PlainObject> root(covariance);
  if (root.info() != Eigen::Success) return std::nullopt;
  return error.dot(root.solve(error));
}

struct Sums {
  double pose = 0, rotation = 0, position = 0;
  std::size_t within = 0;
};

// False: the covariance is not positive definite.
bool add(Sums& sums, const Eigen::Matrix<double, 6, 6>& covariance, const Vector6d& error) {
  const auto pose = nees(covariance, error);
  if (!pose) return false;
  sums.pose += *pose;
  sums.rotation += nees(covariance.topLeftCorner<3, 3>().eval(), error.head<3>().eval()).value_or(0);
  sums.position += nees(covariance.bottomRightCorner<3, 3>().eval(), error.tail<3>().eval()).value_or(0);
  sums.within += *pose >= kChiSquared6Low && *pose <= kChiSquared6High ? 1 : 0;
  return true;
}

}  // namespace

double chi_squared_quantile(double degrees, double z) {
  const double spread = 2 / (9 * degrees);
  return degrees * std::pow(1 - spread + z * std::sqrt(spread), 3);
}

Consistency consistency(std::span<const PosePair> pairs, std::span<const StampedCovariance> covariances) {
  const Pose T_map_truth = align_first(pairs).inverse();
  Consistency result;
  Sums sums;
  for (const PosePair& pair : pairs.subspan(1)) {
    const StampedCovariance* const at = find_at(covariances, pair.stamp);
    const bool counted = at != nullptr && add(sums, at->covariance, error_of(pair.estimate, T_map_truth * pair.truth));
    ++(counted ? result.poses : result.skipped);
  }
  if (result.poses == 0) return result;
  const auto count = static_cast<double>(result.poses);
  result.nees_pose = sums.pose / count;
  result.nees_rotation = sums.rotation / count;
  result.nees_position = sums.position / count;
  result.lower_95 = chi_squared_quantile(kPoseDimensions * count, -kZ97_5) / count;
  result.upper_95 = chi_squared_quantile(kPoseDimensions * count, kZ97_5) / count;
  result.share_within_95 = static_cast<double>(sums.within) / count;
  return result;
}

}  // namespace lxd
