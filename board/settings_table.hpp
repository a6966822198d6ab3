// SPDX-License-Identifier: Apache-2.0
// The table behind board/settings.hpp. A new field of a configuration is one new line in board/settings_table.cpp.
#pragma once

#include <span>
#include <string_view>
#include <variant>

#include "board/settings.hpp"

namespace lxd {

struct SettingRow {
  using Field = std::variant<double*, int*, bool*>;

  std::string_view key;
  Field (*field)(Settings&);
  std::string_view unit;
  double low = 0;
  double high = 0;
  std::string_view meaning;
};

std::span<const SettingRow> setting_rows();

}  // namespace lxd
