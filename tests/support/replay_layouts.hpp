// SPDX-License-Identifier: Apache-2.0
// Makes folder recordings of each kind, so that one story can be told of all of them.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "tests/support/replay_files.hpp"

namespace lxd::replay_test {

inline std::string scan_name(int number) { return fmt::format("{:06}.bin", number); }

// A folder layout. A scan is given as x, y, z, intensity.
class ReplayLayout {
 public:
  virtual ~ReplayLayout() = default;
  // Where points have times of their own, the last one's is 0.09 s.
  void scan(int number, const std::vector<std::array<float, 4>>& points) {
    std::vector<float> floats;
    for (const auto& point : points) {
      floats.insert(floats.end(), point.begin(), point.end());
      if (point_floats() != 5) continue;
      const std::size_t at = floats.size() / 5 + 1;  // this point's number, from 1
      floats.push_back(0.09F * static_cast<float>(at) / static_cast<float>(points.size()));
    }
    write_floats(file(number), floats);
  }
  void good_scan(int number) { scan(number, {{1, 2, 3, 0.5F}, {4, 5, 6, 0.5F}, {-7, 8, 9, 0.5F}}); }
  // Seconds below 60; blank for a negative number.
  void times(const std::vector<double>& seconds) {
    std::string text;
    for (const double s : seconds) text += s < 0 ? "\n" : time_line(s) + "\n";
    write_times(text, seconds);
  }

  [[nodiscard]] virtual std::filesystem::path file(int number) const = 0;
  [[nodiscard]] virtual std::filesystem::path times_file() const = 0;
  [[nodiscard]] virtual int point_floats() const { return 4; }
  [[nodiscard]] std::filesystem::path path() const { return folder_.path(); }

 protected:
  [[nodiscard]] virtual std::string time_line(double s) const { return fmt::format("{:.9f}", s); }
  virtual void write_times(const std::string& text, const std::vector<double>&) { write_text(times_file(), text); }
  test::TemporaryFolder folder_;
};

class RawLayout : public ReplayLayout {
 public:
  [[nodiscard]] std::filesystem::path file(int n) const override {
    return path() / "velodyne_points" / "data" / scan_name(n);
  }
  [[nodiscard]] std::filesystem::path times_file() const override {
    return path() / "velodyne_points" / "timestamps.txt";
  }

 protected:
  [[nodiscard]] std::string time_line(double s) const override { return fmt::format("2011-09-26 13:04:{:012.9f}", s); }
  void write_times(const std::string& text, const std::vector<double>& seconds) override {
    write_text(times_file(), text);
    for (const double shift : {-0.05, 0.05}) {
      std::string edge;
      for (const double s : seconds) edge += s < 0 ? "\n" : time_line(s + shift) + "\n";
      write_text(path() / "velodyne_points" / (shift < 0 ? "timestamps_start.txt" : "timestamps_end.txt"), edge);
    }
  }
};

class OdometryLayout : public ReplayLayout {
 public:
  [[nodiscard]] std::filesystem::path file(int n) const override { return path() / "velodyne" / scan_name(n); }
  [[nodiscard]] std::filesystem::path times_file() const override { return path() / "times.txt"; }
};

class GenericLayout : public ReplayLayout {
 public:
  [[nodiscard]] std::filesystem::path file(int n) const override { return path() / "lidar0" / scan_name(n); }
  [[nodiscard]] std::filesystem::path times_file() const override { return path() / "lidar0" / "times.txt"; }
  [[nodiscard]] int point_floats() const override { return 5; }
};

// A layout made anew for each test, and the kind that the program calls it.
struct LayoutCase {
  const char* kind;
  std::unique_ptr<ReplayLayout> (*make)();
};
template <typename T>
std::unique_ptr<ReplayLayout> make_layout() {
  return std::make_unique<T>();
}
inline std::string letters_of(std::string kind) {
  std::erase(kind, '-');
  return kind;
}

inline std::array<LayoutCase, 3> every_layout() {
  return {{{"kitti-raw", make_layout<RawLayout>},
           {"kitti-odometry", make_layout<OdometryLayout>},
           {"generic", make_layout<GenericLayout>}}};
}

}  // namespace lxd::replay_test
