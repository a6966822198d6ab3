// SPDX-License-Identifier: Apache-2.0
// Text files of numbers: a row a line, between commas or blanks.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "rt/result.hpp"

namespace lxd::sim {

struct NumberTable {
  struct Row {
    int line;  // from 1
    std::vector<double> numbers;
  };
  std::string header;  // the first line, when it is one of words
  std::vector<Row> rows;
};

// Empty lines and lines that begin with '#' are passed over. Error: the file cannot be read; file:line, column, what is
// no finite number there.
Result<NumberTable> load_numbers(const std::filesystem::path& file);

}  // namespace lxd::sim
