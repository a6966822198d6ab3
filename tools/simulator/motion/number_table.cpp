// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/motion/number_table.hpp"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <optional>
#include <string_view>

#include <fmt/format.h>

namespace lxd::sim {
namespace {

constexpr std::string_view kBlanks = " \t\r";

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = std::min(text.find_first_not_of(kBlanks), text.size());
  return text.substr(begin, text.find_last_not_of(kBlanks) + 1 - begin);
}

// Between commas every field counts, empty ones too; blanks are one separator, however many.
std::vector<std::string_view> fields_of(std::string_view line) {
  const bool commas = line.find(',') != line.npos;
  std::vector<std::string_view> fields;
  for (std::size_t at = 0; at <= line.size();) {
    const std::size_t end = std::min(line.find_first_of(commas ? "," : kBlanks, at), line.size());
    const std::string_view field = trimmed(line.substr(at, end - at));
    if (commas || !field.empty()) fields.push_back(field);
    at = end + 1;
  }
  return fields;
}

std::optional<double> number_of(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc{} || end != word.data() + word.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

// The cause when the line is not as it should be, else empty.
std::string read_row(std::string_view line, NumberTable::Row& row) {
  const std::vector<std::string_view> fields = fields_of(line);
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const std::optional<double> number = number_of(fields[i]);
    if (!number) return fmt::format("column {}: found '{}', wanted a finite number", i + 1, fields[i]);
    row.numbers.push_back(*number);
  }
  return "";
}

// A first line of words: its first is no number, not even one that is not finite.
bool is_header(std::string_view line) {
  constexpr std::string_view kNumberBegins = "+-.0123456789";
  const std::string_view first = fields_of(line).front();
  return first.empty() || kNumberBegins.find(first.front()) == kNumberBegins.npos;
}

}  // namespace

Result<NumberTable> load_numbers(const std::filesystem::path& file) {
  std::ifstream stream(file);
  if (!stream || std::filesystem::is_directory(file))
    return Error{fmt::format("{}: cannot be read: {}", file.string(), std::strerror(stream ? EISDIR : errno))};
  NumberTable table;
  std::string text;
  for (int number = 1; std::getline(stream, text); ++number) {
    const std::string_view line = trimmed(text);
    if (line.empty() || line.starts_with('#')) continue;
    if (table.rows.empty() && table.header.empty() && is_header(line)) {
      table.header = line;
      continue;
    }
    NumberTable::Row row{number, {}};
    if (const std::string wrong = read_row(line, row); !wrong.empty())
      return Error{fmt::format("{}:{}: {}", file.string(), number, wrong)};
    table.rows.push_back(std::move(row));
  }
  return table;
}

}  // namespace lxd::sim
