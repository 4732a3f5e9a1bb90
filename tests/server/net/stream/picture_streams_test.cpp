// The pictures of one client: which it asks for as video, and how they fit to its link.
#include "server/net/stream/picture_streams.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "server/net/stream/pictures/picture_codec.hpp"
#include "tests/server/net/stream/fake_port.hpp"

namespace overfly::net {
namespace {

using server::PictureCoding;
using testing::FakePort;

constexpr std::int64_t kPeriodNs = 40'000'000;

class PictureStreamsTest : public ::testing::Test {
 protected:
  PictureStreamsTest() : timeline_(server::RunInfo{}, {}) {}

  void subscribe(bool video, bool acknowledges) {
    StreamRequest camera{"r", "camera"};
    camera.video = video;
    streams_.subscribe({{camera}, acknowledges});
  }
  /// Moves the clock by a frame and gives what the client asks for.
  std::optional<server::PictureRequest> next(bool playing) {
    now_ns_ += kPeriodNs;
    if (playing) ++frame_;
    port_.drawn.clear();
    streams_.pump({{&timeline_, "r", frame_, frame_ * kPeriodNs}}, playing, &port_, now_ns_);
    if (port_.drawn.empty()) return std::nullopt;
    return port_.drawn.back().second;
  }
  void subscribe_scene() { streams_.subscribe({{StreamRequest{"r", "scene"}}, true}); }
  /// Draws and shows a scene at rest. @return the width it was asked for
  int show_scene(std::int64_t drawing_ns) {
    const auto request = next(false);
    if (!request) return 0;
    drawing_ns_ = drawing_ns;
    send();
    show_all();
    return request->scene.width_px;
  }
  /// Draws and sends what was asked for. @return its header
  PictureHeader send(PictureCoding coding = PictureCoding::kJpeg, bool key = true) {
    return send(port_.drawn.back().first, coding, key);
  }
  PictureHeader send(const PictureTicket& ticket,
                     PictureCoding coding = PictureCoding::kJpeg,
                     bool key = true) {
    server::Picture picture;
    picture.frame = frame_;
    picture.t_ns = frame_ * kPeriodNs;
    picture.width_px = 64;
    picture.height_px = 48;
    picture.coding = coding;
    picture.key = key;
    picture.preview = preview_;
    picture.bytes = std::make_shared<const std::vector<std::uint8_t>>(bytes_, std::uint8_t{1});
    streams_.ready(ticket, picture, &port_, now_ns_ + drawing_ns_);
    streams_.sent(ticket);
    const auto header = decode_picture_header(port_.binaries.back());
    return header.value_or(PictureHeader{});
  }
  /// Plays through one picture that the client shows.
  PictureHeader play_one(PictureCoding coding) {
    EXPECT_TRUE(next(true));
    const PictureHeader header = send(coding);
    streams_.shown({{{header.stream_id, header.sequence}}});
    return header;
  }
  /// Plays to a client that takes a second for each picture, until pictures are reduced.
  void play_slowly(int reduction) {
    for (int i = 0; i < 400 && streams_.pictures_json()["reduction"] != reduction; ++i) {
      if (next(true)) send();
      if (i % 25 == 0) show_all();
    }
    ASSERT_EQ(streams_.pictures_json()["reduction"], reduction);
    show_all();
  }
  void show_all() {
    if (port_.binaries.empty()) return;
    const auto header = decode_picture_header(port_.binaries.back());
    streams_.shown({{{header->stream_id, header->sequence}}});
  }

