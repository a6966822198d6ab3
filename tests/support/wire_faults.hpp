// SPDX-License-Identifier: Apache-2.0
// Makes the troubles of a schedule out of what a player would play: silences, bursts, late arrivals and pulled cables
// in their slots, damage to single pieces wherever their wire is in no other trouble. Each piece says what must be
// counted for it; `lost` has what must be counted for pieces that are not there any more.
#pragma once

#include "tests/support/damaged_pieces.hpp"
#include "tests/support/fault_schedule.hpp"

namespace lxd::test {

class WireFaults {
 public:
  static constexpr std::size_t kThinned = 10;  // datagrams of the Livox become one

  WireFaults(const FaultSchedule& schedule, std::uint64_t seed, double duration_s)
      : schedule_(schedule), seed_(seed), end_s_(duration_s) {}

  void apply(Pieces& all) {
    const RigTime begin = all.front().t;
    begin_ = begin;
    Pieces lidar0 = of(all, "lidar0"), lidar1 = thinned(of(all, "lidar1"));
    Pieces imu = in_frames(of(all, "imu")), gnss = of(all, "gnss");
    all.clear();
    for (Pieces* const wire : {&lidar0, &lidar1, &imu, &gnss}) {
      const std::string name = wire->front().wire;
      damage(*wire, name);
      silence(*wire, name);
      shift(*wire, name);
      std::ranges::move(*wire, std::back_inserter(all));
    }
    for (const char* const wire : {"imu", "gnss"}) pull(all, wire);
  }

  [[nodiscard]] const WireLedger& lost() const { return lost_; }
  // How often each kind of damage was done.
  [[nodiscard]] const WireLedger& done() const { return done_; }

 private:
  [[nodiscard]] double at_s(const PlayedBytes& piece) const { return (piece.t - begin_).seconds(); }

  static Pieces of(const Pieces& all, const std::string& wire) {
    Pieces some;
    std::ranges::copy_if(all, std::back_inserter(some), [&](const PlayedBytes& piece) { return piece.wire == wire; });
    return some;
  }

  static Pieces thinned(const Pieces& all) {
    Pieces some;
    for (std::size_t i = 0; i + kThinned <= all.size(); i += kThinned)
      some.push_back(thinned_livox(std::span(all).subspan(i, kThinned), static_cast<std::uint16_t>(some.size())));
    return some;
  }

  // Damage to single pieces.

  void damage(Pieces& wire, const std::string& name) {
    Random random(seed_, name);
    Pieces damaged;
    for (PlayedBytes& piece : wire) {
      constexpr double kSparedAtEnd_s = 2;  // so that whatever is lost is missed by something that follows
      const double t_s = at_s(piece);
      const bool spared = t_s < FaultSchedule::kFirst_s / 2 || t_s > end_s_ - kSparedAtEnd_s;
      if (spared || schedule_.busy(name, t_s))
        damaged.push_back(std::move(piece));
      else if (name == "imu")
        damage_frame(std::move(piece), random, damaged);
      else if (name == "gnss")
        damage_sentence(std::move(piece), random, damaged);
      else
        damage_datagram(std::move(piece), random, damaged);
    }
    wire = std::move(damaged);
  }

  // Of six or eight kinds each about as often; most pieces stay as they are.
  void damage_datagram(PlayedBytes piece, Random& random, Pieces& out) {
    const bool livox = piece.wire == "lidar1";
    const std::size_t header = livox ? kLivoxCheckedFrom : 32, spared = livox ? 0 : 8;
    switch (random.bits() % 600) {
      case 0:
        return lose(piece, "lost");
      case 1:
        return replace(piece, cut_datagram(piece, random), "cut", out);
      case 2:
        return replace(piece, corrupt_datagram(piece, random, header, spared), "corrupted", out);
      case 3:
        return before(foreign_datagram(piece), std::move(piece), "foreign", out);
      case 4:
        done_[piece.wire + ".duplicated"] += 1;
        out.push_back(piece);
        return out.push_back(livox ? telling(std::move(piece), "repeated_packet")
                                   : telling(std::move(piece), "repeated_column", 16));
      case 5:
        return overtake(std::move(piece), out);
      case 6:
        if (livox) return before(livox_without_points(piece), std::move(piece), "without_points", out);
        break;
      case 7:
        if (livox) return before(livox_beyond_datagram(piece, random), std::move(piece), "beyond_datagram", out);
        break;
      default:
        break;
    }
    out.push_back(std::move(piece));
  }

  // By the one before it, unless that is not itself.
  void overtake(PlayedBytes piece, Pieces& out) {
    out.push_back(std::move(piece));
    if (out.size() < 2) return;
    PlayedBytes &last = out.back(), &before = out[out.size() - 2];
    if (!last.told.empty() || !before.told.empty()) return;
    done_[last.wire + ".reordered"] += 1;
    std::swap(last.bytes, before.bytes);
  }

