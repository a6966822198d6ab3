// SPDX-License-Identifier: Apache-2.0
// Plays a rig recording onto the guest's wires, each piece at its time: datagrams to UDP ports, frames to CAN buses,
// the IMU's bytes out of a USB device that this process is.
//   lxd-hil-player RECORDING FUNCTIONFS-FOLDER PORT
// Each line read is the name of a session: everything is played once, then /tmp/NAME.played is made. The serial line,
// GPIO and pulses are the guest's outside (drive-guest), which goes by the guest's time: PORT is told the time in ns
// every 10 ms, and `play NAME` when a session begins.
#include <chrono>
#include <fstream>
#include <functional>
#include <iostream>
#include <string>
#include <thread>

#include <arpa/inet.h>
#include <fcntl.h>

#include "tests/hil/can_sender.hpp"
#include "tests/hil/played_recording.hpp"
#include "tests/hil/usb_function.hpp"

namespace lxd::hil {
namespace {

using Clock = std::chrono::steady_clock;

// The LiDARs' ports of rigs/serial.yaml and rigs/usb.yaml, and the far ends of their buses.
constexpr std::uint16_t kPorts[] = {7502, 7602};
constexpr const char* kBuses[] = {"can0", "vcan0"};

class Datagrams {
 public:
  void send(std::uint16_t port, const std::vector<std::uint8_t>& bytes) const {
    sockaddr_in end{};
    end.sin_family = AF_INET;
    end.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    end.sin_port = htons(port);
    if (::sendto(socket_.get(), bytes.data(), bytes.size(), 0, reinterpret_cast<const sockaddr*>(&end), sizeof end) < 0)
      std::cerr << "player: a datagram was not sent\n";
  }

 private:
  FileDescriptor socket_{::socket(AF_INET, SOCK_DGRAM, 0)};
};

// Each piece so long after the beginning as it was after `zero`.
template <typename Pieces, typename TimeOf, typename Send>
void play(const Pieces& pieces, Clock::time_point begin, RigTime zero, TimeOf time_of, Send send) {
  for (const auto& piece : pieces) {
    std::this_thread::sleep_until(begin + std::chrono::nanoseconds((time_of(piece) - zero).ns()));
    send(piece);
  }
}

// The guest's time, told to its outside.
class Pace {
 public:
  explicit Pace(const char* port) : port_(::open(port, O_WRONLY)) {
    if (!port_) throw std::runtime_error(std::string(port) + " cannot be opened");
  }
  // A line in one piece: several threads speak.
  void say(const std::string& words) const {
    const std::string line = words + "\n";
    if (::write(port_.get(), line.data(), line.size()) != static_cast<ssize_t>(line.size()))
      std::cerr << "player: the outside did not hear: " << words << "\n";
  }
  void keep(const std::stop_token& end) const {
    constexpr std::chrono::milliseconds kTick(10);
    for (auto next = Clock::now(); !end.stop_requested(); std::this_thread::sleep_until(next += kTick))
      say(std::to_string(Clock::now().time_since_epoch() / std::chrono::nanoseconds(1)));
  }

 private:
  FileDescriptor port_;
};

class Player {
 public:
  Player(const std::filesystem::path& recording, const std::filesystem::path& function)
      : packets_(datagrams_of(recording / "lidar0.pcap")),
        readings_(serial_of(recording / "imu.serial")),
        frames_(frames_of(recording / "can.log")),
        usb_(function),
        zero_(std::min({packets_.front().t, readings_.front().t, frames_.front().received})) {}

  void play_all() const {
    const Clock::time_point begin = Clock::now();
    const auto time_of = [](const Piece& piece) { return piece.t; };
    std::thread buses([&] {
      play(
          frames_, begin, zero_, [](const CanFrame& frame) { return frame.received; },
          [&](const CanFrame& frame) {
            for (const CanSender& bus : buses_) bus.send(frame);
          });
    });
    std::thread usb([&] {
      play(readings_, begin, zero_, time_of, [&](const Piece& piece) {
        if (!usb_.send(piece.bytes)) std::cerr << "player: the host took no USB transfer\n";
      });
    });
    play(packets_, begin, zero_, time_of, [&](const Piece& piece) {
      for (const std::uint16_t port : kPorts) lidars_.send(port, piece.bytes);
    });
    buses.join();
    usb.join();
  }

 private:
  std::vector<Piece> packets_, readings_;
  std::vector<CanFrame> frames_;
  UsbFunction usb_;
  Datagrams lidars_;
  std::vector<CanSender> buses_{std::begin(kBuses), std::end(kBuses)};
  RigTime zero_;
};

}  // namespace
}  // namespace lxd::hil

int main(int count, char** arguments) {
  if (count != 4) return 2;
  const lxd::hil::Player player(arguments[1], arguments[2]);
  const lxd::hil::Pace pace(arguments[3]);
  std::cout << "player: ready" << std::endl;
  const std::jthread ticks([&](const std::stop_token& end) { pace.keep(end); });
  for (std::string name; std::getline(std::cin, name);) {
    pace.say("play " + name);
    player.play_all();
    std::ofstream("/tmp/" + name + ".played") << "played\n";
  }
}
