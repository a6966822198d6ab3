// SPDX-License-Identifier: Apache-2.0
// "Did you mean": the known names that a mistyped one was probably meant to be.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lxd {

// Insertions, deletions, replacements and swaps of neighbours that turn a into b (Damerau-Levenshtein, restricted).
std::size_t edit_distance(std::string_view a, std::string_view b);

// At most `count` of `names`, best first; those further away than half of the word's length are left out.
std::vector<std::string> nearest_names(std::string_view word, std::span<const std::string_view> names,
                                       std::size_t count = 3);

// "; did you mean a, b or c?", or nothing where no name is near.
std::string did_you_mean(std::string_view word, std::span<const std::string_view> names);

}  // namespace lxd
