// SPDX-License-Identifier: Apache-2.0
// GpioApi by libgpiod 1.6, for one line.
#pragma once

#include "drivers/sync/gpio_api.hpp"

struct gpiod_chip;

namespace lxd {

class LibgpiodLine final : public GpioApi {
 public:
  LibgpiodLine() = default;
  LibgpiodLine(const LibgpiodLine&) = delete;
  LibgpiodLine& operator=(const LibgpiodLine&) = delete;
  ~LibgpiodLine() override { LibgpiodLine::release(); }

  int request(const std::string& chip, unsigned line) override;
  int read(int fd, std::span<GpioEvent> events) override;
  void release() override;

 private:
  gpiod_chip* chip_ = nullptr;
};

}  // namespace lxd
