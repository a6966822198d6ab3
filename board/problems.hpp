// SPDX-License-Identifier: Apache-2.0
// What is wrong with a file that a person wrote: every problem is kept, so that one look mends them all.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace lxd {

struct Problem {
  std::string place;  // file:line
  std::string key;    // dotted path from the file's root
  std::string what;   // found and wanted

  [[nodiscard]] std::string text() const {
    return fmt::format("{}: {}{}{}", place, key, key.empty() ? "" : ": ", what);
  }
};

using Problems = std::vector<Problem>;

// One problem a line.
inline std::string text_of(const Problems& problems) {
  std::string text;
  for (const Problem& problem : problems) {
    if (!text.empty()) text += '\n';
    text += problem.text();
  }
  return text;
}

}  // namespace lxd
