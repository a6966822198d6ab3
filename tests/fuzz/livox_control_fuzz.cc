// SPDX-License-Identifier: Apache-2.0
// Any bytes as a Livox control datagram and as the data of one, through every reader; what is a frame is written as it
// was.
#include <algorithm>
#include <array>
#include <cstdlib>

#include "drivers/livox/control_messages.hpp"

namespace {

using namespace lxd;

void read_all(std::span<const std::uint8_t> data) {
  (void)read_livox_discovered(data);
  (void)read_livox_parameters_set(data);
  (void)read_livox_state(data);
  const auto parameters = LivoxParameters::read(data);
  if (parameters && parameters->count() == 0 && parameters->find(LivoxKey::kSerial)) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::span<const std::uint8_t> datagram(data, size);
  read_all(datagram);
  LivoxControlParser parser;
  LivoxControlFrame frame;
  if (!parser.parse(datagram, frame)) return 0;
  read_all(frame.data);
  std::array<std::uint8_t, kLivoxControlMaxBytes> buffer;
  const auto again = encode_livox_control(frame, buffer);
  if (size > kLivoxControlMaxBytes) return 0;
  const bool reserved_bytes = std::any_of(data + 12, data + kLivoxControlCheckedBytes, [](int b) { return b != 0; });
  if (!reserved_bytes && !std::ranges::equal(again, datagram)) std::abort();
  return 0;
}
