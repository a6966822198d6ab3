// SPDX-License-Identifier: Apache-2.0
#include "drivers/imu/vectornav_ascii_parser.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

#include "drivers/imu/crc16.hpp"

namespace lxd {
namespace {

constexpr std::size_t kAddressChars = 5;
constexpr std::string_view kLineEnd = "\r\n";

std::string_view text_of(std::span<const std::uint8_t> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

// Upper case only: a lower-case digit is a flipped bit.
std::optional<unsigned> hex_number(std::string_view digits) {
  if (digits.find_first_not_of("0123456789ABCDEF") != std::string_view::npos) return std::nullopt;
  unsigned value = 0;
  std::from_chars(digits.data(), digits.data() + digits.size(), value, 16);
  return value;
}

bool check_holds(std::string_view body, std::string_view digits) {
  const auto said = hex_number(digits);
  if (digits.size() == 2) return said == vectornav_ascii_checksum(body);
  return said == crc16({reinterpret_cast<const std::uint8_t*>(body.data()), body.size()});
}

// "+00.1234"; neither exponents nor words.
std::optional<double> number_of(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  if (text.find_first_not_of("-0123456789.") != std::string_view::npos) return std::nullopt;
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, std::chars_format::fixed);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

using Numbers = std::array<double, kVectorNavNumbersMax>;

// The first `count` fields of ",a,b,c"; none: there are not as many, or one is no number.
std::optional<Numbers> numbers_of(std::string_view fields, std::size_t count) {
  Numbers numbers{};
  for (std::size_t i = 0; i < count; ++i) {
    if (!fields.starts_with(',')) return std::nullopt;
    fields.remove_prefix(1);
    const std::string_view field = fields.substr(0, fields.find(','));
    const auto value = number_of(field);
    if (!value) return std::nullopt;
    numbers[i] = *value;
    fields.remove_prefix(field.size());
  }
  return numbers;
}

Eigen::Vector3d vector_at(const Numbers& numbers, std::size_t first) {
  return {numbers[first], numbers[first + 1], numbers[first + 2]};
}

}  // namespace

bool VectorNavAsciiParser::next(ImuSample& sample) {
  while (const std::size_t bytes = find_line()) {
    const std::string_view line = text_of(buffer_.view().first(bytes));
    const bool is_sample = read(line.substr(1, line.rfind('*') - 1), sample);
    ++counts_.frames;
    counts_.bytes_accepted += bytes;
    buffer_.drop(bytes);
    if (is_sample) return true;
  }
  return false;
}

std::size_t VectorNavAsciiParser::find_line() {
  for (;;) {
    const std::string_view all = text_of(buffer_.view());
    skip(std::min(all.find('$'), all.size()));
    const std::string_view line = text_of(buffer_.view());
    if (line.empty()) return 0;
    const std::size_t end = line.find_first_of("$\n", 1);
    if (std::min(end, line.size()) >= kVectorNavLineMax) {
      refuse(counts_.too_long);
    } else if (end == std::string_view::npos) {
      return 0;
    } else if (line[end] == '$') {
      refuse(counts_.broken_line);
    } else if (line_is_sound(line.substr(0, end + 1))) {
      return end + 1;
    }
  }
}

bool VectorNavAsciiParser::line_is_sound(std::string_view line) {
  const std::size_t star = line.rfind('*');
  const std::size_t checked = star == std::string_view::npos ? line.size() : star + 1;
  const std::string_view check = line.substr(checked);
  const bool whole = check.ends_with(kLineEnd);
  const std::string_view digits = whole ? check.substr(0, check.size() - kLineEnd.size()) : std::string_view();
  if (digits.size() != 2 && digits.size() != 4) {
    refuse(counts_.broken_line);
    return false;
  }
  if (check_holds(line.substr(1, star - 1), digits)) return true;
  refuse(counts_.bad_checksum);
  return false;
}

void VectorNavAsciiParser::refuse(std::uint64_t& cause) {
  ++cause;
  skip(1);
}

void VectorNavAsciiParser::skip(std::size_t bytes) {
  counts_.bytes_skipped += bytes;
  buffer_.drop(bytes);
}

bool VectorNavAsciiParser::read(std::string_view body, ImuSample& sample) {
  const std::string_view address = body.substr(0, std::min(body.find(','), kAddressChars + 1));
  const auto* const sentence = std::ranges::find(kVectorNavSentences, address, &VectorNavSentence::address);
  if (sentence == kVectorNavSentences.end()) {
    ++(address == kVectorNavError ? counts_.sensor_error : counts_.no_imu_fields);
    return false;
  }
  const auto numbers = numbers_of(body.substr(address.size()), sentence->numbers);
  if (!numbers) {
    ++counts_.bad_field;
    return false;
  }
  sample = {std::nullopt, buffer_.received(), buffer_.sent(0), vector_at(*numbers, sentence->gyro),
            vector_at(*numbers, sentence->accel)};
  return true;
}

}  // namespace lxd
