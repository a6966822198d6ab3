// SPDX-License-Identifier: Apache-2.0
// Any bytes as a recorded serial line, through each parser. Whatever is behind a sound begin, the file is read to an
// end, and every byte of its chunks is accounted for.
#include <cstdio>
#include <cstdlib>

#include "drivers/replay/imu_log.hpp"

namespace {

void read_all(const std::uint8_t* data, std::size_t size, lxd::ImuProtocol protocol) {
  using namespace lxd;
  std::FILE* const stream = fmemopen(const_cast<std::uint8_t*>(data), size, "rb");
  if (stream == nullptr) return;
  auto file = SerialLog::from_stream(stream, "fuzz.serial");
  if (!file) return;
  ImuLog log(std::move(*file), protocol, 115200);
  ImuSample sample;
  while (log.next(sample)) {
    if (!sample.gyro_radps.allFinite() || !sample.accel_mps2.allFinite()) std::abort();
  }
  if (log.bytes() > size) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  for (const std::string_view name : lxd::kImuProtocolNames) read_all(data, size, *lxd::find_imu_protocol(name));
  return 0;
}
