// SPDX-License-Identifier: Apache-2.0
// Any bytes as a camera's frame: the first three say format, width and height.
#include <vector>

#include "drivers/camera/pixel_format.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace lxd;
  if (size < 3) return 0;
  const FrameLayout layout{static_cast<PixelFormat>(data[0] % 4), data[1], data[2], 0};
  auto converter = PixelConverter::create(layout);
  if (!converter.ok()) return 0;
  const std::span<const std::uint8_t> frame(data + 3, size - 3);
  std::vector<std::uint8_t> grey(converter->grey_bytes()), bgr(converter->bgr_bytes());
  (void)converter->to_grey(frame, grey);
  (void)converter->to_bgr(frame, bgr);
  return 0;
}
