// A viewer without a socket: what it asks its connection to draw.
#include "server/net/stream/viewer.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "evaluation/evaluation.hpp"

namespace overfly::net {
namespace {

using nlohmann::json;

/// Opens every run at once, and keeps what it is asked to draw.
class FakePort final : public ViewerPort {
 public:
  void send_text(std::string text) override { texts.push_back(json::parse(text)); }
  void send_picture(const PictureTicket& /*ticket*/,
                    const PictureHeader& /*header*/,
                    std::shared_ptr<const std::vector<std::uint8_t>> /*jpeg*/) override {}
  void draw(const PictureTicket& ticket, const server::PictureRequest& request) override {
    drawn.emplace_back(ticket, request);
  }
  void open_run(const std::string& /*run_id*/) override { ++opening; }
  [[nodiscard]] std::optional<double> picture_limit_hz() const override { return std::nullopt; }
  [[nodiscard]] std::size_t unsent_bytes() const override { return 0; }

  std::vector<json> texts;
  std::vector<std::pair<PictureTicket, server::PictureRequest>> drawn;
  int opening = 0;
};

/// A scored run of one frame, whose estimates can be shown by `none`.
std::shared_ptr<server::RunTimeline> scored_run() {
  auto timeline =
      std::make_shared<server::RunTimeline>(server::RunInfo{}, std::vector<std::string>{"a"});
  timeline->append_frame({});
  server::RunMetrics metrics;
  server::EstimatorMetrics& scored = metrics.estimators["a"];
  scored.map_id = 0;
  scored.score.alignments[evaluation::AlignmentMode::kNone] = {};
  timeline->set_metrics(metrics);
  return timeline;
}

class ViewerTest : public ::testing::Test {
 protected:
  /// Sends a command and carries out what it asks of the connection.
  json command(const json& message) {
    now_ns_ += 1'000'000'000;
    viewer_.handle(message.dump(), now_ns_);
    while (port_.opening > 0) {
      --port_.opening;
      viewer_.run_opened(timeline_, now_ns_);
    }
    for (auto answer = port_.texts.rbegin(); answer != port_.texts.rend(); ++answer) {
      if (answer->at("type") == "ok" || answer->at("type") == "error") return *answer;
    }
    return nullptr;
  }
  /// The alignment of the scene that was asked for last; the picture is then done.
  std::string drawn_alignment() {
    if (port_.drawn.empty()) return "nothing was drawn";
    const auto [ticket, request] = port_.drawn.back();
    port_.drawn.clear();
    viewer_.picture_ready(ticket, Error{ErrorCode::kCancelled, ""}, now_ns_);
    return request.alignment;
  }

  std::shared_ptr<server::RunTimeline> timeline_ = scored_run();
  FakePort port_;
  Viewer viewer_{port_};
  std::int64_t now_ns_ = 0;
};

/// A run that is watched again starts with its own alignment, in `playback` and in its scenes.
TEST_F(ViewerTest, ForgetsTheAlignmentOfARunThatIsNotWatchedAnyMore) {
  command(
      {{"type", "subscribe"}, {"pictures", {{{"run", "r"}, {"name", "scene"}}}}, {"request", 1}});
  command({{"type", "watch"}, {"run", "r"}, {"request", 2}});
  EXPECT_EQ(drawn_alignment(), "init_scale");
  ASSERT_EQ(command({{"type", "align"}, {"run", "r"}, {"mode", "none"}, {"request", 3}})["type"],
            "ok");
  EXPECT_EQ(drawn_alignment(), "none");
  // Sent again from the start: the watch goes on.
  command({{"type", "watch"}, {"run", "r"}, {"resume", json::object()}, {"request", 4}});
  EXPECT_EQ(drawn_alignment(), "none");
  command({{"type", "unwatch"}, {"run", "r"}, {"request", 5}});
  port_.drawn.clear();
  command({{"type", "watch"}, {"run", "r"}, {"request", 6}});
  EXPECT_EQ(drawn_alignment(), "init_scale");
}

/// A run that was deleted and flown anew under its name may lack the alignment that was shown.
TEST_F(ViewerTest, ShowsScenesByTheAlignmentThatItReports) {
  command(
      {{"type", "subscribe"}, {"pictures", {{{"run", "r"}, {"name", "scene"}}}}, {"request", 1}});
  command({{"type", "watch"}, {"run", "r"}, {"request", 2}});
  EXPECT_EQ(drawn_alignment(), "init_scale");
  command({{"type", "align"}, {"run", "r"}, {"mode", "none"}, {"request", 3}});
  EXPECT_EQ(drawn_alignment(), "none");
  timeline_ =
      std::make_shared<server::RunTimeline>(server::RunInfo{}, std::vector<std::string>{"a"});
  timeline_->append_frame({});
  command({{"type", "watch"}, {"run", "r"}, {"resume", json::object()}, {"request", 4}});
  EXPECT_EQ(drawn_alignment(), "init_scale");
  json playback;
  for (const json& text : port_.texts) {
    if (text.at("type") == "playback") playback = text;
  }
  EXPECT_EQ(playback.at("runs").at("r").at("alignment"), "init_scale");
}

}  // namespace
}  // namespace overfly::net
