// SPDX-License-Identifier: Apache-2.0
// What a driver must count of an Ouster's datagrams as they were sent, told from their headers alone: what frames lack,
// what was overtaken, another sensor's packets, another packet format's, restarts.
#pragma once

#include <set>

#include "drivers/ouster/metadata.hpp"
#include "tests/support/wire_player.hpp"

namespace lxd::test {

class OusterLedger {
 public:
  explicit OusterLedger(const OusterMetadata& metadata)
      : format_(metadata.format),
        packets_(metadata.columns_per_frame / metadata.format.columns_per_packet),
        init_id_(metadata.init_id.value_or(0)),
        serial_(metadata.serial.value_or(0)) {}

  void add(const PlayedBytes& piece) {
    if (piece.foreign || !piece.told.empty()) return;  // says for itself what comes of it
    const OusterFraming& framing = format_.framing();
    const std::uint8_t* const header = piece.bytes.data();
    if (piece.bytes.size() != format_.packet_bytes()) return count("bad_size");
    if (framing.serial.get(header) != serial_) return count("bad_serial");
    if (!same_run(framing.init_id.get(header))) return;
    const auto frame = static_cast<std::uint16_t>(framing.packet_frame_id.get(header));
    const std::uint8_t* const column = header + format_.column_offset(0);
    add(frame, framing.measurement_id.get(column) / format_.columns_per_packet);
  }

  [[nodiscard]] const WireLedger& counts() const { return counts_; }

 private:
  static constexpr int kRestart = 16;  // packets of a new run until it is believed

  void count(const char* counter, std::uint64_t times = 1) {
    if (times > 0) counts_[std::string("lidar0.") + counter] += times;
  }

  bool same_run(std::uint64_t init_id) {
    if (init_id == init_id_) return true;
    if (++others_ < kRestart) {
      count("bad_init_id");
      return false;
    }
    init_id_ = init_id;
    others_ = 0;
    count("sensor_restart");
    return true;
  }

  void add(std::uint16_t frame, std::size_t place) {
    const auto ahead = static_cast<std::int16_t>(frame - frame_);
    if (!places_.empty() && ahead < 0 && ahead >= -8) return count("stale_packet");
    if (!places_.empty() && ahead != 0) {
      count("missing_packet", packets_ - places_.size());
      if (ahead > 0 && ahead <= 600) count("missing_frame", static_cast<std::uint64_t>(ahead - 1));
      places_.clear();
    }
    frame_ = frame;
    places_.insert(place);
  }

  OusterPacketFormat format_;
  std::size_t packets_;  // of a frame
  std::uint64_t init_id_, serial_;
  int others_ = 0;
  std::uint16_t frame_ = 0;
  std::set<std::size_t> places_;  // of the frame under way that were filled
  WireLedger counts_;
};

}  // namespace lxd::test
