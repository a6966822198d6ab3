// SPDX-License-Identifier: Apache-2.0
// A LiDAR that stands in a room, as a generic folder: seconds of recording in a few hundred kilobytes.
#pragma once

#include "tests/support/replay_layouts.hpp"
#include "tests/support/room_scan.hpp"

namespace lxd::test {

class RoomRecording : public replay_test::GenericLayout {
 public:
  explicit RoomRecording(int sweeps) {
    std::vector<double> times_s;
    for (int i = 0; i < sweeps; ++i) {
      scan(i, room_scan());
      times_s.push_back(10 + 0.1 * i);
    }
    times(times_s);
  }
};

}  // namespace lxd::test
