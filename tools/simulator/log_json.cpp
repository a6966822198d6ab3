// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/log_json.hpp"

namespace lxd::sim {

using Json = nlohmann::ordered_json;

Json to_json(const LidarLog& log) {
  return {{"sweeps", log.sweeps},
          {"shots", log.shots},
          {"returns", log.returns},
          {"datagrams", log.datagrams},
          {"lost", log.lost},
          {"reordered", log.reordered},
          {"duplicated", log.duplicated},
          {"silenced", log.silenced},
          {"other_profile", log.other_profile},
          {"other_serial", log.other_serial},
          {"other_init_id", log.other_init_id},
          {"emptied", log.emptied},
          {"imu_datagrams", log.imu_datagrams}};
}

Json to_json(const ImuWritten& log) {
  const ImuFaultCounts& faults = log.faults;
  return {{"samples", log.samples}, {"bytes", log.bytes}, {"gap", faults.gap},     {"clipped", faults.clipped},
          {"step", faults.step},    {"nan", faults.nan},  {"stuck", faults.stuck}, {"time_step", faults.time_step},
          {"skew", faults.skew}};
}

Json to_json(const CameraLog& log) {
  return {{"triggered", log.triggered}, {"delivered", log.delivered}, {"dropped", log.dropped},
          {"unplugged", log.unplugged}, {"corrupt", log.corrupt},     {"jumped", log.jumped}};
}

Json to_json(const WheelLog& log) {
  return {{"frames", log.frames},
          {"wheel_frames", log.wheel_frames},
          {"other_frames", log.other_frames},
          {"bad_checksums", log.bad_checksums},
          {"error_frames", log.error_frames},
          {"withheld", log.withheld},
          {"slip_s", log.slip_s}};
}

Json to_json(const GnssLog& log) {
  return {{"epochs", log.epochs}, {"sentences", log.sentences}, {"none", log.none},
          {"single", log.single}, {"rtk_float", log.rtk_float}, {"rtk_fixed", log.rtk_fixed}};
}

Json to_json(const SyncLog& log) {
  return {{"pulses", log.pulses},
          {"missing", log.missing},
          {"spurious", log.spurious},
          {"gpio_events", log.gpio_events},
          {"gpio_lost", log.gpio_lost}};
}

}  // namespace lxd::sim