  server::RunTimeline timeline_;
  FakePort port_;
  PictureStreams streams_;
  std::int64_t frame_ = 0;
  std::int64_t now_ns_ = 1'000'000'000;
  std::size_t bytes_ = 3;        ///< of a picture
  std::int64_t drawing_ns_ = 0;  ///< until a picture is drawn
  bool preview_ = false;         ///< a picture is drawn as one
};

TEST_F(PictureStreamsTest, AsksForVideoOnceAPictureIsThereAndMoves) {
  subscribe(true, true);
  ASSERT_FALSE(next(false)->video) << "at rest";
  send();
  show_all();
  const auto first = next(true);
  ASSERT_TRUE(first && first->video);
  EXPECT_EQ(first->video->pictures, 0U);
  const PictureHeader header = send(PictureCoding::kVp8, true);
  EXPECT_EQ(header.encoding, PictureEncoding::kVp8);
  EXPECT_TRUE(header.key);
  show_all();
  const auto second = next(true);
  ASSERT_TRUE(second && second->video);
  EXPECT_FALSE(second->video->key);
  EXPECT_EQ(second->video->pictures, 1U);
  EXPECT_FALSE(send(PictureCoding::kVp8, false).key);
}

TEST_F(PictureStreamsTest, SendsJpegToAClientThatDoesNotAskForVideo) {
  subscribe(false, true);
  for (int i = 0; i < 5; ++i) {
    const auto request = next(true);
    ASSERT_TRUE(request);
    EXPECT_FALSE(request->video);
    EXPECT_EQ(send().encoding, PictureEncoding::kJpegColour);
    show_all();
  }
}

TEST_F(PictureStreamsTest, ShowsASeekAsJpegAndGoesOnWithAKeyPicture) {
  subscribe(true, true);
  for (int i = 0; i < 3; ++i) play_one(PictureCoding::kVp8);
  streams_.show_again();
  EXPECT_FALSE(next(true)->video);
  send();
  show_all();
  const auto request = next(true);
  ASSERT_TRUE(request && request->video);
  EXPECT_TRUE(request->video->key);
}

TEST_F(PictureStreamsTest, SendsTheLastPictureAgainInFullWhenItComesToRest) {
  subscribe(true, true);
  for (int i = 0; i < 3; ++i) play_one(PictureCoding::kVp8);
  const auto request = next(false);
  ASSERT_TRUE(request);
  EXPECT_FALSE(request->video);
  EXPECT_EQ(send().encoding, PictureEncoding::kJpegColour);
  show_all();
  EXPECT_FALSE(next(false)) << "once";
}

constexpr std::int64_t kQuickNs = 5'000'000;
constexpr std::int64_t kLongNs = 60'000'000;
constexpr std::int64_t kPreviewStandsNs = 200'000'000;

TEST_F(PictureStreamsTest, PreviewsASceneThatTakesLongAfterAJump) {
  subscribe_scene();
  const int width_px = show_scene(kLongNs);
  ASSERT_GT(width_px, 100);
  for (int jump = 0; jump < 3; ++jump) {
    streams_.show_after_jump();
    EXPECT_EQ(show_scene(kQuickNs), width_px / 2) << jump;
    EXPECT_FALSE(next(false)) << "a next jump may follow";
    EXPECT_TRUE(streams_.waiting());
    now_ns_ += kPreviewStandsNs;
    EXPECT_EQ(show_scene(kLongNs), width_px) << jump;
    EXPECT_FALSE(next(false)) << "once";
  }
}

TEST_F(PictureStreamsTest, PreviewsAgainIfTheNextJumpComesBeforeTheWholeScene) {
  subscribe_scene();
  const int width_px = show_scene(kLongNs);
  streams_.show_after_jump();
  EXPECT_EQ(show_scene(kQuickNs), width_px / 2);
  streams_.show_after_jump();
  EXPECT_EQ(show_scene(kQuickNs), width_px / 2);
  now_ns_ += kPreviewStandsNs;
  EXPECT_EQ(show_scene(kLongNs), width_px);
  EXPECT_FALSE(next(false));
  EXPECT_FALSE(streams_.waiting());
}

TEST_F(PictureStreamsTest, DrawsThePreviewThenTheFrameThenTheOthersAfterAJump) {
  streams_.subscribe(
      {{StreamRequest{"r", "depth"}, StreamRequest{"r", "camera"}, StreamRequest{"r", "scene"}},
       false});
  using Kind = server::PictureRequest::Kind;
  const auto drawn = [&] {
    now_ns_ += kPeriodNs;
    port_.drawn.clear();
    streams_.pump({{&timeline_, "r", frame_, frame_ * kPeriodNs}}, false, &port_, now_ns_);
    std::vector<Kind> kinds;
    drawing_ns_ = kLongNs;
    for (const auto& [ticket, request] : std::vector(port_.drawn)) {
      kinds.push_back(request.kind);
      send(ticket);
    }
    return kinds;
  };
  EXPECT_EQ(drawn(), (std::vector{Kind::kDepth, Kind::kCamera, Kind::kScene}));
  streams_.show_after_jump();
  EXPECT_EQ(drawn(), (std::vector{Kind::kScene, Kind::kCamera, Kind::kDepth}));
}

TEST_F(PictureStreamsTest, DoesNotPreviewASceneThatIsDrawnQuickly) {
  subscribe_scene();
  const int width_px = show_scene(kQuickNs);
  streams_.show_after_jump();
  EXPECT_EQ(show_scene(kQuickNs), width_px);
  EXPECT_FALSE(next(false));
}

TEST_F(PictureStreamsTest, DoesNotPreviewSteps) {
  subscribe_scene();
  const int width_px = show_scene(kLongNs);
  streams_.show_after_jump();
  streams_.show_again();
  EXPECT_EQ(show_scene(kLongNs), width_px);
}

TEST_F(PictureStreamsTest, PreviewsAFrameThatTakesLongAfterAJump) {
  subscribe(false, true);
  const auto first = next(false);
  EXPECT_FALSE(first->preview);
  drawing_ns_ = kLongNs;
  send();
  show_all();
  streams_.show_after_jump();
  const auto preview = next(false);
  EXPECT_TRUE(preview->preview);
  EXPECT_EQ(preview->max_width_px, first->max_width_px);
  preview_ = true;
  send();
  show_all();
  EXPECT_FALSE(next(false));
  now_ns_ += kPreviewStandsNs;
  const auto whole = next(false);
  ASSERT_TRUE(whole);
  EXPECT_FALSE(whole->preview);
}

TEST_F(PictureStreamsTest, PreviewsForAWhileAfterAPictureThatTookLong) {
  subscribe(false, true);
  ASSERT_TRUE(next(false));
  drawing_ns_ = 60'000'000'000;  // its world was opened
  send();
  show_all();
  // From now on the ground is in memory.
  drawing_ns_ = 1'000'000;
  int previews = 0;
  for (; previews < 20; ++previews) {
    streams_.show_after_jump();
    const auto request = next(false);
    ASSERT_TRUE(request);
    if (!request->preview) break;
    preview_ = true;
    send();
    show_all();
    now_ns_ += kPreviewStandsNs;
    ASSERT_TRUE(next(false));
    preview_ = false;
    send();
    show_all();
  }
  EXPECT_EQ(previews, 5);
}

TEST_F(PictureStreamsTest, SendsAFrameOnceThatCameWholeInsteadOfItsPreview) {
  subscribe(false, true);
  ASSERT_TRUE(next(false));
  drawing_ns_ = kLongNs;
  send();
  show_all();
  streams_.show_after_jump();
  ASSERT_TRUE(next(false)->preview);
  send();
  show_all();
  now_ns_ += kPreviewStandsNs;
  EXPECT_FALSE(next(false));
}

TEST_F(PictureStreamsTest, BeginsAnewWhenTheClientLostAPicture) {
  subscribe(true, true);
  std::uint32_t id = 0;
  for (int i = 0; i < 3; ++i) id = play_one(PictureCoding::kVp8).stream_id;
  ASSERT_FALSE(next(true)->video->key);
  send(PictureCoding::kVp8, false);
  show_all();
  ASSERT_TRUE(streams_.restart_video({id}).ok());
  EXPECT_TRUE(next(true)->video->key);
  const Status unknown = streams_.restart_video({99});
  EXPECT_EQ(unknown.error().code, ErrorCode::kNotFound);
  EXPECT_EQ(unknown.error().message, "key.id = 99: is no subscribed stream");
}

TEST_F(PictureStreamsTest, LeavesTheProcessorToARealTimeFlight) {
  subscribe(true, true);
  for (int i = 0; i < 3; ++i) play_one(PictureCoding::kVp8);
  streams_.set_limit_hz(31.0);
  const auto request = next(true);
  ASSERT_TRUE(request);
  EXPECT_FALSE(request->video) << "it takes several times as long";
}

TEST_F(PictureStreamsTest, HasFewPicturesOnTheWayToAClientThatAcknowledges) {
  subscribe(false, true);
  for (int i = 0; i < PictureStreams::kWindow; ++i) {
    ASSERT_TRUE(next(true));
    send();
  }
  EXPECT_FALSE(next(true));
  show_all();
  EXPECT_TRUE(next(true));
}

TEST_F(PictureStreamsTest, DoesNotWaitForEverForAClientThatForgetsToAcknowledge) {
  subscribe(false, true);
  for (int i = 0; i < PictureStreams::kWindow; ++i) {
    ASSERT_TRUE(next(true));
    send();
  }
  EXPECT_FALSE(next(true));
  now_ns_ += 6'000'000'000;
  EXPECT_TRUE(next(true));
}

TEST_F(PictureStreamsTest, IgnoresPicturesThatWereNeverSent) {
  subscribe(false, true);
  ASSERT_TRUE(next(true));
  const PictureHeader header = send();
  streams_.shown({{{header.stream_id, 4'000'000'000U}, {77, 0}}});
  for (int i = 1; i < PictureStreams::kWindow; ++i) {
    ASSERT_TRUE(next(true));
    send();
  }
  EXPECT_FALSE(next(true)) << "none of them has been shown";
}

TEST_F(PictureStreamsTest, HasFewBytesOnTheWayToAClientThatAcknowledges) {
  subscribe(false, true);
  bytes_ = SendWindow::kFirstBytes / 2;
  for (int i = 0; i < 2; ++i) {
    ASSERT_TRUE(next(true));
    send();
  }
  EXPECT_FALSE(next(true));
  EXPECT_FALSE(next(false)) << "nor one that rests";
  show_all();
  EXPECT_TRUE(next(true));
}

TEST_F(PictureStreamsTest, ReducesNothingOnAWayThatIsOnlyLong) {
  subscribe(false, true);
  bytes_ = 5'000;
  int sent = 0;
  for (std::uint32_t i = 0; i < 500; ++i) {
    if (next(true)) {
      send();
      ++sent;
    }
    // It is reported 200 ms later.
    if (i >= 5) streams_.shown({{{1, i - 5}}});
  }
  EXPECT_EQ(streams_.pictures_json()["reduction"], 0);
  EXPECT_GE(sent, 495) << "of 500 at the stream's rate";
}

TEST_F(PictureStreamsTest, SendsStreamsInTurnWhileThereIsLittleRoom) {
  streams_.subscribe({{{"r", "camera"}, {"r", "depth"}, {"r", "scene"}}, true});
  bytes_ = SendWindow::kFirstBytes;
  std::vector<std::uint32_t> order;
  for (int i = 0; i < 60 && order.size() < 6; ++i) {
    if (!next(true)) continue;
    ASSERT_EQ(port_.drawn.size(), order.empty() ? 2U : 1U) << "sizes are not known at first";
    for (const auto& [ticket, request] : std::exchange(port_.drawn, {})) {
      port_.drawn = {{ticket, request}};
      send();
      order.push_back(ticket.stream_id);
    }
    for (const std::uint32_t id : order) streams_.shown({{{id, 0}, {id, 1}, {id, 2}}});
  }
  EXPECT_EQ(order, (std::vector<std::uint32_t>{1, 2, 3, 1, 2, 3}));
}

TEST_F(PictureStreamsTest, SendsAllToAClientThatDoesNotAcknowledge) {
  subscribe(false, false);
  for (int i = 0; i < 100; ++i) {
    const auto request = next(true);
    ASSERT_TRUE(request);
    EXPECT_EQ(request->quality, 75);
    send();
  }
  EXPECT_EQ(streams_.pictures_json()["reduction"], 0);
}

TEST_F(PictureStreamsTest, ReducesMovingPicturesForASlowClientAndSharpensThemAtRest) {
  subscribe(false, true);
  play_slowly(4);
  EXPECT_TRUE(streams_.reduction_changed());
  EXPECT_FALSE(streams_.reduction_changed());
  now_ns_ += kPeriodNs;
  const auto reduced = next(true);
  ASSERT_TRUE(reduced);
  EXPECT_EQ(reduced->quality, 35);
  EXPECT_EQ(reduced->max_width_px, 320);
  EXPECT_TRUE(reduced->sparing);
  send();
  show_all();
  const auto full = next(false);
  ASSERT_TRUE(full);
  EXPECT_EQ(full->quality, 75);
  EXPECT_EQ(full->max_width_px, 1280);
  EXPECT_FALSE(full->sparing);
}

}  // namespace
}  // namespace overfly::net
