// SPDX-License-Identifier: Apache-2.0
// Metadata from a sensor by HTTP, whole or in the parts of old firmware; and sensors that misbehave.
#include <fstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "drivers/ouster/metadata_fetch.hpp"
#include "tests/support/made_http_server.hpp"
#include "tests/support/temporary_folder.hpp"

namespace lxd::drivers_ouster_fetch_test {
namespace {

using test::MadeHttpServer;

const Duration kPatience = Duration::from_seconds(20);  // only a hang meets it
constexpr const char* kWhole = "/api/v1/sensor/metadata";

std::string sample() { return test::read_file(std::string(LXD_TEST_DATA) + "/ouster/windowed_frame1_0.json"); }

Result<HttpAnswer> get(const MadeHttpServer& server, std::size_t bytes_max = 1000, Duration deadline = kPatience) {
  return http_get({"127.0.0.1", server.port()}, "/x", deadline, bytes_max);
}
std::string complaint(const std::string& answer) {
  const MadeHttpServer server(MadeHttpServer::Answers{{"/x", answer}});
  const auto got = get(server);
  return got ? "none" : got.error().message.substr(got.error().message.find("/x: ") + 4);
}

TEST(HttpGet, GivesStatusAndBody) {
  const MadeHttpServer server(MadeHttpServer::Answers{{"/x", MadeHttpServer::found("{}")}});
  const auto answer = get(server);
  ASSERT_TRUE(answer) << answer.error().message;
  EXPECT_EQ(answer->status, 200);
  EXPECT_EQ(answer->body, "{}");
  EXPECT_EQ(http_get({"127.0.0.1", server.port()}, "/y", kPatience)->status, 404);
}

TEST(HttpGet, RefusesAnswersThatAreCutOffTooLongOrNoHttp) {
  EXPECT_EQ(complaint("HTTP/1.1 200 OK\r\ncontent-length:  5\r\n\r\nabc"),
            "found 3 bytes, wanted 5 as the answer says");
  EXPECT_EQ(complaint("HTTP/1.1 200 OK\r\n\r\n" + std::string(2000, 'x')), "more than 1000 bytes came");
  EXPECT_EQ(complaint("SSH-2.0-OpenSSH\r\n\r\n"), "the answer is no HTTP");
  EXPECT_EQ(complaint("HTTP/1.1 200"), "the answer is no HTTP");
  EXPECT_EQ(complaint("HTTP/1.1 2x0 OK\r\n\r\n"), "the answer is no HTTP");
  EXPECT_NE(complaint("HTTP/1.1 200 OK\r\nTransfer-Encoding: chunked\r\n\r\n0\r\n\r\n").find("chunks"),
            std::string::npos);
}

TEST(HttpGet, GivesUpWhenItsTimeIsOver) {
  const MadeHttpServer server(MadeHttpServer::Answers{{"/x", ""}});
  const auto answer = get(server, 1000, Duration::from_seconds(0.05));
  ASSERT_FALSE(answer);
  EXPECT_NE(answer.error().message.find("no whole answer in time"), std::string::npos) << answer.error().message;
}

TEST(HttpGet, SaysWhereThereIsNobody) {
  std::uint16_t port = 0;
  { port = MadeHttpServer(MadeHttpServer::Answers{}).port(); }
  const auto answer = http_get({"127.0.0.1", port}, "/x", kPatience);
  ASSERT_FALSE(answer);
  EXPECT_NE(answer.error().message.find("no connection: Connection refused"), std::string::npos);
  EXPECT_FALSE(http_get({"os-122.local", 80}, "/x", kPatience)) << "names are not resolved";
}

TEST(OusterFetch, TakesTheWholeMetadata) {
  const MadeHttpServer server(MadeHttpServer::Answers{{kWhole, MadeHttpServer::found(sample())}});
  const auto fetched = fetch_ouster_metadata({"127.0.0.1", server.port()}, kPatience);
  ASSERT_TRUE(fetched) << fetched.error().message;
  EXPECT_EQ(fetched->json, sample());
  EXPECT_EQ(fetched->metadata.columns_per_frame, 512);
  EXPECT_EQ(server.requests(), 1);
}

TEST(OusterFetch, PutsTheSectionsOfOldFirmwareTogether) {
  const auto whole = nlohmann::json::parse(sample());
  std::map<std::string, std::string> answers;
  for (const char* part : {"sensor_info", "beam_intrinsics", "imu_intrinsics", "lidar_intrinsics", "lidar_data_format"})
    answers[std::string(kWhole) + "/" + part] = MadeHttpServer::found(whole.at(part).dump());
  answers["/api/v1/sensor/cmd/get_config_param?args=active"] = MadeHttpServer::found(whole.at("config_params").dump());
  const MadeHttpServer server(answers);
  const auto fetched = fetch_ouster_metadata({"127.0.0.1", server.port()}, kPatience);
  ASSERT_TRUE(fetched) << fetched.error().message;
  const auto direct = parse_ouster_metadata(sample(), "x");
  EXPECT_EQ(fetched->metadata.altitude_rad, direct->altitude_rad);
  EXPECT_EQ(fetched->metadata.serial, direct->serial);
  EXPECT_EQ(server.requests(), 8);
}

TEST(OusterFetch, SaysWhatIsWrongWithASensor) {
  const MadeHttpServer starting(MadeHttpServer::Answers{{kWhole, "HTTP/1.1 503 Service Unavailable\r\n\r\n"}});
  const auto refused = fetch_ouster_metadata({"127.0.0.1", starting.port()}, kPatience);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("/api/v1/sensor/metadata: found status 503, wanted 200"), std::string::npos);
  const MadeHttpServer strange(MadeHttpServer::Answers{{kWhole, MadeHttpServer::found("{\"a\": 1}")}});
  const auto unsound = fetch_ouster_metadata({"127.0.0.1", strange.port()}, kPatience);
  ASSERT_FALSE(unsound);
  EXPECT_EQ(unsound.error().message.find("http://127.0.0.1"), 0U) << unsound.error().message;
}

}  // namespace
}  // namespace lxd::drivers_ouster_fetch_test
