// A viewer without a socket: what it asks its connection to draw.
#include "server/net/stream/viewer.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "evaluation/evaluation.hpp"
#include "tests/server/net/stream/fake_port.hpp"

namespace overfly::net {
namespace {

using nlohmann::json;

using testing::FakePort;

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

server::FrameRow frame_row(std::int64_t frame, std::int64_t t_ns) {
  server::FrameRow row;
  row.frame = frame;
  row.t_ns = t_ns;
  return row;
}

class ViewerTest : public ::testing::Test {
 protected:
  /// Sends a command and carries out what it asks of the connection.
  json command(const json& message) {
    now_ns_ += 1'000'000'000;
    viewer_.take_text(message.dump(), now_ns_);
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

TEST_F(ViewerTest, RefusesToResumeAStreamThatTheRunDoesNotHave) {
  const auto resume = [&](const char* stream) {
    return command({{"type", "watch"}, {"run", "r"}, {"resume", {{stream, 1}}}, {"request", 1}});
  };
  EXPECT_EQ(resume("estimate/nobody")["code"], "invalid_argument");
  EXPECT_EQ(resume("truth")["type"], "ok");
}

/// A run that was deleted and flown again under its name may lack the alignment that was shown.
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

/// The other runs of a scene are shown at their own times, if they are watched.
TEST_F(ViewerTest, AsksForScenesWithOtherRuns) {
  timeline_->append_frame(frame_row(1, 1'000'000'000));
  timeline_->append_frame(frame_row(2, 2'000'000'000));
  const json other = {{"run", "q"}, {"first_colour", 4}, {"hide", {"", "p"}}};
  const json absent = {{"run", "absent"}};
  const json scene = {
      {"run", "r"}, {"name", "scene"}, {"first_colour", 2}, {"with", {other, absent}}};
  command({{"type", "watch"}, {"run", "r"}, {"request", 1}});
  command({{"type", "watch"}, {"run", "q"}, {"offset_ns", 1'000'000'000}, {"request", 2}});
  command({{"type", "subscribe"}, {"pictures", {scene}}, {"request", 3}});
  command({{"type", "seek"}, {"t_ns", 2'000'000'000}, {"request", 4}});
  drawn_alignment();
  ASSERT_FALSE(port_.drawn.empty());
  const server::PictureRequest& request = port_.drawn.back().second;
  EXPECT_EQ(request.run_id, "r");
  EXPECT_EQ(request.t_ns, 2'000'000'000);
  EXPECT_EQ(request.look.first_colour, 2U);
  ASSERT_EQ(request.others.size(), 1U);
  EXPECT_EQ(request.others[0].run_id, "q");
  EXPECT_EQ(request.others[0].t_ns, 1'000'000'000);
  EXPECT_EQ(request.others[0].look.first_colour, 4U);
  EXPECT_FALSE(request.others[0].look.shows(""));
  EXPECT_FALSE(request.others[0].look.shows("p"));
  EXPECT_TRUE(request.others[0].look.shows("q"));
}

/// Between its frames the scene shows the main run's last one, and the other run when that was
/// taken; after the main run's end the other one goes on.
TEST_F(ViewerTest, AsksForOtherRunsBetweenTheirFrames) {
  timeline_->append_frame(frame_row(1, 1'000'000'000));
  timeline_->append_frame(frame_row(2, 2'000'000'000));
  const json scene = {
      {"run", "r"}, {"name", "scene"}, {"with", {{{"run", "q"}}}}, {"compared", "sim3"}};
  command({{"type", "watch"}, {"run", "r"}, {"request", 1}});
  command({{"type", "watch"}, {"run", "q"}, {"offset_ns", -250'000'000}, {"request", 2}});
  command({{"type", "subscribe"}, {"pictures", {scene}}, {"request", 3}});
  command({{"type", "seek"}, {"t_ns", 1'600'000'000}, {"request", 4}});
  drawn_alignment();
  ASSERT_FALSE(port_.drawn.empty());
  EXPECT_EQ(port_.drawn.back().second.t_ns, 1'000'000'000);
  EXPECT_EQ(port_.drawn.back().second.others.at(0).t_ns, 1'250'000'000);
  EXPECT_EQ(port_.drawn.back().second.compared, "sim3");
  command({{"type", "watch"}, {"run", "q"}, {"offset_ns", 1'500'000'000}, {"request", 5}});
  command({{"type", "seek"}, {"t_ns", 3'100'000'000}, {"request", 6}});
  drawn_alignment();
  EXPECT_EQ(port_.drawn.back().second.t_ns, 2'000'000'000);
  EXPECT_EQ(port_.drawn.back().second.others.at(0).t_ns, 1'600'000'000);
}

/// A run that has ended, of 100 frames.
std::shared_ptr<server::RunTimeline> flown_run() {
  server::RunInfo info;
  info.status = server::RunStatus::kCompleted;
  auto timeline = std::make_shared<server::RunTimeline>(info, std::vector<std::string>());
  for (int i = 0; i < 100; ++i) timeline->append_frame(frame_row(i, i * 40'000'000LL));
  return timeline;
}

/// A picture as the painter would make it.
server::Picture picture_of_frame(std::int64_t frame, bool video) {
  server::Picture picture;
  picture.frame = frame;
  picture.coding = video ? server::PictureCoding::kVp8 : server::PictureCoding::kJpeg;
  picture.bytes = std::make_shared<const std::vector<std::uint8_t>>(3);
  return picture;
}

/// What rests is a JPEG; what moves is video, in a chain that a lost picture breaks.
TEST_F(ViewerTest, SendsVideoOfWhatMovesToClientsThatShowIt) {
  timeline_ = flown_run();
  const json camera = {{"run", "r"}, {"name", "camera"}, {"encoding", "vp8"}};
  command({{"type", "watch"}, {"run", "r"}, {"request", 1}});
  command({{"type", "subscribe"}, {"pictures", {camera}}, {"acknowledge", true}, {"request", 2}});
  const auto next = [&] {
    const auto drawn = std::exchange(port_.drawn, {});
    return drawn.empty() ? std::nullopt : std::optional(drawn.back());
  };
  std::uint32_t sequence = 0;
  const auto show = [&](const auto& drawn, std::int64_t frame) {
    viewer_.picture_ready(
        drawn.first, picture_of_frame(frame, drawn.second.video.has_value()), now_ns_);
    viewer_.picture_sent(drawn.first, now_ns_);
    viewer_.take_text(
        json{{"type", "shown"}, {"pictures", {{drawn.first.stream_id, sequence++}}}}.dump(),
        now_ns_);
  };
  auto drawn = next();
  ASSERT_TRUE(drawn);
  EXPECT_FALSE(drawn->second.video) << "it rests";
  show(*drawn, 0);
  viewer_.take_text(json{{"type", "play"}}.dump(), now_ns_);
  std::vector<server::VideoChain> chains;
  for (int tick = 1; tick <= 20; ++tick) {
    now_ns_ += 40'000'000;
    viewer_.tick(now_ns_);
    drawn = next();
    if (!drawn) continue;
    if (drawn->second.video) chains.push_back(*drawn->second.video);
    const std::uint32_t id = drawn->first.stream_id;
    show(*drawn, tick);
    if (tick == 10) viewer_.take_text(json{{"type", "key"}, {"id", id}}.dump(), now_ns_);
  }
  ASSERT_GT(chains.size(), 10U);
  int keys = 0;
  for (std::size_t i = 0; i < chains.size(); ++i) {
    EXPECT_EQ(chains[i].pictures, i);
    keys += chains[i].key ? 1 : 0;
  }
  EXPECT_EQ(keys, 1) << "asked for by the client; an encoder begins with one anyway";
}

/// Few pictures are on the way to a client that says what it has shown.
TEST_F(ViewerTest, WaitsForAClientThatDoesNotShowItsPictures) {
  timeline_ = flown_run();
  const json camera = {{"run", "r"}, {"name", "camera"}};
  command({{"type", "watch"}, {"run", "r"}, {"request", 1}});
  command({{"type", "subscribe"}, {"pictures", {camera}}, {"acknowledge", true}, {"request", 2}});
  viewer_.take_text(json{{"type", "play"}}.dump(), now_ns_);
  int sent = 0;
  for (int tick = 0; tick < 50; ++tick) {
    for (const auto& [ticket, request] : std::exchange(port_.drawn, {})) {
      viewer_.picture_ready(ticket, picture_of_frame(tick, false), now_ns_);
      viewer_.picture_sent(ticket, now_ns_);
      ++sent;
    }
    now_ns_ += 40'000'000;
    viewer_.tick(now_ns_);
  }
  EXPECT_EQ(sent, PictureStreams::kWindow);
}

/// A panel that appears costs only its own pictures.
TEST_F(ViewerTest, DrawsOnlyTheStreamsThatASubscriptionChanges) {
  using Kind = server::PictureRequest::Kind;
  const json camera = {{"run", "r"}, {"name", "camera"}};
  const json error = {{"run", "r"}, {"name", "error/a"}};
  const auto kinds_drawn = [&] {
    std::vector<Kind> kinds;
    for (const auto& [ticket, request] : std::exchange(port_.drawn, {})) {
      kinds.push_back(request.kind);
      if (request.kind == Kind::kError) {
        EXPECT_EQ(request.error.estimator, 0U);
      }
      viewer_.picture_ready(ticket, Error{ErrorCode::kCancelled, ""}, now_ns_);
    }
    return kinds;
  };
  command({{"type", "watch"}, {"run", "r"}, {"request", 1}});
  command({{"type", "subscribe"}, {"pictures", {camera}}, {"request", 2}});
  EXPECT_EQ(kinds_drawn(), std::vector{Kind::kCamera});
  command({{"type", "subscribe"}, {"pictures", {camera, error}}, {"request", 3}});
  EXPECT_EQ(kinds_drawn(), std::vector{Kind::kError});
  json larger = camera;
  larger["max_width_px"] = 2560;
  command({{"type", "subscribe"}, {"pictures", {larger, error}}, {"request", 4}});
  EXPECT_EQ(kinds_drawn(), std::vector{Kind::kCamera});
  command({{"type", "subscribe"}, {"pictures", {larger}}, {"request", 5}});
  EXPECT_EQ(kinds_drawn(), std::vector<Kind>());
  command({{"type", "seek"}, {"t_ns", 0}, {"request", 6}});
  EXPECT_EQ(kinds_drawn(), std::vector{Kind::kCamera});
}

/// Where the main run has ended, the scene goes on with the others.
TEST_F(ViewerTest, DrawsASceneAgainWhenOnlyAnotherRunMoves) {
  timeline_->append_frame(frame_row(1, 1'000'000'000));
  const json scene = {{"run", "r"}, {"name", "scene"}, {"with", {{{"run", "q"}}}}};
  command({{"type", "watch"}, {"run", "r"}, {"request", 1}});
  command({{"type", "watch"}, {"run", "q"}, {"offset_ns", 2'000'000'000}, {"request", 2}});
  command({{"type", "subscribe"}, {"pictures", {scene}}, {"request", 3}});
  command({{"type", "seek"}, {"t_ns", 2'500'000'000}, {"request", 4}});
  command({{"type", "pause"}, {"request", 5}});
  command({{"type", "seek"}, {"t_ns", 2'500'000'000}, {"request", 6}});
  drawn_alignment();
  drawn_alignment();
  command({{"type", "play"}, {"request", 7}});
  now_ns_ += 900'000'000;
  viewer_.tick(now_ns_);
  ASSERT_EQ(port_.drawn.size(), 1U);
  EXPECT_EQ(port_.drawn[0].second.t_ns, 1'000'000'000);
  EXPECT_EQ(port_.drawn[0].second.others.at(0).t_ns, 1'000'000'000);
}

}  // namespace
}  // namespace overfly::net
