// SPDX-License-Identifier: Apache-2.0
// Plays a rig recording's bytes onto real wires: datagrams over the loopback, serial bytes over pseudo-terminals, each
// at its time. What a live rig's program hears is then known.
#pragma once

#include <algorithm>
#include <chrono>
#include <fstream>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "board/rig_file.hpp"
#include "board/rig_text.hpp"
#include "drivers/replay/datagram_capture.hpp"
#include "drivers/replay/nmea_log.hpp"
#include "drivers/replay/serial_log.hpp"
#include "tests/support/loopback.hpp"
#include "tests/support/temporary_folder.hpp"

namespace lxd::test {

// What is done to a wire: bytes onto it, its cable out, its cable in.
enum class WireAct { kSend, kPull, kPlug };

struct PlayedBytes {
  RigTime t;
  std::string wire;        // lidar0, lidar1, imu, gnss
  std::uint16_t port = 0;  // that the datagram was sent to
  std::vector<std::uint8_t> bytes;
  WireAct act = WireAct::kSend;
  bool foreign = false;  // from an address that is none of the rig's
  // What whoever hears these bytes must count, by the name of the counter.
  std::vector<std::pair<std::string, std::uint64_t>> told{};
};

// Counts by name.
using WireLedger = std::map<std::string, std::uint64_t>;

inline std::vector<PlayedBytes> datagrams_of(const std::filesystem::path& pcap, const std::string& wire) {
  std::vector<PlayedBytes> played;
  auto file = PcapFile::open(pcap);
  if (!file) return played;
  DatagramCapture capture(std::move(*file));
  Rejections ignored;
  while (const auto d = capture.next(ignored))
    played.push_back({d->received, wire, d->udp.destination_port, {d->udp.payload.begin(), d->udp.payload.end()}});
  return played;
}

inline std::vector<PlayedBytes> serial_of(const std::filesystem::path& path) {
  std::vector<PlayedBytes> played;
  auto log = SerialLog::open(path);
  if (!log) return played;
  SerialChunk chunk;
  Rejections ignored;
  while (log->next(chunk, ignored))
    played.push_back({chunk.received, "imu", 0, {chunk.bytes.begin(), chunk.bytes.end()}});
  return played;
}

inline std::vector<PlayedBytes> sentences_of(const std::filesystem::path& path) {
  std::vector<PlayedBytes> played;
  auto log = NmeaLog::open(path);
  if (!log) return played;
  NmeaChunk chunk;
  while (log->next(chunk)) played.push_back({chunk.received, "gnss", 0, {chunk.bytes.begin(), chunk.bytes.end()}});
  return played;
}

// The recording's rig with wires of this machine, and something at their far ends.
class WirePlayer {
 public:
  // Sensors that the recording does not have have no wire. `folder` gets the rig file and the serial devices.
  WirePlayer(const std::filesystem::path& recording, const TemporaryFolder& folder)
      : imu_(folder / "imu"), gnss_(folder / "gnss"), rig_file_(folder / "live.yaml") {
    add(datagrams_of(recording / "lidar0.pcap", "lidar0"));
    add(datagrams_of(recording / "lidar1.pcap", "lidar1"));
    add(serial_of(recording / "imu.serial"));
    add(sentences_of(recording / "gnss.nmea"));
    std::ranges::stable_sort(all_, {}, &PlayedBytes::t);
    write_rig(recording);
  }

  [[nodiscard]] const std::filesystem::path& rig_file() const { return rig_file_; }
  [[nodiscard]] std::size_t sent(const std::string& wire) const { return sent_.contains(wire) ? sent_.at(wire) : 0; }

  [[nodiscard]] std::size_t sent_bytes(const std::string& wire) const {
    return sent_bytes_.contains(wire) ? sent_bytes_.at(wire) : 0;
  }

  // Changes what is played, as a whole; afterwards it is in the order of time again.
  void edit(const std::function<void(std::vector<PlayedBytes>&)>& change) {
    change(all_);
    std::ranges::stable_sort(all_, {}, &PlayedBytes::t);
  }
  // What must have been counted of what was played so far.
  [[nodiscard]] const WireLedger& told() const { return told_; }
  // Wherever a wire was silent for longer than kShortGap_s: for how long, by wire.
  [[nodiscard]] const std::map<std::string, std::vector<double>>& gaps_s() const { return gaps_s_; }
  [[nodiscard]] RigTime first() const { return all_.front().t; }
  [[nodiscard]] std::uint16_t port_of(const std::string& wire) const {
    return ports_.lower_bound({wire, std::uint16_t{0}})->second;
  }

  // Plays what lies between two instants, seconds from the recording's begin. speed: 1 is the recording's own pace.
  // `before`: asked before each piece; false: it is lost on the wire.
  using Before = std::function<bool(const PlayedBytes&, double t_s)>;
  void play(double from_s, double until_s, double speed = 1, const Before& before = nullptr) {
    using Clock = std::chrono::steady_clock;
    const Clock::time_point start = Clock::now();
    for (const PlayedBytes& piece : all_) {
      const double t_s = (piece.t - all_.front().t).seconds();
      if (t_s < from_s || t_s >= until_s) continue;
      std::this_thread::sleep_until(
          start + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>((t_s - from_s) / speed)));
      if (!before || before(piece, t_s)) send(piece);
    }
  }

