// SPDX-License-Identifier: Apache-2.0
#include "board/sight_images.hpp"

#include <utility>

namespace lxd {
namespace {

constexpr std::size_t kLeast = 2;  // the one that a key frame asks for, and the one after it

}  // namespace

void SightImages::offer(const GreyPixels& pixels, RigTime instant) {
  auto copy = std::make_shared<const GreyPixels>(pixels);
  const std::lock_guard lock(mutex_);
  bytes_ += copy->data.size();
  images_.push_back({instant, std::move(copy)});
  while (bytes_ > bytes_max_ && images_.size() > kLeast) drop_oldest();
}

std::shared_ptr<const GreyPixels> SightImages::take(RigTime instant) {
  const std::lock_guard lock(mutex_);
  while (!images_.empty() && images_.front().instant < instant) drop_oldest();
  if (images_.empty() || images_.front().instant != instant) return nullptr;
  auto found = images_.front().pixels;
  drop_oldest();
  return found;
}

std::size_t SightImages::bytes() {
  const std::lock_guard lock(mutex_);
  return bytes_;
}

void SightImages::drop_oldest() {
  bytes_ -= images_.front().pixels->data.size();
  images_.pop_front();
}

}  // namespace lxd
