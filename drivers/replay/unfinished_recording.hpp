// SPDX-License-Identifier: Apache-2.0
// A recording whose writer did not come to its end (killed, power lost) must not look like a whole one: its folder
// holds a mark from its first file until the last act.
#pragma once

#include <filesystem>
#include <memory>

#include "drivers/replay/source.hpp"

namespace lxd {

inline constexpr const char* kUnfinishedMark = "UNFINISHED";
inline constexpr const char* kUnfinishedText = "This recording is being written, or its writer was cut off.\n";

bool is_unfinished(const std::filesystem::path& folder);

// The same sweeps; notes() begins with what is wrong with the folder, and rejected() has "unfinished_recording".
std::unique_ptr<SweepSource> mark_unfinished(std::unique_ptr<SweepSource> source, const std::filesystem::path& folder);

}  // namespace lxd
