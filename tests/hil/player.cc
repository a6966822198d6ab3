// SPDX-License-Identifier: Apache-2.0
// Plays a rig recording onto the guest's wires, each piece at its time: datagrams to UDP ports, frames to CAN buses,
// the IMU's bytes out of a USB device that this process is.
//   lxd-hil-player RECORDING FUNCTIONFS-FOLDER
// Each line read is the name of a file: everything is played once, then that file is made. The serial line, GPIO and
// pulses are played by the guest's outside (drive-guest).
#include <chrono>
#include <fstream>
#include <functional>
#include <iostream>
#include <string>
#include <thread>

#include <arpa/inet.h>

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
  if (count != 3) return 2;
  const lxd::hil::Player player(arguments[1], arguments[2]);
  std::cout << "player: ready" << std::endl;
  for (std::string done; std::getline(std::cin, done);) {
    player.play_all();
    std::ofstream(done) << "played\n";
  }
}
