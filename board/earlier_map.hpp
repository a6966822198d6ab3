// SPDX-License-Identifier: Apache-2.0
// An earlier session's map that a run continues, or only finds its place in. It is read, never written.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include "backend/archive.hpp"
#include "rt/result.hpp"

namespace lxd {

inline constexpr int kEarlierMap = 0;  // its number among the maps that a run may be in; the run's own pieces follow

struct EarlierMapRequest {
  std::optional<std::filesystem::path> file;  // map.db, or the run's folder that it lies in
  bool localise = false;                      // the run adds nothing to it
};

struct EarlierMap {
  std::filesystem::path file;
  bool localise = false;
  std::shared_ptr<const Archive> archive;
};

// None where none is asked for. Error: it cannot be read; nothing can be found in it; the run would write over it.
Result<std::optional<EarlierMap>> open_earlier_map(const EarlierMapRequest& request, const std::filesystem::path& out);

}  // namespace lxd
