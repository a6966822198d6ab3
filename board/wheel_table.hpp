// SPDX-License-Identifier: Apache-2.0
// What a rig's `wheel` section makes of a CAN bus: the vehicle's own table, or the one that the section describes.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "board/rig.hpp"
#include "drivers/wheel/wheel_decoder.hpp"

namespace lxd {

// The protocol's table; that of kWheelTableProtocol refers to the rig's signals.
std::vector<CanMessage> wheel_messages(const WheelRig& rig);

// As the rig says, else as is usual for its protocol. A table's is `differential`.
WheelSource wheel_source(const WheelRig& rig);

// The messages must outlive the decoder.
WheelDecoderConfig wheel_decoder_config(const WheelRig& rig, std::span<const CanMessage> messages);

// The rig's own messages as a rig file has them below `messages:`.
std::string wheel_messages_text(const WheelRig& rig);

}  // namespace lxd
