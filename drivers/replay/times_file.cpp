// SPDX-License-Identifier: Apache-2.0
// See times_file.hpp.
#include "drivers/replay/times_file.hpp"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <fstream>
#include <string>

#include <fmt/format.h>

namespace lxd {
namespace {

// Half of what int64 nanoseconds hold, so that differences cannot overflow.
constexpr double kFarthest_s = 4.6e9;
constexpr std::size_t kNanoDigits = 9;

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\r\n";
  const std::size_t begin = text.find_first_not_of(kBlanks);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kBlanks) - begin + 1);
}

template <typename Number>
std::optional<Number> whole_number(std::string_view text) {
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || text.empty()) return std::nullopt;
  return value;
}

bool digits_only(std::string_view text) {
  return std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

// "335337762" after the point, any number of digits; the ones beyond nanoseconds are cut.
std::optional<std::int64_t> fraction_ns(std::string_view digits) {
  if (!digits_only(digits)) return std::nullopt;
  std::string nine(digits.substr(0, kNanoDigits));
  nine.resize(kNanoDigits, '0');
  return whole_number<std::int64_t>(nine);
}

// "12.34", exactly; none when it has another form.
std::optional<RigTime> parse_decimal(std::string_view text) {
  const bool negative = text.starts_with('-');
  const std::string_view digits = negative ? text.substr(1) : text;
  const std::size_t point = std::min(digits.find('.'), digits.size());
  const std::string_view whole = digits.substr(0, point);
  if (!digits_only(whole)) return std::nullopt;
  const auto seconds = whole_number<std::int64_t>(whole);
  const auto nanos = point < digits.size() ? fraction_ns(digits.substr(point + 1)) : 0;
  if (!seconds || !nanos || static_cast<double>(*seconds) > kFarthest_s) return std::nullopt;
  const std::int64_t ns = *seconds * kNanosPerSecond + *nanos;
  return RigTime::from_ns(negative ? -ns : ns);
}

template <typename Parse>
Result<StampLines> read_lines(const std::filesystem::path& path, const char* wanted, Parse parse) {
  std::ifstream file(path);
  std::error_code ignored;  // a folder opens like a file, and reads as an empty one
  if (!file || std::filesystem::is_directory(path, ignored))
    return Error{fmt::format("{}: cannot be read, wanted a file of time stamps", path.string())};
  StampLines stamps;
  std::size_t used = 0;
  for (std::string line; std::getline(file, line);) {
    const std::string_view text = trimmed(line);
    stamps.push_back(text.empty() ? std::nullopt : parse(text));
    if (!text.empty() && !stamps.back()) {
      constexpr std::size_t kLongestExcerpt = 40;
      return Error{fmt::format("{}: line {}: found \"{}\", wanted {}", path.string(), stamps.size(),
                               text.substr(0, kLongestExcerpt), wanted)};
    }
    if (stamps.back()) used = stamps.size();
  }
  if (used == 0) return Error{fmt::format("{}: found no time stamp, wanted one a scan", path.string())};
  stamps.resize(used);
  return stamps;
}

}  // namespace

std::optional<RigTime> parse_seconds(std::string_view text) {
  if (const auto exact = parse_decimal(text)) return exact;
  const auto seconds = whole_number<double>(text);
  if (!seconds || !(std::abs(*seconds) <= kFarthest_s)) return std::nullopt;
  return RigTime::from_seconds(*seconds);
}

std::optional<RigTime> parse_date(std::string_view text) {
  constexpr std::string_view kForm = "dddd-dd-dd dd:dd:dd";
  if (text.size() < kForm.size()) return std::nullopt;
  for (std::size_t i = 0; i < kForm.size(); ++i) {
    const bool digit = text[i] >= '0' && text[i] <= '9';
    if (kForm[i] == 'd' ? !digit : text[i] != kForm[i]) return std::nullopt;
  }
  const auto part = [&](std::size_t begin, std::size_t count) { return *whole_number<int>(text.substr(begin, count)); };
  const std::chrono::year_month_day date{std::chrono::year{part(0, 4)},
                                         std::chrono::month{static_cast<unsigned>(part(5, 2))},
                                         std::chrono::day{static_cast<unsigned>(part(8, 2))}};
  const int hour = part(11, 2), minute = part(14, 2), second = part(17, 2);
  if (!date.ok() || hour > 23 || minute > 59 || second > 59) return std::nullopt;
  const std::string_view rest = text.substr(kForm.size());
  if (!rest.empty() && rest.front() != '.') return std::nullopt;
  const auto nanos = rest.empty() ? 0 : fraction_ns(rest.substr(1));
  if (!nanos) return std::nullopt;
  const std::chrono::seconds since_1970 = std::chrono::sys_days{date}.time_since_epoch() + std::chrono::hours{hour} +
                                          std::chrono::minutes{minute} + std::chrono::seconds{second};
  if (std::abs(static_cast<double>(since_1970.count())) > kFarthest_s) return std::nullopt;
  return RigTime::from_ns(since_1970.count() * kNanosPerSecond + *nanos);
}

Result<StampLines> read_seconds_file(const std::filesystem::path& path) {
  return read_lines(path, "seconds, e.g. 12.345678901", parse_seconds);
}

Result<StampLines> read_dates_file(const std::filesystem::path& path) {
  return read_lines(path, "a date, e.g. 2011-09-26 13:04:32.335337762", parse_date);
}

Duration median_period(const StampLines& stamps) {
  std::vector<Duration> periods;
  for (std::size_t i = 1; i < stamps.size(); ++i) {
    if (stamps[i] && stamps[i - 1] && *stamps[i] > *stamps[i - 1]) periods.push_back(*stamps[i] - *stamps[i - 1]);
  }
  if (periods.empty()) return {};
  const auto middle = periods.begin() + static_cast<std::ptrdiff_t>(periods.size() / 2);
  std::nth_element(periods.begin(), middle, periods.end());
  return *middle;
}

}  // namespace lxd
