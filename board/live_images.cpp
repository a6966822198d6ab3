// SPDX-License-Identifier: Apache-2.0
#include "board/live_images.hpp"

#include "board/camera_file.hpp"
#include "board/camera_stream.hpp"

namespace lxd {

LiveImages::LiveImages(const Rig& rig)
    : rig_(*rig.camera0),
      format_(*find_pixel_format(fourcc_of_format(rig_.wire.pixel_format).value_or(0))),
      timing_(exposure_timing_of(rig_.wire)),
      clock_(rig_.wire.by_triggers() ? FrameClock(trigger_timing_of(rig)) : FrameClock()) {
  for (Waiting& waiting : images_) {
    GreyPixels& pixels = waiting.image.pixels;
    pixels.width = rig_.resolution[0];
    pixels.height = rig_.resolution[1];
    pixels.data.resize(std::size_t{pixels.width} * pixels.height);
  }
}

void LiveImages::want_colour() {
  wants_colour_ = true;
  for (Waiting& waiting : images_) {
    waiting.colour.width = rig_.resolution[0];
    waiting.colour.height = rig_.resolution[1];
    waiting.colour.data.resize(3 * waiting.image.pixels.data.size());
  }
}

void LiveImages::take(const Chunk& chunk) {
  const RigTime begin = timing_.begin(chunk.received, chunk.origin.frame.at_start);
  if (!gate_.admit(begin, rejected_)) return;
  if (count_ == kImages) {
    count_rejected(rejected_, "late");
    drop_front();
  }
  Waiting& waiting = images_[(first_ + count_++) % kImages];
  waiting.image.stamp = begin;
  waiting.image.exposure = timing_.exposure;
  waiting.image.received = chunk.received;
  waiting.image.number = number_++;
  waiting.placed = false;
  waiting.sound = read_pixels(chunk, waiting.image.pixels);
  if (!waiting.sound) count_rejected(rejected_, "broken_image");
  waiting.coloured = waiting.sound && read_colour(chunk, begin, waiting.colour);
}

Result<PixelConverter> LiveImages::converter_of(const Chunk& chunk) const {
  return PixelConverter::create({format_, rig_.resolution[0], rig_.resolution[1], chunk.origin.frame.bytes_per_line});
}

bool LiveImages::read_pixels(const Chunk& chunk, GreyPixels& pixels) {
  auto converter = converter_of(chunk);
  return converter && converter->to_grey(chunk.bytes, pixels.data);
}

// Colours are told by a few images of those that a camera takes.
bool LiveImages::read_colour(const Chunk& chunk, RigTime begin, ColourPixels& pixels) {
  if (!wants_colour_ || begin - coloured_ < kColourPeriod) return false;
  coloured_ = begin;
  auto converter = converter_of(chunk);
  return converter && converter->to_bgr(chunk.bytes, pixels.data);
}

const ColourPixels* LiveImages::front_colour() const {
  const Waiting& waiting = images_[first_ % kImages];
  return count_ > 0 && waiting.coloured ? &waiting.colour : nullptr;
}

// A broken image has a trigger, too.
const CameraImage* LiveImages::front(RigTime now) {
  while (count_ > 0) {
    Waiting& waiting = oldest();
    if (!waiting.placed && !place(waiting, now)) return nullptr;
    if (waiting.sound) return &waiting.image;
    drop_front();
  }
  return nullptr;
}

bool LiveImages::place(Waiting& waiting, RigTime now) {
  while (const auto edge = triggers_.pop()) clock_.add_trigger(*edge);
  const CameraImage& image = waiting.image;
  const auto instant = clock_.instant(image.stamp, image.exposure, *image.received, now);
  if (!instant) return false;
  waiting.image.instant = *instant;
  waiting.placed = true;
  return true;
}

void LiveImages::drop_front() {
  first_ = (first_ + 1) % kImages;
  --count_;
}

Rejections LiveImages::rejected() const {
  Rejections rejected = rejected_;
  count_triggers(clock_, rejected);
  count_rejected(rejected, "trigger_no_room", triggers_no_room_);
  return rejected;
}

}  // namespace lxd
