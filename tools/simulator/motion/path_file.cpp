// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/motion/path_file.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include <GeographicLib/LocalCartesian.hpp>
#include <fmt/format.h>

#include "tools/simulator/motion/number_table.hpp"

namespace lxd::sim {
namespace {

using Eigen::AngleAxisd;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using Numbers = std::vector<double>;

constexpr std::size_t kPosesMin = 10;
constexpr double kQuaternionTolerance = 1e-2;  // of the norm: files with few decimals are still welcome
constexpr double kNano = 1e-9;

// Reads one row. The cause when the row is not as it should be, else empty; t may be of any epoch.
using RowReader = std::function<std::string(const Numbers&, PathSample&)>;

std::string read_tum(const Numbers& n, PathSample& sample) {
  sample = {n[0], {n[1], n[2], n[3]}, Quaterniond(n[7], n[4], n[5], n[6])};
  const double norm = sample.q.norm();
  if (std::abs(norm - 1) > kQuaternionTolerance)
    return fmt::format("found a quaternion of norm {:.4f}, wanted 1", norm);
  sample.q.normalize();
  return "";
}

// `rostopic echo -p` of the tracker's pose: arrival, number, stamp in ns, position; the quaternion says nothing.
std::string read_ntu_viral(const Numbers& n, PathSample& sample) {
  sample = {n[2] * kNano, {n[3], n[4], n[5]}, Quaterniond::Identity()};
  return "";
}

// KITTI's OXTS: x forward, y left, z up; the yaw is 0 towards the east and grows to the left.
class OxtsReader {
 public:
  std::string operator()(const Numbers& n, PathSample& sample) {
    constexpr double kLatitudeMax_deg = 90, kLongitudeMax_deg = 360;
    if (std::abs(n[1]) > kLatitudeMax_deg || std::abs(n[2]) > kLongitudeMax_deg)
      return fmt::format("found latitude {} and longitude {}, wanted degrees of the Earth", n[1], n[2]);
    if (!started_) frame_.Reset(n[1], n[2], n[3]);
    started_ = true;
    sample.t_s = n[0];
    frame_.Forward(n[1], n[2], n[3], sample.p.x(), sample.p.y(), sample.p.z());
    sample.q =
        AngleAxisd(n[6], Vector3d::UnitZ()) * AngleAxisd(n[5], Vector3d::UnitY()) * AngleAxisd(n[4], Vector3d::UnitX());
    return "";
  }

 private:
  GeographicLib::LocalCartesian frame_;
  bool started_ = false;
};

struct Format {
  std::string_view name;
  std::string_view header_begins;  // how its files are known; empty: no header
  std::size_t columns_min, columns_max;
  bool oriented;
};

constexpr std::array<Format, 3> kFormats{{
    {"tum", "", 8, 8, true},
    {"ntu_viral", "%time,field.header", 6, 10, false},
    {"oxts", "t,lat", 7, 18, true},
}};

RowReader reader_of(const Format& format) {
  if (format.name == "tum") return read_tum;
  if (format.name == "ntu_viral") return read_ntu_viral;
  return OxtsReader();
}

Result<const Format*> format_of(const std::filesystem::path& file, const NumberTable& table, std::string_view wanted) {
  for (const Format& format : kFormats) {
    const bool known = format.header_begins.empty() ? table.header.empty() && !table.rows.empty() &&
                                                          table.rows[0].numbers.size() == format.columns_min
                                                    : table.header.starts_with(format.header_begins);
    if (wanted == format.name || (wanted == "auto" && known)) return &format;
  }
  return Error{
      fmt::format("{}: found a path of no known format, wanted TUM (t x y z qx qy qz qw), NTU-VIRAL's tracker "
                  "as rostopic writes it, or KITTI's OXTS (t,lat_deg,lon_deg,alt_m,roll,pitch,yaw)",
                  file.string())};
}

std::string check(const Format& format, const NumberTable::Row& row) {
  const std::size_t found = row.numbers.size();
  if (found >= format.columns_min && found <= format.columns_max) return "";
  return format.columns_min == format.columns_max
             ? fmt::format("found {} columns, wanted {}", found, format.columns_min)
             : fmt::format("found {} columns, wanted {} to {}", found, format.columns_min, format.columns_max);
}

// "": the row's pose was appended.
std::string append(const Format& format, const RowReader& read, const NumberTable::Row& row, RecordedPath& path) {
  if (std::string wrong = check(format, row); !wrong.empty()) return wrong;
  PathSample sample;
  if (std::string wrong = read(row.numbers, sample); !wrong.empty()) return wrong;
  if (!path.samples.empty() && !(sample.t_s > path.samples.back().t_s))
    return fmt::format("found time {:.6f} s, wanted later than {:.6f} s before it", sample.t_s,
                       path.samples.back().t_s);
  path.samples.push_back(sample);
  return "";
}

}  // namespace

Result<RecordedPath> load_path(const std::filesystem::path& file, std::string_view format) {
  const Result<NumberTable> table = load_numbers(file);
  if (!table) return table.error();
  const Result<const Format*> known = format_of(file, table.value(), format);
  if (!known) return known.error();
  RecordedPath path{known.value()->name, {}, known.value()->oriented};
  const RowReader read = reader_of(*known.value());
  for (const NumberTable::Row& row : table.value().rows)
    if (const std::string wrong = append(*known.value(), read, row, path); !wrong.empty())
      return Error{fmt::format("{}:{}: {}", file.string(), row.line, wrong)};
  if (path.samples.size() < kPosesMin)
    return Error{fmt::format("{}: found {} poses, wanted at least {}", file.string(), path.samples.size(), kPosesMin)};
  const double begin_s = path.samples.front().t_s;
  for (PathSample& sample : path.samples) sample.t_s -= begin_s;
  return path;
}

void level(RecordedPath& path) {
  constexpr double kRidge_m2 = 0.05;  // a sample's: across a straight path the slope is not to be seen, and is left
  const Vector3d origin = path.samples.front().p;
  Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
  Vector3d b = Vector3d::Zero();
  for (const PathSample& sample : path.samples) {
    const Vector3d row(sample.p.x() - origin.x(), sample.p.y() - origin.y(), 1);
    A += row * row.transpose() + kRidge_m2 * Vector3d(1, 1, 0).asDiagonal().toDenseMatrix();
    b += row * (sample.p.z() - origin.z());
  }
  const Vector3d plane = A.ldlt().solve(b);
  const Quaterniond turn = Quaterniond::FromTwoVectors(Vector3d(-plane.x(), -plane.y(), 1), Vector3d::UnitZ());
  for (PathSample& sample : path.samples) {
    sample.p = origin + turn * (sample.p - origin);
    sample.q = turn * sample.q;
  }
}

}  // namespace lxd::sim
