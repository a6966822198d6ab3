// SPDX-License-Identifier: Apache-2.0
// See metadata_fetch.hpp. Paths are those of Ouster's sensor API; ouster-sdk, sensor_http.
#include "drivers/ouster/metadata_fetch.hpp"

#include <array>
#include <utility>

#include <fmt/format.h>

namespace lxd {
namespace {

constexpr int kFound = 200, kNotFound = 404;
constexpr const char* kWhole = "/api/v1/sensor/metadata";  // firmware 2.2 and later

// Of firmware before, by the sections that the whole has.
struct Part {
  const char* section;
  const char* path;
  bool of_old_firmware = true;
};
// What firmware before 2.1 says of a section that it does not have.
constexpr const char* kNotRecognized = "\"error: Command not recognized.\"";
constexpr std::array kParts{
    Part{"sensor_info", "/api/v1/sensor/metadata/sensor_info"},
    Part{"beam_intrinsics", "/api/v1/sensor/metadata/beam_intrinsics"},
    Part{"imu_intrinsics", "/api/v1/sensor/metadata/imu_intrinsics"},
    Part{"lidar_intrinsics", "/api/v1/sensor/metadata/lidar_intrinsics"},
    Part{"lidar_data_format", "/api/v1/sensor/metadata/lidar_data_format", false},
    Part{"calibration_status", "/api/v1/sensor/metadata/calibration_status", false},
    Part{"config_params", "/api/v1/sensor/cmd/get_config_param?args=active"},
};

Error wrong_status(const HttpTarget& sensor, const char* path, int status) {
  return Error{
      fmt::format("http://{}:{}{}: found status {}, wanted {}", sensor.address, sensor.port, path, status, kFound)};
}

// The sections are what the sensor says, put together unread: parsing finds what is wrong with them.
Result<std::string> fetch_parts(const HttpTarget& sensor, Duration deadline) {
  std::string text;
  for (const Part& part : kParts) {
    Result<HttpAnswer> answer = http_get(sensor, part.path, deadline);
    if (!answer) return answer.error();
    if (answer->status == kNotFound && !part.of_old_firmware)
      answer->body = kNotRecognized;
    else if (answer->status != kFound)
      return wrong_status(sensor, part.path, answer->status);
    text += fmt::format("{}\"{}\": {}", text.empty() ? "{" : ", ", part.section, answer->body);
  }
  return text + "}";
}

Result<std::string> fetch_text(const HttpTarget& sensor, Duration deadline) {
  Result<HttpAnswer> whole = http_get(sensor, kWhole, deadline);
  if (!whole) return whole.error();
  if (whole->status == kFound) return std::move(whole->body);
  if (whole->status == kNotFound) return fetch_parts(sensor, deadline);
  return wrong_status(sensor, kWhole, whole->status);
}

}  // namespace

Result<FetchedMetadata> fetch_ouster_metadata(const HttpTarget& sensor, Duration deadline) {
  Result<std::string> text = fetch_text(sensor, deadline);
  if (!text) return text.error();
  const std::string name = fmt::format("http://{}:{}{}", sensor.address, sensor.port, kWhole);
  Result<OusterMetadata> metadata = parse_ouster_metadata(*text, name);
  if (!metadata) return metadata.error();
  return FetchedMetadata{std::move(*text), std::move(*metadata)};
}

}  // namespace lxd
