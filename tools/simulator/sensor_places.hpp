// SPDX-License-Identifier: Apache-2.0
// Whether every sensor is in the open all the way: the body's way may be free while a mast goes through a lintel.
#pragma once

#include "rt/result.hpp"
#include "tools/simulator/context.hpp"
#include "tools/simulator/scenario.hpp"

namespace lxd::sim {

// Of LiDARs, camera, IMU and GNSS antenna (wheels are on the ground by design): at every step along the path, on the
// way from step to step, and on the way from the body to the sensor. Error: sensor, time, place, and what is in the
// way.
Status check_sensor_places(const Context& context, const Scenario& scenario);

}  // namespace lxd::sim
