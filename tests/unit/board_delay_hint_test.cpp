// SPDX-License-Identifier: Apache-2.0
// A sensor that is stamped otherwise than its rig file says gets a sentence with the number to put there.
#include <gtest/gtest.h>

#include "board/delay_hint.hpp"

namespace lxd::board_delay_hint_test {
namespace {

std::string said_of(double by_rig_file_s, double found_s, double sigma_s) {
  DelayHint hint;
  hint.note(by_rig_file_s, 0.005);
  hint.note(found_s, sigma_s);
  return hint.sentence("camera0", "images");
}

TEST(DelayHint, ImagesThatAreLateAreToldWithTheirDelay) {
  const std::string said = said_of(0, 0.0197, 1e-4);
  EXPECT_NE(said.find("camera0: its images are stamped 19.7 ms later"), std::string::npos) << said;
  EXPECT_NE(said.find("camera0.delay_s: 0.0197"), std::string::npos) << said;
}

TEST(DelayHint, WhatIsStampedAsTheRigFileSaysOrIsNotSurelyOtherwiseIsNotTold) {
  EXPECT_EQ(said_of(0.02, 0.0197, 1e-4), "");
  EXPECT_EQ(said_of(0, 0.003, 1e-4), "");
  EXPECT_EQ(said_of(0, 0.009, 0.003), "");
  EXPECT_EQ(DelayHint().sentence("camera0", "images"), "");
}

}  // namespace
}  // namespace lxd::board_delay_hint_test
