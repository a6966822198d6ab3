// SPDX-License-Identifier: Apache-2.0
// `--map` and `--localise`, which `replay` and `run` have in common.
#pragma once

#include <string>

#include <CLI/CLI.hpp>

#include "board/earlier_map.hpp"

namespace lxd {

struct EarlierMapOptions {
  std::string file;
  bool localise = false;
};

inline void add_earlier_map_options(CLI::App& command, EarlierMapOptions& options) {
  CLI::Option* const map =
      command
          .add_option("--map", options.file,
                      "An earlier run's map.db: once this run is found in it, it is in its frame and continues it; the "
                      "earlier one stays as it is")
          ->type_name("OLD/map.db");
  command.add_flag("--localise", options.localise, "With --map: only where the rig is in it; nothing is added")
      ->needs(map);
}

inline EarlierMapRequest request_of(const EarlierMapOptions& options) {
  EarlierMapRequest request;
  if (!options.file.empty()) request.file = options.file;
  request.localise = options.localise;
  return request;
}

}  // namespace lxd
