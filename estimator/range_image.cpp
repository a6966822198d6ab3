// SPDX-License-Identifier: Apache-2.0
#include "estimator/range_image.hpp"

#include <algorithm>
#include <cmath>

namespace lxd {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;
constexpr float kFillMax_rows = 3.5f;  // beams further apart (5 degrees) have a hole between them

// Abramowitz and Stegun, Handbook of Mathematical Functions, 4.4.49: error at most 1e-5 rad for 0 <= t <= 1.
float arctan_of_unit(float t) {
  const float s = t * t;
  return t * (0.9998660f + s * (-0.3302995f + s * (0.1801410f + s * (-0.0851330f + s * 0.0208351f))));
}

float angle_of(float y, float x) {
  const float ax = std::abs(x), ay = std::abs(y);
  const float big = std::max(ax, ay);
  if (!(big > 0)) return 0;
  float a = arctan_of_unit(std::min(ax, ay) / big);
  if (ay > ax) a = kPi / 2 - a;
  if (x < 0) a = kPi - a;
  return y < 0 ? -a : a;
}

// The centre of column or row i is at i.
float column_of(float azimuth_rad) { return (azimuth_rad + kPi) / RangeImage::kStep_rad; }
float row_of(float elevation_rad) { return (elevation_rad + kPi / 2) / RangeImage::kStep_rad - 0.5f; }

}  // namespace

Spherical to_spherical(const Eigen::Vector3f& p) {
  const float flat = std::sqrt(p.x() * p.x() + p.y() * p.y());
  return {angle_of(p.y(), p.x()), angle_of(p.z(), flat), p.norm()};
}

RangeImage::RangeImage(Arena& arena)
    : bins_(arena.take<Bin>("range image bins", kColumns * kRows)),
      inverse_ranges_(arena.take<float>("range image", kColumns * kRows)) {}

void RangeImage::clear() {
  std::fill(bins_.begin(), bins_.end(), Bin{});
  std::fill(inverse_ranges_.begin(), inverse_ranges_.end(), 0.0f);
  row_begin_ = kRows;
  row_end_ = 0;
}

void RangeImage::add(const Eigen::Vector3f& p) {
  const Spherical s = to_spherical(p);
  const float height = row_of(s.elevation_rad);
  const int row = std::clamp(static_cast<int>(height + 0.5f), 0, kRows - 1);
  const int column = static_cast<int>(column_of(s.azimuth_rad) + 0.5f) % kColumns;
  Bin& bin = bins_[static_cast<std::size_t>(column * kRows + row)];
  bin.inverse_range += 1.0f / s.range_m;
  bin.elevation += height;
  ++bin.count;
  row_begin_ = std::min(row_begin_, row);
  row_end_ = std::max(row_end_, row + 1);
}

void RangeImage::finish() {
  for (int column = 0; column < kColumns; ++column) fill_column(column);
}

// From beam to beam upwards: the rows that lie between two of them, and the row of each.
void RangeImage::fill_column(int column) {
  const auto begin = static_cast<std::size_t>(column * kRows);
  const auto bins = bins_.subspan(begin, kRows);
  const auto out = inverse_ranges_.subspan(begin, kRows);
  float last_height = -kFillMax_rows - 1, last_value = 0;
  for (int row = row_begin_; row < row_end_; ++row) {
    const auto i = static_cast<std::size_t>(row);
    if (bins[i].count == 0) continue;
    const float n = static_cast<float>(bins[i].count);
    const float height = bins[i].elevation / n, value = bins[i].inverse_range / n;
    out[i] = value;  // unless the next beam, or this one with the last, says it better
    if (height - last_height <= kFillMax_rows)
      for (int r = static_cast<int>(std::ceil(last_height)); static_cast<float>(r) <= height; ++r) {
        const float b = (static_cast<float>(r) - last_height) / (height - last_height);
        out[static_cast<std::size_t>(r)] = last_value + b * (value - last_value);
      }
    last_height = height;
    last_value = value;
  }
}

bool RangeImage::look(float azimuth_rad, float elevation_rad, Look& out) const {
  float c = column_of(azimuth_rad);
  c += c < 0 ? kColumns : 0;
  const float r = row_of(elevation_rad);
  const int c0 = static_cast<int>(c), r0 = static_cast<int>(r);
  if (r < 0 || r0 + 1 >= kRows) return false;
  const float bc = c - static_cast<float>(c0), br = r - static_cast<float>(r0);
  const float* const left = &inverse_ranges_[static_cast<std::size_t>(c0 % kColumns * kRows + r0)];
  const float* const right = &inverse_ranges_[static_cast<std::size_t>((c0 + 1) % kColumns * kRows + r0)];
  if (!(left[0] > 0 && left[1] > 0 && right[0] > 0 && right[1] > 0)) return false;
  const float low = left[0] + bc * (right[0] - left[0]), high = left[1] + bc * (right[1] - left[1]);
  out.inverse_range = low + br * (high - low);
  out.d_elevation = (high - low) / kStep_rad;
  out.d_azimuth = ((1 - br) * (right[0] - left[0]) + br * (right[1] - left[1])) / kStep_rad;
  return true;
}

}  // namespace lxd
