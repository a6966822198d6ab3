// SPDX-License-Identifier: Apache-2.0
// Reading of TUM paths, covariance and innovation files: every line checked, every error with its place.
#include "tools/evaluate/tum_file.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <functional>
#include <string>

#include <fmt/format.h>

namespace lxd {
namespace {

constexpr double kSecondsMax = 9.2e9;          // int64 nanoseconds end here
constexpr double kQuaternionTolerance = 1e-2;  // of the norm: files with few decimals are still welcome
constexpr std::size_t kTumColumns = 8;
constexpr std::size_t kCovarianceColumns = 22;
constexpr std::size_t kInnovationColumns = 3;
constexpr double kDimensionsMax = 1000;

std::vector<std::string_view> split(std::string_view line) {
  constexpr std::string_view kBlanks = " \t\r";
  std::vector<std::string_view> words;
  for (std::size_t at = line.find_first_not_of(kBlanks); at != line.npos; at = line.find_first_not_of(kBlanks, at)) {
    const std::size_t end = std::min(line.find_first_of(kBlanks, at), line.size());
    words.push_back(line.substr(at, end - at));
    at = end;
  }
  return words;
}

std::optional<double> parse_number(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc{} || end != word.data() + word.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

using Numbers = std::vector<double>;  // what follows the stamp
// The cause when the line is not as it should be, else empty.
using LineReader = std::function<std::string(RigTime, const Numbers&)>;

std::string read_line(std::string_view line, std::size_t columns, const LineReader& read) {
  const std::vector<std::string_view> words = split(line);
  if (words.empty() || words[0].starts_with('#')) return "";
  if (words.size() != columns) return fmt::format("found {} columns, wanted {}", words.size(), columns);
  const std::optional<RigTime> stamp = parse_stamp(words[0]);
  if (!stamp) return fmt::format("found '{}', wanted a time in seconds", words[0]);
  Numbers numbers;
  for (std::size_t i = 1; i < words.size(); ++i) {
    const std::optional<double> number = parse_number(words[i]);
    if (!number) return fmt::format("column {}: found '{}', wanted a finite number", i + 1, words[i]);
    numbers.push_back(*number);
  }
  return read(*stamp, numbers);
}

Status read_lines(const std::filesystem::path& path, std::size_t columns, const LineReader& read) {
  std::ifstream file(path);
  if (!file) return Error{fmt::format("{}: cannot be read: {}", path.string(), std::strerror(errno))};
  std::string line;
  for (int number = 1; std::getline(file, line); ++number)
    if (const std::string wrong = read_line(line, columns, read); !wrong.empty())
      return Error{fmt::format("{}:{}: {}", path.string(), number, wrong)};
  return success();
}

template <typename Stamped>
std::string check_order(const std::vector<Stamped>& before, RigTime stamp) {
  if (before.empty() || before.back().stamp < stamp) return "";
  return fmt::format("found time {:.9f} s, wanted later than {:.9f} s before it", stamp.seconds(),
                     before.back().stamp.seconds());
}

// "": the pose was appended.
std::string append_pose(Trajectory& path, RigTime stamp, const Numbers& n) {
  if (const std::string wrong = check_order(path.poses, stamp); !wrong.empty()) return wrong;
  const Eigen::Quaterniond q(n[6], n[3], n[4], n[5]);
  const bool oriented = q.norm() != 0;
  if (oriented && std::abs(q.norm() - 1) > kQuaternionTolerance)
    return fmt::format("found a quaternion of norm {:.4f}, wanted 1", q.norm());
  if (path.poses.empty()) path.oriented = oriented;
  if (oriented != path.oriented) return "found zero and unit quaternions in one file, wanted one kind";
  StampedPose pose{stamp, {}};
  if (oriented) pose.T.R = q.normalized().toRotationMatrix();
  pose.T.p = {n[0], n[1], n[2]};
  path.poses.push_back(pose);
  return "";
}

Eigen::Matrix<double, 6, 6> symmetric(const Numbers& upper) {
  Eigen::Matrix<double, 6, 6> matrix;
  std::size_t next = 0;
  for (int row = 0; row < 6; ++row)
    for (int column = row; column < 6; ++column) matrix(row, column) = matrix(column, row) = upper[next++];
  return matrix;
}

std::string append_innovation(std::vector<StampedInnovation>& innovations, RigTime stamp, const Numbers& n) {
  if (const std::string wrong = check_order(innovations, stamp); !wrong.empty()) return wrong;
  if (!(n[0] >= 0)) return fmt::format("found the NIS {}, wanted 0 or more", n[0]);
  if (!(n[1] >= 1 && n[1] <= kDimensionsMax && n[1] == std::floor(n[1])))
    return fmt::format("found {} dimensions, wanted a whole number from 1 to {}", n[1], kDimensionsMax);
  innovations.push_back({stamp, n[0], static_cast<int>(n[1])});
  return "";
}

// "123" or "123.456" to nanoseconds without rounding through a double; nothing for any other notation.
std::optional<std::int64_t> parse_decimal(std::string_view text) {
  const bool negative = text.starts_with('-');
  if (negative) text.remove_prefix(1);
  const std::size_t point = std::min(text.find('.'), text.size());
  std::string digits(text.substr(0, point));
  std::string decimals(text.substr(std::min(point + 1, text.size())));
  constexpr std::size_t kNanoDigits = 9;
  constexpr std::size_t kSecondDigitsMax = 9 + 1;
  if (digits.empty() || digits.size() > kSecondDigitsMax) return std::nullopt;
  if ((digits + decimals).find_first_not_of("0123456789") != std::string::npos) return std::nullopt;
  const bool round_up = decimals.size() > kNanoDigits && decimals[kNanoDigits] >= '5';
  decimals.resize(kNanoDigits, '0');
  const std::string text_ns = digits + decimals;
  std::uint64_t ns = 0;
  const auto [end, error] = std::from_chars(text_ns.data(), text_ns.data() + text_ns.size(), ns);
  if (error != std::errc{} || ns >= static_cast<std::uint64_t>(kSecondsMax * 1e9)) return std::nullopt;
  const std::int64_t magnitude = static_cast<std::int64_t>(ns) + (round_up ? 1 : 0);
  return negative ? -magnitude : magnitude;
}

}  // namespace

std::optional<RigTime> parse_stamp(std::string_view text) {
  if (const auto ns = parse_decimal(text)) return RigTime::from_ns(*ns);
  const auto seconds = parse_number(text);
  if (!seconds || std::abs(*seconds) >= kSecondsMax) return std::nullopt;
  return RigTime::from_seconds(*seconds);
}

Result<Trajectory> load_tum(const std::filesystem::path& path) {
  Trajectory trajectory;
  const Status read = read_lines(path, kTumColumns, [&](RigTime stamp, const Numbers& numbers) {
    return append_pose(trajectory, stamp, numbers);
  });
  if (!read.ok()) return read.error();
  if (trajectory.poses.empty()) return Error{fmt::format("{}: found no pose, wanted TUM lines", path.string())};
  return trajectory;
}

Result<std::vector<StampedCovariance>> load_covariances(const std::filesystem::path& path) {
  std::vector<StampedCovariance> covariances;
  const Status read = read_lines(path, kCovarianceColumns, [&](RigTime stamp, const Numbers& numbers) {
    const std::string wrong = check_order(covariances, stamp);
    if (wrong.empty()) covariances.push_back({stamp, symmetric(numbers)});
    return wrong;
  });
  if (!read.ok()) return read.error();
  return covariances;
}

Result<std::vector<StampedInnovation>> load_innovations(const std::filesystem::path& path) {
  std::vector<StampedInnovation> innovations;
  const Status read = read_lines(path, kInnovationColumns, [&](RigTime stamp, const Numbers& numbers) {
    return append_innovation(innovations, stamp, numbers);
  });
  if (!read.ok()) return read.error();
  return innovations;
}

}  // namespace lxd
