// SPDX-License-Identifier: Apache-2.0
// The wheels of a recording: can.log through the live rig's decoder, or wheel.csv of a generic folder.
#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "drivers/replay/rejections.hpp"
#include "drivers/wheel/wheel_decoder.hpp"
#include "rt/result.hpp"

namespace lxd {

inline constexpr const char* kCanLogFile = "can.log";
inline constexpr const char* kWheelTextFile = "wheel.csv";

class WheelLogSource {
 public:
  virtual ~WheelLogSource() = default;
  // The next sample. False: the recording has ended. Damage is counted and passed over.
  virtual bool next(WheelSample& sample) = 0;
  [[nodiscard]] virtual Rejections rejected() const = 0;
};

// Errors: the folder holds neither file, or it cannot be read.
// `messages` take the place of the decoder's own.
Result<std::unique_ptr<WheelLogSource>> open_wheel_source(const std::filesystem::path& recording,
                                                          std::vector<CanMessage> messages,
                                                          const WheelDecoderConfig& decoder);

}  // namespace lxd
