// SPDX-License-Identifier: Apache-2.0
// Is a sensor stamped otherwise than its rig file says? Then the number that was found gets a sentence for the user.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace lxd {

class DelayHint {
 public:
  // What is known by now of how much later than the LiDAR's returns its samples are stamped. The first time: what the
  // rig file says.
  void note(double delay_s, double sigma_s);

  // sensor: its section in the rig file; samples: what it gives. Empty: nothing is amiss.
  [[nodiscard]] std::string sentence(std::string_view sensor, std::string_view samples) const;

 private:
  std::optional<double> said_s_;
  double found_s_ = 0, sigma_s_ = 0;
};

}  // namespace lxd
