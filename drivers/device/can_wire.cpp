// SPDX-License-Identifier: Apache-2.0
#include "drivers/device/can_wire.hpp"

#include <algorithm>
#include <cstring>

#include <linux/can.h>
#include <linux/can/error.h>

namespace lxd {

static_assert(sizeof(can_frame) == kCanWireBytes && kCanMaxData == CAN_MAX_DLEN);

std::optional<CanFrame> can_frame_of(std::span<const std::uint8_t> wire, RigTime received) {
  can_frame raw{};
  if (wire.size() != sizeof(raw)) return std::nullopt;
  std::memcpy(&raw, wire.data(), sizeof(raw));
  if (raw.can_dlc > CAN_MAX_DLEN) return std::nullopt;
  CanFrame frame;
  frame.received = received;
  if ((raw.can_id & CAN_ERR_FLAG) != 0) {
    frame.kind = CanKind::error;
    frame.id = raw.can_id & CAN_ERR_MASK;
  } else {
    frame.extended = (raw.can_id & CAN_EFF_FLAG) != 0;
    frame.kind = (raw.can_id & CAN_RTR_FLAG) != 0 ? CanKind::remote : CanKind::data;
    frame.id = raw.can_id & (frame.extended ? CAN_EFF_MASK : CAN_SFF_MASK);
  }
  frame.length = raw.can_dlc;
  if (frame.kind != CanKind::remote) std::copy_n(raw.data, raw.can_dlc, frame.data.begin());
  return frame;
}

CanTrouble trouble_of(const CanFrame& frame) {
  CanTrouble trouble;
  const bool controller = (frame.id & CAN_ERR_CRTL) != 0;
  trouble.passive = controller && (frame.data[1] & (CAN_ERR_CRTL_RX_PASSIVE | CAN_ERR_CRTL_TX_PASSIVE)) != 0;
  trouble.bus_off = (frame.id & kCanErrorBusOff) != 0;
  trouble.back = (frame.id & kCanErrorRestarted) != 0 || (controller && (frame.data[1] & CAN_ERR_CRTL_ACTIVE) != 0);
  return trouble;
}

}  // namespace lxd
