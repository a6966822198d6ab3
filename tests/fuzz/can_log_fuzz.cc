// SPDX-License-Identifier: Apache-2.0
// Any text as a CAN log, line by line: what is a frame comes back as it was written, and the decoders stand it.
#include <cmath>
#include <cstdlib>
#include <string_view>

#include "drivers/replay/can_log.hpp"
#include "drivers/wheel/wheel_decoder.hpp"

namespace {

using namespace lxd;

void check_round_trip(CanLogRecord record) {
  constexpr std::int64_t kMicro_ns = 1000;
  record.frame.received = RigTime::from_ns(record.frame.received.ns() / kMicro_ns * kMicro_ns);
  CanLogRecord back;
  if (parse_can_log_line(can_log_line(record), back) != CanLogLine::frame) std::abort();
  if (!(back.frame == record.frame) || back.interface_name() != record.interface_name()) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string_view rest(reinterpret_cast<const char*>(data), size);
  WheelDecoder decoders[] = {WheelDecoder({agilex_messages(), WheelSource::motion, 0.5}),
                             WheelDecoder({agilex_messages(), WheelSource::odometer, 0.5}),
                             WheelDecoder({toyota_messages(), WheelSource::rear_wheels, 1.5})};
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find('\n'), rest.size() - 1);
    CanLogRecord record;
    if (parse_can_log_line(rest.substr(0, end + 1), record) == CanLogLine::frame) {
      check_round_trip(record);
      for (WheelDecoder& decoder : decoders) {
        const auto sample = decoder.decode(record.frame);
        if (sample && !(std::abs(sample->speed_mps) <= 70 && std::abs(sample->yaw_rate_radps) <= 10)) std::abort();
      }
    }
    rest.remove_prefix(end + 1);
  }
  return 0;
}
