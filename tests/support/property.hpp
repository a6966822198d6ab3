// SPDX-License-Identifier: Apache-2.0
// rapidcheck inside GoogleTest, from a fixed seed: the same cases at every run, and a counterexample fails the test.
#pragma once

#include <sstream>
#include <utility>

#include <gtest/gtest.h>
#include <rapidcheck.h>

namespace lxd::test {

template <typename Property>
void check_property(Property&& property, int cases = 1000) {
  rc::detail::TestParams params;
  params.seed = 20240229;
  params.maxSuccess = cases;
  const auto result = rc::detail::checkTestable(std::forward<Property>(property), rc::detail::TestMetadata{}, params);
  std::ostringstream message;
  rc::detail::printResultMessage(result, message);
  EXPECT_TRUE(result.template is<rc::detail::SuccessResult>()) << message.str();
}

// Uniform over [low, high] from the first case on (rapidcheck's own ranges start small).
inline double uniform(double low, double high) {
  constexpr int kSteps = 1'000'000;
  const auto steps = rc::gen::resize(rc::kNominalSize, rc::gen::inRange(0, kSteps + 1));
  return low + (high - low) * *steps / kSteps;
}

}  // namespace lxd::test
