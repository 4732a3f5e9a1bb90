// A run as the Foxglove protocol's own client sees it, with the messages decoded by an independent
// implementation.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <map>

#include "core/time.hpp"
#include "tests/server/net/test_server.hpp"

namespace overfly::testing {
namespace {

using Json = nlohmann::json;
using ::testing::Contains;
using ::testing::IsEmpty;

/// One document a line; empty if the peer is not installed.
std::vector<Json> foxglove_peer_lines(const std::string& url, const std::string& speed) {
  const auto script = source_file("tests/server/net/foxglove_peer/peer.cjs");
  if (!std::filesystem::exists(script.parent_path() / "node_modules" / "@foxglove")) return {};
  std::FILE* const pipe =
      ::popen(("node '" + script.string() + "' '" + url + "' " + speed).c_str(), "r");
  if (pipe == nullptr) return {};
  std::vector<Json> lines;
  std::string line;
  for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) {
    if (c != '\n') {
      line += static_cast<char>(c);
      continue;
    }
    lines.push_back(Json::parse(line));
    line.clear();
  }
  ::pclose(pipe);
  return lines;
}

std::vector<Json> of_topic(const std::vector<Json>& lines, const std::string& topic) {
  std::vector<Json> found;
  for (const Json& line : lines) {
    if (line.value("topic", "") == topic) found.push_back(line);
  }
  return found;
}

Json stamp_of(std::int64_t utc_ns) { return {utc_ns / kNsPerS, utc_ns % kNsPerS}; }

/// The poses of every frame of the run, each once and in order, as in the run's own record.
void check_truth(const std::vector<Json>& lines, const server::RunTimeline& timeline) {
  const std::int64_t epoch_ns = timeline.info().epoch_utc_ns.value();
  const auto frames = timeline.frames(0, 1000);
  const auto truth = of_topic(lines, "/camera/truth");
  ASSERT_EQ(truth.size(), frames.size());
  const auto estimates = of_topic(lines, "/estimates/perfect/pose_world");
  EXPECT_GT(estimates.size(), frames.size() / 2);
  std::map<Json, Json> places;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const Pose& T_world_camera = frames[i].T_world_camera;
    const Eigen::Vector3d& p = T_world_camera.translation;
    const Eigen::Vector4d q = T_world_camera.rotation.coeffs();
    EXPECT_EQ(truth[i].at("log_ns"), std::to_string(epoch_ns + frames[i].t_ns));
    EXPECT_EQ(truth[i].at("stamp"), stamp_of(epoch_ns + frames[i].t_ns));
    EXPECT_EQ(truth[i].at("frame_id"), "world");
    EXPECT_EQ(truth[i].at("p"), Json({p.x(), p.y(), p.z()}));
    EXPECT_EQ(truth[i].at("q"), Json({q.x(), q.y(), q.z(), q.w()}));
    places[truth[i].at("stamp")] = truth[i].at("p");
  }
  for (const Json& estimate : estimates) {
    const Json& place = places.at(estimate.at("stamp"));
    for (std::size_t axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(estimate.at("p").at(axis).get<double>(), place.at(axis).get<double>(), 1e-6);
    }
  }
  for (const Json& state : of_topic(lines, "/estimates/perfect/state")) {
    if (state.at("state") != "TRACKING" || !state.at("error_m").is_number()) continue;
    EXPECT_LT(state.at("error_m").get<double>(), 1e-6);
  }
}

TEST(FoxglovePeer, SeesAWholeRun) {
  TestServer server({}, "0123456789abcdefABCDEF-_");
  const std::string id = server.fly("tiny");
  const std::string url = "ws://127.0.0.1:" + std::to_string(server.port()) +
                          "/api/v1/foxglove?run=" + id + "&token=0123456789abcdefABCDEF-_";
  const std::vector<Json> lines = foxglove_peer_lines(url, "2");
  if (lines.empty()) {
    GTEST_SKIP() << "@foxglove/ws-protocol is not installed: npm ci --prefix "
                    "tests/server/net/foxglove_peer";
  }
  for (const Json& line : lines) {
    ASSERT_FALSE(line.contains("error")) << line;
    EXPECT_FALSE(line.contains("status")) << line;
  }
  EXPECT_EQ(lines.front().at("info").at("metadata").at("run"), id);
  const auto timeline = server.runs().timeline(id);
  ASSERT_TRUE(timeline);
  check_truth(lines, **timeline);

  const auto tf = of_topic(lines, "/tf");
  std::map<std::string, int> children;
  for (const Json& transform : tf) ++children[transform.at("child")];
  EXPECT_EQ(children["camera_optical_frame"], 63);
  EXPECT_EQ(children["base_link"], 63);
  EXPECT_GT(children["perfect_camera"], 30);
  const auto images = of_topic(lines, "/camera/image_raw/compressed");
  ASSERT_THAT(images, Not(IsEmpty()));
  for (const Json& image : images) {
    EXPECT_EQ(image.at("format"), "jpeg");
    EXPECT_EQ(image.at("begins"), Json({0xff, 0xd8, 0xff}));
    EXPECT_EQ(image.at("frame_id"), "camera_optical_frame");
  }
  const auto infos = of_topic(lines, "/camera/camera_info");
  ASSERT_THAT(infos, Not(IsEmpty()));
  EXPECT_EQ(infos.back().at("size"), Json({64, 48}));
  const auto paths = of_topic(lines, "/truth/path");
  ASSERT_THAT(paths, Not(IsEmpty()));
  EXPECT_EQ(of_topic(lines, "/truth/fix").size(), 63U);
  const auto log = of_topic(lines, "/rosout");
  EXPECT_EQ(log.size(), (*timeline)->log_count());

  // Its own time: it passes every frame, and goes on to the end.
  std::vector<Json> times;
  for (const Json& line : lines) {
    if (line.contains("time")) times.push_back(line.at("time"));
  }
  EXPECT_GE(times.size(), 63U);
  const auto last = (*timeline)->frames(62, 1).front();
  EXPECT_EQ(times.back(), std::to_string((*timeline)->info().epoch_utc_ns.value() + last.t_ns));
}

}  // namespace
}  // namespace overfly::testing