  // Of the rig file.
  void change(const std::function<void(Rig&)>& change) const {
    RigFile file = load_rig(rig_file_.string());
    change(file.rig);
    write_file(rig_file_, rig_text(file.rig));
  }

  SerialCable& imu() { return imu_; }
  SerialCable& gnss() { return gnss_; }

 private:
  static constexpr std::uint32_t kFirst = kLoopback + 1, kSecond = kLoopback + 2;

  void add(const std::vector<PlayedBytes>& played) {
    all_.insert(all_.end(), played.begin(), played.end());
    for (const PlayedBytes& piece : played)
      if (piece.port != 0 && !ports_.contains({piece.wire, piece.port}))
        ports_[{piece.wire, piece.port}] = free_udp_port();
  }

  void send(const PlayedBytes& piece) {
    if (piece.wire == "imu" || piece.wire == "gnss") return send(piece, piece.wire == "imu" ? imu_ : gnss_);
    note(piece);
    if (piece.foreign) return foreign_.send(ports_.at({piece.wire, piece.port}), piece.bytes);
    (piece.wire == "lidar0" ? first_ : second_).send(ports_.at({piece.wire, piece.port}), piece.bytes);
  }

  // After a cable was put in, nothing is sent before it is heard, as a sensor on USB that is found only then.
  void send(const PlayedBytes& piece, SerialCable& cable) {
    if (piece.act == WireAct::kPull) return cable.pull();
    if (piece.act == WireAct::kPlug) {
      awaited_.insert(piece.wire);
      return cable.plug();
    }
    if (awaited_.contains(piece.wire) && !cable.heard()) return;
    awaited_.erase(piece.wire);
    note(piece);
    cable.send(piece.bytes);
  }

  void note(const PlayedBytes& piece) {
    ++sent_[piece.wire];
    sent_bytes_[piece.wire] += piece.bytes.size();
    for (const auto& [name, times] : piece.told) told_[name] += times;
    if (piece.foreign) return;
    const auto now = std::chrono::steady_clock::now();
    const auto [last, first] = last_sent_.try_emplace(piece.wire, now);
    const double gap_s = std::chrono::duration<double>(now - last->second).count();
    if (gap_s > kShortGap_s) gaps_s_[piece.wire].push_back(gap_s);
    last->second = now;
  }

  // Most datagrams are points, the others the sensor's own IMU.
  void wire_lidar(const std::string& name, std::uint32_t address, LidarRig& lidar) {
    std::map<std::uint16_t, std::size_t> times;
    for (const PlayedBytes& piece : all_) times[piece.port] += piece.wire == name;
    const auto points = std::ranges::max_element(times, {}, [](const auto& entry) { return entry.second; });
    lidar.wire.address = fmt::format("127.0.0.{}", address & 0xFFU);
    for (const auto& [key, port] : ports_) {
      if (key.first != name) continue;
      (key.second == points->first ? lidar.wire.port : lidar.wire.imu_port) = port;
    }
  }

  void write_rig(const std::filesystem::path& recording) {
    RigFile file = load_rig((recording / "rig.yaml").string());
    EXPECT_TRUE(file.ok()) << text_of(file.problems);
    Rig& rig = file.rig;
    wire_lidar("lidar0", kFirst, rig.lidar0);
    if (rig.lidar1) wire_lidar("lidar1", kSecond, *rig.lidar1);
    for (const auto& [lidar, name] :
         {std::pair(&rig.lidar0, "lidar0.json"), std::pair(rig.lidar1 ? &*rig.lidar1 : nullptr, "lidar1.json")})
      if (lidar != nullptr && exists(recording / name)) lidar->wire.metadata = (recording / name).string();
    if (rig.imu) rig.imu->wire.device = imu_.path().string();
    if (rig.gnss) rig.gnss->wire.device = gnss_.path().string();
    write_file(rig_file_, rig_text(rig));
  }

  static constexpr double kShortGap_s = 0.1;
  static constexpr std::uint32_t kForeign = kLoopback + 9;

  UdpSender first_{kFirst}, second_{kSecond}, foreign_{kForeign};
  SerialCable imu_, gnss_;
  std::filesystem::path rig_file_;
  std::vector<PlayedBytes> all_;  // in the order of time
  std::map<std::pair<std::string, std::uint16_t>, std::uint16_t> ports_;
  std::map<std::string, std::size_t> sent_, sent_bytes_;
  WireLedger told_;
  std::set<std::string> awaited_;  // cables that were put in and are not heard yet
  std::map<std::string, std::chrono::steady_clock::time_point> last_sent_;
  std::map<std::string, std::vector<double>> gaps_s_;
};

}  // namespace lxd::test
