// SPDX-License-Identifier: Apache-2.0
// Uniform quintic B-spline basis and its cumulative form, as polynomials of the part u = 0 .. 1 of a segment.
#pragma once

#include <array>
#include <cstddef>

namespace lxd::sim {

inline constexpr int kSplineOrder = 6;
using SplineWeights = std::array<double, kSplineOrder>;

namespace spline_detail {

// Coefficients of u^0 .. u^5 of the six pieces, times 5!; de Boor, "A Practical Guide to Splines", chapter IX.
inline constexpr double kFactorial = 120;
inline constexpr std::array<SplineWeights, kSplineOrder> kPieces{{
    {1, -5, 10, -10, 5, -1},
    {26, -50, 20, 20, -20, 5},
    {66, 0, -60, 0, 30, -10},
    {26, 50, 20, -20, -20, 10},
    {1, 5, 10, 10, 5, -5},
    {0, 0, 0, 0, 0, 1},
}};

using Table = std::array<std::array<SplineWeights, kSplineOrder>, 3>;  // of derivative, of piece, of power

// Piece j of the result is the sum of the pieces j .. 5 (cumulative) or piece j alone; then its two derivatives.
constexpr Table table(bool cumulative) {
  Table table{};
  for (std::size_t j = 0; j < kSplineOrder; ++j)
    for (std::size_t k = j; k < (cumulative ? kSplineOrder : j + 1); ++k)
      for (std::size_t power = 0; power < kSplineOrder; ++power) table[0][j][power] += kPieces[k][power] / kFactorial;
  for (std::size_t d = 1; d < table.size(); ++d)
    for (std::size_t j = 0; j < kSplineOrder; ++j)
      for (std::size_t power = 0; power + 1 < kSplineOrder; ++power)
        table[d][j][power] = table[d - 1][j][power + 1] * static_cast<double>(power + 1);
  return table;
}

inline constexpr Table kBasis = table(false);
inline constexpr Table kCumulative = table(true);

inline SplineWeights weights(const std::array<SplineWeights, kSplineOrder>& pieces, double u) {
  SplineWeights weights;
  for (std::size_t j = 0; j < kSplineOrder; ++j) {
    double sum = pieces[j][kSplineOrder - 1];
    for (std::size_t power = kSplineOrder - 1; power-- > 0;) sum = sum * u + pieces[j][power];
    weights[j] = sum;
  }
  return weights;
}

}  // namespace spline_detail

// The weights of the six control points that act, or their derivative (0, 1, 2) by u.
inline SplineWeights spline_weights(double u, int derivative = 0) {
  return spline_detail::weights(spline_detail::kBasis[static_cast<std::size_t>(derivative)], u);
}

// Weight j is that of the difference of control points j and j - 1; weight 0 is the constant 1 (and its derivative 0).
inline SplineWeights cumulative_weights(double u, int derivative = 0) {
  return spline_detail::weights(spline_detail::kCumulative[static_cast<std::size_t>(derivative)], u);
}

}  // namespace lxd::sim
