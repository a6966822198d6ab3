// SPDX-License-Identifier: Apache-2.0
// Loads a rig file and tells everything that is wrong with it at once.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "board/problems.hpp"
#include "board/rig.hpp"
#include "board/settings.hpp"

namespace lxd {

struct RigFile {
  Rig rig;
  std::vector<SettingChoice> settings;  // of the section `settings`, in the file's order, each already checked
  std::vector<std::string> remarks;     // not wrong, but worth saying: extrinsics and the reference that were left out
  Problems problems;                    // the rig may be used only when there are none

  [[nodiscard]] bool ok() const { return problems.empty(); }
};

// `name` is the file's name in messages.
RigFile parse_rig(std::string text, std::string_view name);

// A file that cannot be read is one problem.
RigFile load_rig(const std::string& path);

}  // namespace lxd
