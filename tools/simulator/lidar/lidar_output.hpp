// SPDX-License-Identifier: Apache-2.0
// How a simulated LiDAR is written; not part of what it writes.
#pragma once

#include <atomic>
#include <functional>

namespace lxd::sim {

enum class LidarForm {
  kPackets,  // <sensor>.pcap, for an Ouster with <sensor>.json
  kScans,    // <sensor>/000000.bin ... and <sensor>/times.txt, as generic folders have them
};

struct LidarOutput {
  LidarForm form = LidarForm::kPackets;
  unsigned threads = 1;
  std::function<void(double part)> progress = {};  // 0 .. 1, from the calling thread
  const std::atomic<bool>* stop = nullptr;         // set: writing ends with an error
};

}  // namespace lxd::sim
