// SPDX-License-Identifier: Apache-2.0
// NEES of a path against its own covariances, NIS of the updates that made it.
#include "tools/evaluate/consistency.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <Eigen/Cholesky>

#include "tools/evaluate/align.hpp"

namespace lxd {
namespace {

constexpr int kPoseDimensions = 6;
constexpr Duration kStampTolerance = Duration::from_ns(1000);

FilterError::Vector error_of(const Pose& estimate, const Pose& truth) {
  const Eigen::AngleAxisd rotation(Eigen::Quaterniond(estimate.R.transpose() * truth.R));
  FilterError::Vector error;
  error << rotation.angle() * rotation.axis(), truth.p - estimate.p;
  return error;
}

const StampedCovariance* find_at(std::span<const StampedCovariance> covariances, RigTime stamp) {
  const auto at = std::ranges::lower_bound(covariances, stamp - kStampTolerance, {}, &StampedCovariance::stamp);
  return at != covariances.end() && at->stamp <= stamp + kStampTolerance ? &*at : nullptr;
}

template <typename Matrix, typename Vector>
std::optional<double> normalised_square(const Matrix& covariance, const Vector& error) {
  const Eigen::LLT<typename Matrix::PlainObject> root(covariance);
  if (root.info() != Eigen::Success) return std::nullopt;
  return error.dot(root.solve(error));
}

struct Sums {
  double pose = 0, rotation = 0, position = 0;
  std::size_t within = 0;
};

// False: the covariance is not positive definite.
bool add(Sums& sums, const FilterError& e) {
  const Eigen::Matrix<double, 6, 6>& P = e.covariance->covariance;
  const auto pose = normalised_square(P, e.error);
  if (!pose) return false;
  sums.pose += *pose;
  sums.rotation += normalised_square(P.topLeftCorner<3, 3>().eval(), e.error.head<3>().eval()).value_or(0);
  sums.position += normalised_square(P.bottomRightCorner<3, 3>().eval(), e.error.tail<3>().eval()).value_or(0);
  sums.within += *pose >= kChiSquared6Low && *pose <= kChiSquared6High ? 1 : 0;
  return true;
}

}  // namespace

double chi_squared_quantile(double degrees, double z) {
  const double spread = 2 / (9 * degrees);
  return degrees * std::pow(1 - spread + z * std::sqrt(spread), 3);
}

std::vector<FilterError> filter_errors(std::span<const PosePair> pairs,
                                       std::span<const StampedCovariance> covariances) {
  const Pose T_map_truth = align_first(pairs).inverse();
  std::vector<FilterError> errors;
  errors.reserve(pairs.size());
  for (const PosePair& pair : pairs)
    errors.push_back({error_of(pair.estimate, T_map_truth * pair.truth), find_at(covariances, pair.stamp)});
  return errors;
}

std::optional<double> nees(const FilterError& error) {
  if (error.covariance == nullptr) return std::nullopt;
  return normalised_square(error.covariance->covariance, error.error);
}

Consistency consistency(std::span<const FilterError> errors) {
  Consistency result;
  Sums sums;
  for (const FilterError& error : errors.subspan(1)) {
    const bool counted = error.covariance != nullptr && add(sums, error);
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

InnovationConsistency consistency(std::span<const StampedInnovation> innovations) {
  InnovationConsistency result;
  double sum = 0, dimensions = 0;
  for (const StampedInnovation& i : innovations) {
    sum += i.nis;
    dimensions += i.dimensions;
    const bool within =
        i.nis >= chi_squared_quantile(i.dimensions, -kZ97_5) && i.nis <= chi_squared_quantile(i.dimensions, kZ97_5);
    result.share_within_95 += within ? 1.0 / static_cast<double>(innovations.size()) : 0.0;
  }
  result.updates = innovations.size();
  if (innovations.empty()) return result;
  result.nis_per_dimension = sum / dimensions;
  result.dimensions_mean = dimensions / static_cast<double>(result.updates);
  result.lower_95 = chi_squared_quantile(dimensions, -kZ97_5) / dimensions;
  result.upper_95 = chi_squared_quantile(dimensions, kZ97_5) / dimensions;
  return result;
}

}  // namespace lxd
