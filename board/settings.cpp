// SPDX-License-Identifier: Apache-2.0
#include "board/settings.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "board/nearest_names.hpp"
#include "board/settings_table.hpp"

namespace lxd {
namespace {

const SettingRow* find_row(std::string_view key) {
  const auto rows = setting_rows();
  const auto row = std::ranges::find(rows, key, &SettingRow::key);
  return row == rows.end() ? nullptr : &*row;
}

std::optional<double> number_of(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool whole = error == std::errc{} && end == text.data() + text.size();
  return whole && std::isfinite(value) ? std::optional(value) : std::nullopt;
}

std::string_view text_of(bool value) { return value ? "true" : "false"; }

std::string text_of(const SettingRow::Field& field) {
  if (const auto* flag = std::get_if<bool*>(&field)) return std::string(text_of(**flag));
  if (const auto* whole = std::get_if<int*>(&field)) return fmt::format("{}", **whole);
  return fmt::format("{}", *std::get<double*>(field));
}

std::string wanted(const SettingRow& row, const SettingRow::Field& field) {
  if (std::holds_alternative<bool*>(field)) return "true or false";
  const bool whole = std::holds_alternative<int*>(field);
  return fmt::format("{} in {} .. {}{}{}", whole ? "a whole number" : "a number", row.low, row.high,
                     row.unit.empty() ? "" : " ", row.unit);
}

bool assign(const SettingRow& row, const SettingRow::Field& field, std::string_view text) {
  if (const auto* flag = std::get_if<bool*>(&field)) {
    **flag = text == "true";
    return text == "true" || text == "false";
  }
  const auto value = number_of(text);
  if (!value || *value < row.low || *value > row.high) return false;
  if (const auto* real = std::get_if<double*>(&field)) {
    **real = *value;
    return true;
  }
  *std::get<int*>(field) = static_cast<int>(*value);
  return *value == std::floor(*value);
}

Error unknown_key(std::string_view key) {
  std::vector<std::string_view> names;
  for (const SettingRow& row : setting_rows()) names.push_back(row.key);
  const std::string hint = did_you_mean(key, names);
  return Error{
      fmt::format("{}: unknown setting{}", key, hint.empty() ? "; 'check --settings' lists what there is" : hint)};
}

}  // namespace

Status set(Settings& settings, std::string_view key, std::string_view value) {
  const SettingRow* const row = find_row(key);
  if (row == nullptr) return unknown_key(key);
  Settings changed = settings;
  const SettingRow::Field field = row->field(changed);
  if (!assign(*row, field, value))
    return Error{fmt::format("{}: found '{}', wanted {}", key, value, wanted(*row, field))};
  settings = changed;
  return success();
}

Result<SettingChoice> parse_choice(std::string_view text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string_view::npos || equals == 0) {
    return Error{fmt::format("--set: found '{}', wanted key=value", text)};
  }
  return SettingChoice{std::string(text.substr(0, equals)), std::string(text.substr(equals + 1))};
}

std::vector<SettingChoice> choices_of(const Settings& settings) {
  Settings copy = settings;
  std::vector<SettingChoice> choices;
  for (const SettingRow& row : setting_rows()) choices.push_back({std::string(row.key), text_of(row.field(copy))});
  return choices;
}

std::string settings_reference() {
  Settings defaults;
  std::string text;
  for (const SettingRow& row : setting_rows()) {
    const SettingRow::Field field = row.field(defaults);
    text += fmt::format("{:<40} {:>8}  {}; {}\n", row.key, text_of(field), row.meaning, wanted(row, field));
  }
  return text;
}

std::string comment_of(std::string_view key) {
  const SettingRow* const row = find_row(key);
  if (row == nullptr) return {};
  return row->unit.empty() ? std::string(row->meaning) : fmt::format("[{}] {}", row->unit, row->meaning);
}

}  // namespace lxd