  void damage_frame(PlayedBytes piece, Random& random, Pieces& out) {
    switch (random.bits() % 400) {
      case 0:
        return before(noise_on_line(piece, random), std::move(piece), "noise", out);
      case 1:
        if (auto shorter = shortened_frame(piece, random)) return keep(std::move(*shorter), "bytes_lost", out);
        break;
      case 2:
        if (auto corrupt = corrupt_frame(piece, random)) return keep(std::move(*corrupt), "corrupted", out);
        break;
      default:
        break;
    }
    out.push_back(std::move(piece));
  }

  void damage_sentence(PlayedBytes piece, Random& random, Pieces& out) {
    const bool after_cut = std::exchange(line_is_open_, false);
    switch (after_cut ? ~0ULL : random.bits() % 80) {
      case 0:
        return before(nmea_garbage(piece, random), std::move(piece), "garbage", out);
      case 1:
        if (auto wrong = nmea_wrong_digit(piece)) return keep(std::move(*wrong), "wrong_digit", out);
        break;
      case 2:
        line_is_open_ = true;
        return keep(nmea_cut(std::move(piece), random), "cut", out);
      case 3:
        return before(nmea_without_checksum(piece), std::move(piece), "without_checksum", out);
      case 4:
        return before(nmea_too_long(piece, random), std::move(piece), "too_long", out);
      case 5:
        return before(nmea_bad_field(piece), std::move(piece), "bad_field", out);
      default:
        break;
    }
    out.push_back(std::move(piece));
  }

  void keep(PlayedBytes piece, const char* kind, Pieces& out) {
    done_[piece.wire + "." + kind] += 1;
    out.push_back(std::move(piece));
  }
  void before(PlayedBytes more, PlayedBytes&& piece, const char* kind, Pieces& out) {
    keep(std::move(more), kind, out);
    out.push_back(std::move(piece));
  }
  void lose(const PlayedBytes& piece, const char* kind) {
    done_[piece.wire + "." + kind] += 1;
    if (piece.wire == "lidar1") lost_["lidar1.missing_packet"] += 1;  // an Ouster's are counted frame by frame
  }
  void replace(const PlayedBytes& piece, PlayedBytes other, const char* kind, Pieces& out) {
    lose(piece, kind);
    out.push_back(std::move(other));
  }

  // Troubles of a whole wire.

  // A cable is pulled when all that was sent has been read; what would be sent meanwhile is not.
  static constexpr double kRead_s = 0.1;

  [[nodiscard]] bool silent(const std::string& wire, double t_s) const {
    return schedule_.at(wire + "_silent", t_s) != nullptr || schedule_.at("all_silent", t_s) != nullptr ||
           schedule_.at(wire + "_unplugged", t_s + kRead_s) != nullptr ||
           schedule_.at(wire + "_unplugged", t_s) != nullptr;
  }

  void silence(Pieces& wire, const std::string& name) {
    Random random(seed_, name + "/loss");
    constexpr double kLoss = 0.33;
    std::erase_if(wire, [&](const PlayedBytes& piece) {
      const double t_s = at_s(piece);
      const bool lost = schedule_.at(name + "_loss", t_s) != nullptr && random.chance(kLoss);
      if (!lost && !silent(name, t_s)) return false;
      lose(piece, lost ? "lost" : "silent");
      return true;
    });
  }

  // Never out of order: a wire's pieces wait for each other.
  void shift(Pieces& wire, const std::string& name) {
    Random random(seed_, name + "/delay");
    constexpr double kMean_s = 5e-3;
    RigTime last = begin_;
    for (PlayedBytes& piece : wire) {
      const double t_s = at_s(piece);
      if (const FaultSlot* const burst = schedule_.at(name + "_burst", t_s))
        piece.t = begin_ + Duration::from_seconds(burst->end_s);
      if (schedule_.at("jitter", t_s) != nullptr)
        piece.t = piece.t + Duration::from_seconds(-kMean_s * std::log(1 - random.uniform()));
      piece.t = last = std::max(piece.t, last);
    }
  }

  void pull(Pieces& all, const std::string& wire) {
    for (const FaultSlot& slot : schedule_.slots()) {
      if (!slot.is(wire + "_unplugged")) continue;
      PlayedBytes out{begin_ + Duration::from_seconds(slot.begin_s), wire, 0, {}, WireAct::kPull};
      PlayedBytes in{begin_ + Duration::from_seconds(slot.end_s), wire, 0, {}, WireAct::kPlug};
      all.push_back(std::move(out));
      all.push_back(std::move(in));
      lost_[wire + ".departure"] += 1;
    }
  }

  const FaultSchedule& schedule_;
  std::uint64_t seed_;
  double end_s_;
  RigTime begin_;
  bool line_is_open_ = false;  // a sentence was cut, and the next one ends it
  WireLedger lost_, done_;
};

}  // namespace lxd::test
