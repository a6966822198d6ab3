// SPDX-License-Identifier: Apache-2.0
// See nmea_fields.hpp.
#include "drivers/gnss/nmea_fields.hpp"

#include <charconv>
#include <chrono>

#include "rt/time.hpp"

namespace lxd {
namespace {

constexpr std::size_t kTypeChars = 3, kAddressChars = 5;
constexpr std::int64_t kMinute_s = 60, kHour_s = 3600;

bool digits_only(std::string_view text) {
  return !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos;
}

// Precondition: digits_only.
std::uint32_t two_digits(std::string_view text, std::size_t at) {
  return static_cast<std::uint32_t>((text[at] - '0') * 10 + (text[at + 1] - '0'));
}

// Decimal notation only: neither exponents nor the words that from_chars knows.
std::optional<double> decimal(std::string_view text) {
  if (text.find_first_not_of("-0123456789.") != std::string_view::npos) return std::nullopt;
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, std::chars_format::fixed);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

// ".25" or nothing, to ns; what is beyond is cut.
std::optional<std::int64_t> fraction_ns(std::string_view text) {
  if (text.empty()) return 0;
  if (text[0] != '.' || (text.size() > 1 && !digits_only(text.substr(1)))) return std::nullopt;
  std::int64_t ns = 0, weight = kNanosPerSecond / 10;
  for (const char c : text.substr(1)) {
    ns += (c - '0') * weight;
    weight /= 10;
  }
  return ns;
}

}  // namespace

NmeaFields::NmeaFields(std::string_view body) {
  for (std::size_t begin = 0; !overflow_;) {
    const std::size_t comma = body.find(',', begin);
    parts_[count_++] = body.substr(begin, comma - begin);
    if (comma == std::string_view::npos) return;
    begin = comma + 1;
    overflow_ = count_ == parts_.size();
  }
}

std::string_view NmeaFields::type() const {
  if (parts_[0].size() != kAddressChars || parts_[0][0] == 'P') return {};
  return parts_[0].substr(kAddressChars - kTypeChars);
}

std::optional<double> NmeaValues::number(std::size_t i, double low, double high) {
  if (fields_[i].empty()) return std::nullopt;
  const auto value = decimal(fields_[i]);
  if (value && *value >= low && *value <= high) return value;
  wrong_ = true;
  return std::nullopt;
}

std::optional<std::uint32_t> NmeaValues::count(std::size_t i, std::uint32_t high) {
  if (fields_[i].empty()) return std::nullopt;
  std::uint32_t value = 0;
  const std::string_view text = fields_[i];
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error == std::errc() && end == text.data() + text.size() && value <= high) return value;
  wrong_ = true;
  return std::nullopt;
}

std::optional<std::int64_t> NmeaValues::time_of_day_ns(std::size_t i) {
  constexpr std::size_t kWhole = 6;
  const std::string_view text = fields_[i];
  if (text.empty()) return std::nullopt;
  if (text.size() >= kWhole && digits_only(text.substr(0, kWhole))) {
    const std::uint32_t hours = two_digits(text, 0), minutes = two_digits(text, 2), seconds = two_digits(text, 4);
    const auto fraction = fraction_ns(text.substr(kWhole));
    if (hours < 24 && minutes < 60 && seconds <= 60 && fraction)
      return (hours * kHour_s + minutes * kMinute_s + seconds) * kNanosPerSecond + *fraction;
  }
  wrong_ = true;
  return std::nullopt;
}

std::optional<std::int64_t> NmeaValues::days(std::size_t i) {
  constexpr std::size_t kChars = 6;
  constexpr std::uint32_t kFirstYearOfLastCentury = 80;
  const std::string_view text = fields_[i];
  if (text.empty()) return std::nullopt;
  if (text.size() == kChars && digits_only(text)) {
    const std::uint32_t year = two_digits(text, 4);
    const std::chrono::year_month_day date{
        std::chrono::year{static_cast<int>(year) + (year >= kFirstYearOfLastCentury ? 1900 : 2000)},
        std::chrono::month{two_digits(text, 2)}, std::chrono::day{two_digits(text, 0)}};
    if (date.ok()) return std::chrono::sys_days{date}.time_since_epoch().count();
  }
  wrong_ = true;
  return std::nullopt;
}

std::optional<std::int64_t> NmeaValues::days_in_three(std::size_t day, std::size_t month, std::size_t year) {
  constexpr std::uint32_t kYearMin = 1980, kYearMax = 2200;
  const auto d = count(day, 31), m = count(month, 12), y = count(year, kYearMax);
  if (!d && !m && !y) return std::nullopt;
  if (d && m && y && *y >= kYearMin) {
    const std::chrono::year_month_day date{std::chrono::year{static_cast<int>(*y)}, std::chrono::month{*m},
                                           std::chrono::day{*d}};
    if (date.ok()) return std::chrono::sys_days{date}.time_since_epoch().count();
  }
  wrong_ = true;
  return std::nullopt;
}

std::optional<double> NmeaValues::angle_deg(std::size_t i, std::string_view hemispheres, double high_deg) {
  const std::string_view text = fields_[i], hemisphere = fields_[i + 1];
  if (text.empty() && hemisphere.empty()) return std::nullopt;
  const std::size_t degree_digits = high_deg > 90 ? 3 : 2;
  if (text.size() >= degree_digits + 2 && digits_only(text.substr(0, degree_digits)) && hemisphere.size() == 1) {
    std::uint32_t degrees = 0;
    std::from_chars(text.data(), text.data() + degree_digits, degrees);
    const auto minutes = decimal(text.substr(degree_digits));
    const double angle = degrees + (minutes ? *minutes : 0) / 60;
    if (minutes && *minutes >= 0 && *minutes < 60 && angle <= high_deg) {
      if (hemisphere[0] == hemispheres[0]) return angle;
      if (hemisphere[0] == hemispheres[1]) return -angle;
    }
  }
  wrong_ = true;
  return std::nullopt;
}

}  // namespace lxd
