// SPDX-License-Identifier: Apache-2.0
// Sensor metadata: every shape that firmware 1.12 to 3.0.1 wrote, and what is refused, with its place and reason.
#include <numbers>

#include <nlohmann/json.hpp>

#include "drivers/ouster/metadata.hpp"
#include "drivers/ouster/xyz_table.hpp"
#include "tests/support/replay_ouster.hpp"

namespace lxd::drivers_ouster_metadata_test {
namespace {

using namespace replay_test;
using nlohmann::json;

json sample() { return json::parse(std::ifstream(clone_ouster() / "windowed_frame1_0.json")); }

std::string refusal(const json& document) {
  const auto metadata = parse_ouster_metadata(document.dump(), "m.json");
  return metadata ? "accepted" : metadata.error().message;
}

std::string refusal_of_file(const std::string& name) {
  const auto metadata = read_ouster_metadata(clone_ouster() / "malformed" / name);
  return metadata ? "accepted" : metadata.error().message;
}

void expect_says(const std::string& message, const std::string& wanted) {
  EXPECT_NE(message.find(wanted), std::string::npos) << message;
}

TEST(OusterMetadata, ShapeWithSections) {
  const OusterMetadata m = must_read_metadata(clone_ouster() / "windowed_frame1_0.json");
  EXPECT_EQ(m.product_line, "OS-0-128");
  EXPECT_EQ(m.format.profile->name, "RNG15_RFL8_NIR8");
  EXPECT_EQ(m.columns_per_frame, 512);
  EXPECT_EQ(m.format.pixels_per_column, 128);
  EXPECT_EQ(m.rate_hz, 10);
  EXPECT_EQ(m.init_id, 7109746U);
  EXPECT_EQ(m.lidar_port, 53750);
  EXPECT_EQ(m.imu_port, 7503);
  EXPECT_EQ(m.pixel_shift[2], 11);
}

TEST(OusterMetadata, FlatShape) {
  const OusterMetadata m = must_read_metadata(clone_ouster() / "OS-0-32-U1_v2.2.0_1024x10.json");
  EXPECT_EQ(m.format.profile->name, "RNG19_RFL8_SIG16_NIR16_DUAL");
  EXPECT_EQ(m.init_id, 9599938U);
  EXPECT_NEAR(m.altitude_rad[0], 43.88 * std::numbers::pi / 180, 1e-12);
  EXPECT_DOUBLE_EQ(m.T_lidar_beam(0, 3), 0.02767);
  EXPECT_DOUBLE_EQ(m.T_sensor_lidar(2, 3), 0.03618);
}

TEST(OusterMetadata, FirmwareThatSendsNoProfileIsLegacy) {
  const OusterMetadata m = must_read_metadata(clone_ouster() / "OS-1-32-G_v2.1.1_1024x10.json");
  EXPECT_EQ(m.format.profile->name, "LEGACY");
  EXPECT_FALSE(m.init_id.has_value());
}

TEST(OusterMetadata, OldestFirmwareGetsItsKnownDefaultsAndANote) {
  json old = {
      {"lidar_mode", "512x10"}, {"beam_altitude_angles", json::array()}, {"beam_azimuth_angles", json::array()}};
  for (int i = 0; i < 64; ++i) {
    old["beam_altitude_angles"].push_back(16 - i / 2.0);
    old["beam_azimuth_angles"].push_back(1);
  }
  const auto m = parse_ouster_metadata(old.dump(), "old.json");
  ASSERT_TRUE(m) << m.error().message;
  EXPECT_EQ(m->format.packet_bytes(), 12608U);
  EXPECT_EQ(m->pixel_shift[0], 9);
  EXPECT_EQ(m->pixel_shift[3], 0);
  EXPECT_EQ(m->T_sensor_lidar(0, 0), -1);
  EXPECT_EQ(m->notes.size(), 3U);
}

TEST(OusterMetadata, EverySampleOfTheVendorIsRead) {
  const auto folder = shared_ouster("metadata");
  if (!folder) GTEST_SKIP() << "LXD_SHARED_DATA has no ouster/metadata";
  std::size_t read = 0;
  for (const auto& entry : std::filesystem::directory_iterator(*folder)) {
    if (entry.path().extension() != ".json") continue;
    const auto metadata = read_ouster_metadata(entry.path());
    EXPECT_TRUE(metadata.ok()) << metadata.error().message;
    ++read;
  }
  EXPECT_GE(read, 20U);
}

TEST(OusterMetadataMalformed, AllZeroAngles) {
  expect_says(refusal_of_file("complete_but_all_zeros_legacy.json"), "beam_altitude_angles: found zeros only");
}

TEST(OusterMetadataMalformed, BothShapesMixedNamesEverySectionThatIsMissing) {
  const std::string message = refusal_of_file("garbled_legacy_and_nonlegacy.json");
  for (const char* section : {"imu_intrinsics", "config_params", "sensor_info", "lidar_data_format"}) {
    expect_says(message, std::string(section) + ": found nothing, wanted a section");
  }
}

TEST(OusterMetadataMalformed, IncompleteDataFormat) {
  expect_says(refusal_of_file("incomplete_data_format_legacy.json"), "data_format.columns_per_frame: found nothing");
  expect_says(refusal_of_file("incomplete_data_format_nonlegacy.json"),
              "lidar_data_format.pixels_per_column: found nothing");
}

TEST(OusterMetadataMalformed, MissingCalibrationStatus) {
  expect_says(refusal_of_file("incomplete_no_calref_nonlegacy.json"), "calibration_status: found nothing");
}

TEST(OusterMetadataMalformed, EveryFaultIsListedAtOnce) {
  json document = sample();
  document["lidar_data_format"]["udp_profile_lidar"] = "RNG99";
  document["config_params"]["lidar_mode"] = "77x1";
  document["sensor_info"]["initialization_id"] = -1;
  const std::string message = refusal(document);
  expect_says(message, "m.json: lidar_data_format.udp_profile_lidar: found \"RNG99\", wanted one of");
  expect_says(message, "m.json: config_params.lidar_mode: found \"77x1\"");
  expect_says(message, "m.json: sensor_info.initialization_id: found -1, wanted an integer in [0, 16777215]");
}

TEST(OusterMetadataMalformed, ValuesOutOfRangeNameTheirPath) {
  const auto changed = [](const char* pointer, const json& value) {
    json document = sample();
    document[json::json_pointer(pointer)] = value;
    return refusal(document);
  };
  expect_says(changed("/lidar_data_format/columns_per_packet", 0), "columns_per_packet: found 0");
  expect_says(changed("/lidar_data_format/columns_per_packet", 65), "columns_per_packet: found 65");
  expect_says(changed("/lidar_data_format/pixels_per_column", 1e9), "pixels_per_column: found");
  expect_says(changed("/lidar_data_format/columns_per_frame", 1024), "wanted 512 as lidar_mode says");
  expect_says(changed("/beam_intrinsics/beam_altitude_angles/3", "x"), "found \"x\" at entry 3");
  expect_says(changed("/beam_intrinsics/beam_azimuth_angles", json::array({1, 2})), "found 2 entries, wanted 128");
  expect_says(changed("/lidar_intrinsics/lidar_to_sensor_transform/0", 5), "no rigid transform");
  expect_says(changed("/config_params/udp_port_lidar", "7502"), "udp_port_lidar: found \"7502\"");
}

// Found by fuzzing: the parser throws another kind of error for it.
TEST(OusterMetadataMalformed, ANumberThatNoDoubleHolds) {
  const auto metadata = parse_ouster_metadata(R"({"beam_azimuth_angles": [0, 7777E7777]})", "huge.json");
  ASSERT_FALSE(metadata);
  EXPECT_NE(metadata.error().message.find("huge.json: no JSON that can be read"), std::string::npos);
  EXPECT_NE(metadata.error().message.find("7777E7777"), std::string::npos) << metadata.error().message;
}

TEST(OusterMetadataMalformed, NoJsonAtAll) {
  const auto message = [](const char* text) { return parse_ouster_metadata(text, "m.json").error().message; };
  expect_says(message(""), "m.json: byte 1: no JSON");
  expect_says(message("{\"a\": "), "m.json: byte");
  expect_says(message("[1, 2]"), "m.json: found no JSON object");
}

// Row 0 looks up, column 0 backwards: the sensor's x axis is half a turn from the lidar's.
TEST(OusterXyz, DirectionsFollowTheManual) {
  OusterMetadata metadata = made_metadata("LEGACY");
  metadata.T_sensor_lidar.diagonal() << -1, -1, 1, 1;
  metadata.T_sensor_lidar(2, 3) = 0.036;
  const OusterXyzTable table(metadata);
  const Eigen::Vector3f back = table.point(0, 10'000);
  EXPECT_NEAR(back.x(), -10 * std::cos(0.35), 1e-5);
  EXPECT_NEAR(back.y(), 0, 1e-5);
  EXPECT_NEAR(back.z(), 10 * std::sin(0.35) + 0.036, 1e-5);
  const Eigen::Vector3f quarter = table.point(16 * 4, 10'000);  // a quarter of 64 columns later, clockwise: left
  EXPECT_NEAR(quarter.x(), 0, 1e-5);
  EXPECT_NEAR(quarter.y(), 10 * std::cos(0.35), 1e-5);
}

// The range is measured from the centre through the beam's origin, so that the origin's distance is part of it.
TEST(OusterXyz, BeamOriginIsPartOfTheRange) {
  OusterMetadata metadata = made_metadata("LEGACY", 64, 1);
  metadata.altitude_rad = {0};
  metadata.T_lidar_beam(0, 3) = 0.0276;
  EXPECT_NEAR(OusterXyzTable(metadata).point(0, 5000).x(), 5.0, 1e-5);
  metadata.altitude_rad = {0.5};
  const Eigen::Vector3f p = OusterXyzTable(metadata).point(0, 5000);
  EXPECT_NEAR(p.x(), (5 - 0.0276) * std::cos(0.5) + 0.0276, 1e-5);
  EXPECT_NEAR(p.z(), (5 - 0.0276) * std::sin(0.5), 1e-5);
}

}  // namespace
}  // namespace lxd::drivers_ouster_metadata_test
