// SPDX-License-Identifier: Apache-2.0
// A capture of an Ouster sensor that stands still: the one real turn that the clone carries, again and again, each turn
// with its own frame number and times. Tests damage its packets before they are written.
#pragma once

#include "tests/support/replay_ouster.hpp"

namespace lxd::test {

class StandingCapture {
 public:
  using Turn = std::vector<replay_test::Packet>;

  static constexpr std::uint64_t kTurn_ns = 100'000'000;

  explicit StandingCapture(int turns) {
    const Turn once = replay_test::datagrams(source(".pcap"), metadata_.format.packet_bytes());
    turns_.assign(static_cast<std::size_t>(turns), once);
    for (std::size_t i = 0; i < turns_.size(); ++i) {
      for_each_column(turns_[i], [&](std::uint8_t* column) {
        const auto& framing = metadata_.format.framing();
        framing.column_frame_id.set(column, framing.column_frame_id.get(column) + i);
        framing.timestamp_ns.set(column, framing.timestamp_ns.get(column) + i * kTurn_ns);
      });
    }
  }

  [[nodiscard]] Turn& turn(int number) { return turns_[static_cast<std::size_t>(number)]; }
  [[nodiscard]] const OusterMetadata& metadata() const { return metadata_; }

  // Visit(column): each column of a turn, at its first byte.
  template <typename Visit>
  void for_each_column(Turn& turn, Visit&& visit) const {
    for (replay_test::Packet& packet : turn)
      for (std::size_t c = 0; c < metadata_.format.columns_per_packet; ++c)
        visit(packet.data() + metadata_.format.column_offset(c));
  }
  void set_ranges(Turn& turn, std::uint32_t range_mm) const {
    for_each_column(turn, [&](std::uint8_t* column) {
      for (std::size_t row = 0; row < metadata_.format.pixels_per_column; ++row) set_range(column, row, range_mm);
    });
  }
  void set_range(std::uint8_t* column, std::size_t row, std::uint32_t range_mm) const {
    const auto& format = metadata_.format;
    std::uint8_t* const pixel = column + format.framing().column_header_bytes + row * format.profile->channel_bytes;
    format.profile->fields.range_mm.set(pixel, range_mm);
  }
  void shift_time(Turn& turn, std::int64_t by_ns) const {
    const auto& time = metadata_.format.framing().timestamp_ns;
    for_each_column(
        turn, [&](std::uint8_t* column) { time.set(column, time.get(column) + static_cast<std::uint64_t>(by_ns)); });
  }

  // The capture as a file; its metadata beside it.
  std::filesystem::path write() const {
    Turn all;
    for (const Turn& turn : turns_) all.insert(all.end(), turn.begin(), turn.end());
    constexpr std::size_t kWhole_bytes = 65'528;  // of a datagram: not in fragments
    replay_test::write_bytes(pcap(), replay_test::made_pcap(all, kWhole_bytes));
    std::filesystem::copy_file(source(".json"), json(), std::filesystem::copy_options::overwrite_existing);
    return pcap();
  }
  [[nodiscard]] std::filesystem::path pcap() const { return folder_.path() / "drive.pcap"; }
  [[nodiscard]] std::filesystem::path json() const { return folder_.path() / "drive.json"; }

 private:
  static std::filesystem::path source(const char* ending) {
    return replay_test::clone_ouster() / (std::string("OS-1-32-G_v2.1.1_1024x10") + ending);
  }

  TemporaryFolder folder_;
  OusterMetadata metadata_ = replay_test::must_read_metadata(source(".json"));
  std::vector<Turn> turns_;
};

}  // namespace lxd::test
