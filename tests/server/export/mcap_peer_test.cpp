// MCAP exports as the MCAP project's own reader sees them, with the messages decoded by an
// independent implementation.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <numeric>

#include "tests/server/export/export_fixture.hpp"

namespace overfly::server {
namespace {

using Json = nlohmann::json;

/// One document a line; empty if the peer is not installed.
std::vector<Json> mcap_peer_lines(const std::filesystem::path& file) {
  const auto script = overfly::testing::source_file("tests/server/export/mcap_peer/peer.cjs");
  if (!std::filesystem::exists(script.parent_path() / "node_modules" / "@mcap")) return {};
  std::FILE* const pipe =
      ::popen(("node '" + script.string() + "' '" + file.string() + "'").c_str(), "r");
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

TEST(McapPeer, ReadsEveryMessageOfAnExport) {
  const overfly::testing::TemporaryFolder folder;
  const ExportSource source = testing::small_source(
      {R"(camera.distortion={"model":"radtan","coefficients":[-0.1,0.01,0.002,0.001]})"});
  const auto options = testing::export_options(folder.path() / "d", DatasetFormat::kMcap);
  testing::exported(source, options);
  const std::vector<Json> lines = mcap_peer_lines(options.folder / "flight.mcap");
  if (lines.empty()) {
    GTEST_SKIP() << "@mcap/core is not installed: npm ci --prefix tests/server/export/mcap_peer";
  }
  ASSERT_FALSE(lines.back().contains("error")) << lines.back();
  const std::vector<MadeFrame> frames = testing::frames_of(source.scenario);
  const std::size_t messages = 4 * frames.size();
  EXPECT_EQ(lines.back().at("profile"), "ros2");
  for (const char* count : {"indexed", "streamed", "stated"}) {
    EXPECT_EQ(lines.back().at(count), messages) << count;
  }
  EXPECT_EQ(lines.back().at("ended"), true);
  ASSERT_EQ(lines.size(), messages + 1);
  std::map<std::string, std::size_t> seen;
  for (std::size_t i = 0; i < messages; ++i) {
    const Json& line = lines[i];
    const std::string topic = line.at("topic");
    const MadeFrame& frame = frames.at(seen[topic]++);
    const CameraShot& shot = frame.shots[0];
    const std::int64_t t_ns = source.epoch_utc_ns + frame.t_ns;
    EXPECT_EQ(line.at("log_ns"), std::to_string(t_ns));
    EXPECT_EQ(line.at("stamp"), Json({t_ns / kNsPerS, t_ns % kNsPerS}));
    const Eigen::Vector3d& p = shot.drawn.T_world_camera.translation;
    const Eigen::Vector4d q = shot.drawn.T_world_camera.rotation.coeffs();
    if (topic == "/camera/truth") {
      EXPECT_EQ(line.at("frame_id"), "world");
      EXPECT_EQ(line.at("p"), Json({p.x(), p.y(), p.z()}));
      EXPECT_EQ(line.at("q"), Json({q.x(), q.y(), q.z(), q.w()}));
    } else if (topic == "/tf") {
      EXPECT_EQ(line.at("child"), "camera_optical_frame");
      EXPECT_EQ(line.at("p"), Json({p.x(), p.y(), p.z()}));
    } else if (topic == "/camera/image_raw") {
      EXPECT_EQ(line.at("encoding"), "mono8");
      EXPECT_EQ(line.at("size"), Json({160, 120, 160}));
      EXPECT_EQ(line.at("bytes"), 160 * 120);
      EXPECT_EQ(line.at("sum"), std::accumulate(shot.image.data.begin(), shot.image.data.end(), 0));
    } else {
      EXPECT_EQ(topic, "/camera/camera_info");
      const PinholeCamera& camera = source.scenario.main_camera().model.pinhole();
      EXPECT_EQ(line.at("model"), "plumb_bob");
      EXPECT_EQ(line.at("d"), Json({-0.1, 0.01, 0.002, 0.001, 0.0}));
      EXPECT_EQ(
          line.at("k"),
          Json({camera.fx_px, 0.0, camera.cx_px, 0.0, camera.fy_px, camera.cy_px, 0.0, 0.0, 1.0}));
    }
  }
  for (const auto& [topic, count] : seen) EXPECT_EQ(count, frames.size()) << topic;
}

}  // namespace
}  // namespace overfly::server
