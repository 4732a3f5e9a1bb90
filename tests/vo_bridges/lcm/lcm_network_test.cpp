// The LCM door on a real network (UDP multicast on this machine) and on log files.
#include <gmock/gmock.h>

#include <chrono>
#include <lcm/lcm-cpp.hpp>
#include <thread>

#include "core/measure/crc32.hpp"
#include "middleware/lcm/log_writer.hpp"
#include "tests/support/support.hpp"
#include "tests/vo_bridges/lcm/lcm_test_estimator.hpp"
#include "vo_bridges/lcm/lcm_estimator.hpp"

namespace overfly {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using testing::fly;
using testing::LcmPair;
using ::testing::Pair;
using testing::varied_frames;

/// Skips where images of full size cannot come through without loss.
class LcmUdp : public ::testing::Test {
 protected:
  void SetUp() override {
    if (const std::string reason = testing::multicast_missing(); !reason.empty()) {
      GTEST_SKIP() << reason;
    }
    options_.url = testing::private_udp_url();
    const std::string name = ::testing::UnitTest::GetInstance()->current_test_info()->name();
    options_.channel_prefix = name.substr(0, 30) + "_";
  }

  LcmEstimatorOptions options_;
};

#define OVERFLY_RECEIVE_BUFFER_OR_SKIP()                                      \
  if (lcm::largest_receive_buffer_bytes() < lcm::kSmallestReceiveBufferBytes) \
  GTEST_SKIP() << "net.core.rmem_max = " << lcm::largest_receive_buffer_bytes() << " is below 2 MiB"

TEST_F(LcmUdp, CarriesImagesOfFullSizeByteForByteInLockstep) {
  OVERFLY_RECEIVE_BUFFER_OR_SKIP();
  const LcmPair pair = testing::make_udp_pair({}, options_, options_.url);
  pair.door->set_debug(true);
  const auto frames = varied_frames(20, 1280, 960);
  for (const VoFrame& frame : frames) {
    const auto estimate = pair.door->track(frame);
    ASSERT_TRUE(estimate.ok()) << estimate.error().message;
    EXPECT_EQ(estimate->image_crc32, crc32_of(*frame.image));
    ASSERT_TRUE(estimate->debug_image.has_value());
    EXPECT_EQ(estimate->debug_image->data, std::vector<std::uint8_t>(640 * 480 * 3, 77));
  }
  ASSERT_EQ(pair.far_end->images().size(), frames.size());
  EXPECT_EQ(pair.far_end->images().back().data, frames.back().image->data);
}

/// The far end's socket holds a fraction of an image: packets are lost wherever its thread is not
/// scheduled at once, LCM drops the images, and the times that follow tell.
TEST_F(LcmUdp, CountsTheImagesThatASmallReceiveBufferLoses) {
  options_.lockstep = false;
  const LcmPair pair = testing::make_udp_pair({}, options_, options_.url + "&recv_buf_size=4096");
  const auto frames = varied_frames(5, 1280, 960);
  constexpr int kMostFrames = 300;
  int sent = 0;
  double lost = 0.0;
  while (lost == 0.0 && sent < kMostFrames) {
    VoFrame frame = frames[static_cast<std::size_t>(sent) % frames.size()];
    frame.index = sent;
    frame.t_ns = frame_time_ns(sent, FrameRate{});
    auto estimate = pair.door->track(frame);
    ASSERT_TRUE(estimate.ok()) << estimate.error().message;
    lost += estimate->counters["images_lost"];
    ++sent;
  }
  EXPECT_GE(lost, 1.0);
  EXPECT_EQ(static_cast<double>(pair.far_end->images().size()) + lost, sent);
}

TEST_F(LcmUdp, SaysThatTheSessionHasEnded) {
  LcmPair pair = testing::make_udp_pair({}, options_, options_.url);
  ASSERT_TRUE(pair.door->track(varied_frames(1).front()).ok());
  pair.door.reset();
  const auto patience = std::chrono::steady_clock::now() + std::chrono::seconds(10);
  while (!pair.far_end->ended() && std::chrono::steady_clock::now() < patience) {
    std::this_thread::yield();
  }
  EXPECT_TRUE(pair.far_end->ended());
}

TEST_F(LcmUdp, BeginsAnotherSessionWithTheNextRun) {
  LcmPair pair = testing::make_udp_pair({}, options_, options_.url);
  fly(*pair.door, 3);
  pair.door.reset();
  pair.door = create_lcm_estimator(options_).value();
  const auto again = fly(*pair.door, 2);
  EXPECT_EQ(again[0].sample.state, TrackingState::kInitialising);
  EXPECT_EQ(pair.far_end->sessions(), 2);
}

TEST_F(LcmUdp, KeepsTwoEstimatorsApartByTheirPrefixes) {
  LcmEstimatorOptions other = options_;
  other.channel_prefix += "2_";
  const LcmPair first = testing::make_udp_pair({}, options_, options_.url);
  const LcmPair second = testing::make_udp_pair({}, other, options_.url);
  for (const VoFrame& frame : varied_frames(3)) {
    ASSERT_TRUE(first.door->track(frame).ok());
    const auto estimate = second.door->track(frame);
    ASSERT_TRUE(estimate.ok());
    EXPECT_FALSE(estimate->counters.contains("answers_unknown"));
  }
  EXPECT_EQ(first.far_end->images().size(), 3U);
  EXPECT_EQ(second.far_end->images().size(), 3U);
}

TEST_F(LcmUdp, RefusesChannelsThatAnotherEstimatorHas) {
  const auto first = create_lcm_estimator(options_);
  ASSERT_TRUE(first.ok()) << first.error().message;
  LcmEstimatorOptions second = options_;
  second.url += "&recv_buf_size=4000000";  // the same network
  const auto refused = create_lcm_estimator(second);
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().code, ErrorCode::kConflict);
}

/// Channels and images of a log, read by LCM itself.
struct ReadLog {
  std::vector<std::string> channels;
  std::vector<overfly_lcm::image_t> images;
};

ReadLog read_log(const std::filesystem::path& file) {
  ReadLog read;
  ::lcm::LogFile log(file.string(), "r");
  EXPECT_TRUE(log.good());
  while (const ::lcm::LogEvent* event = log.readNextEvent()) {
    read.channels.push_back(event->channel);
    if (event->channel != "OVERFLY_IMAGE") continue;
    read.images.emplace_back();
    EXPECT_GT(read.images.back().decode(event->data, 0, event->datalen), 0);
  }
  return read;
}

class LcmFile : public ::testing::Test {
 protected:
  /// Flies without lockstep into a log.
  void record(const std::vector<VoFrame>& frames) {
    LcmEstimatorOptions options;
    options.url = "file://" + file_.string() + "?mode=w";
    options.lockstep = false;
    const auto door = create_lcm_estimator(options);
    ASSERT_TRUE(door.ok()) << door.error().message;
    for (const VoFrame& frame : frames) {
      const auto estimate = (*door)->track(frame);
      ASSERT_TRUE(estimate.ok()) << estimate.error().message;
      EXPECT_EQ(estimate->sample.state, TrackingState::kInitialising);
      EXPECT_THAT(estimate->counters, ElementsAre(Pair("unanswered", 1.0)));
    }
  }

  testing::TemporaryFolder folder_;
  std::filesystem::path file_ = folder_.path() / "door.lcm";
};

TEST_F(LcmFile, RecordsWhatTheDoorPublishes) {
  const auto frames = varied_frames(2, 320, 240);
  record(frames);
  const ReadLog log = read_log(file_);
  EXPECT_THAT(log.channels,
              ElementsAre("OVERFLY_CALIBRATION",
                          "OVERFLY_IMAGE",
                          "OVERFLY_TIME",
                          "OVERFLY_IMAGE",
                          "OVERFLY_TIME",
                          "OVERFLY_TIME"));
  ASSERT_EQ(log.images.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(log.images[i].data, frames[i].image->data);
    EXPECT_EQ(log.images[i].t_ns, frames[i].t_ns);
  }
}

TEST_F(LcmFile, IsPlayedToAnEstimatorByLcm) {
  const auto frames = varied_frames(4);
  record(frames);
  const auto node =
      lcm::Node::open(lcm::parse_url("file://" + file_.string() + "?speed=0").value()).value();
  testing::LcmTestEstimator estimator(node, "OVERFLY_", {});
  node->start();
  const auto patience = std::chrono::steady_clock::now() + std::chrono::seconds(10);
  while (!estimator.ended() && std::chrono::steady_clock::now() < patience) {
    std::this_thread::yield();
  }
  ASSERT_EQ(estimator.images().size(), 4U);
  EXPECT_EQ(estimator.images().back().data, frames.back().image->data);
  node->stop();
}

/// A log is played to an estimator that only knows the channels.
TEST(LcmLogWriter, WritesWhatTheDoorWouldHaveSaid) {
  const testing::TemporaryFolder folder;
  const auto file = folder.path() / "a.lcm";
  const auto frames = varied_frames(5);
  {
    const auto writer = lcm::LogWriter::create(file, 0).value();
    for (const VoFrame& frame : frames) {
      ASSERT_TRUE(writer->write_calibration("OVERFLY_", "c", {frame.intrinsics}, frame.t_ns).ok());
      ASSERT_TRUE(writer->write_image("OVERFLY_", {frame.index, frame.t_ns, 0, *frame.image}).ok());
    }
  }
  const auto node =
      lcm::Node::open(lcm::parse_url("file://" + file.string() + "?speed=0").value()).value();
  testing::LcmTestEstimator estimator(node, "OVERFLY_", {});
  node->start();
  const auto patience = std::chrono::steady_clock::now() + std::chrono::seconds(10);
  while (estimator.images().size() < frames.size() && std::chrono::steady_clock::now() < patience) {
    std::this_thread::yield();
  }
  node->stop();
  ASSERT_EQ(estimator.images().size(), frames.size());
  EXPECT_EQ(estimator.images().back().data, frames.back().image->data);
  EXPECT_EQ(estimator.sessions(), 1) << "a repeated calibration starts no session";
}

TEST_F(LcmFile, IsOfOneEstimatorAtATime) {
  LcmEstimatorOptions options;
  options.url = "file://" + file_.string() + "?mode=w";
  options.lockstep = false;
  options.channel_prefix = "MINE_";
  {
    const auto door = create_lcm_estimator(options);
    ASSERT_TRUE(door.ok()) << door.error().message;
    const auto second = create_lcm_estimator(options);
    ASSERT_FALSE(second.ok());
    EXPECT_EQ(second.error().code, ErrorCode::kConflict);
    EXPECT_THAT(second.error().message, ::testing::HasSubstr("channel_prefix = \"MINE_\""));
    EXPECT_THAT(second.error().message, ::testing::HasSubstr("file://" + file_.string()));
  }
  EXPECT_TRUE(create_lcm_estimator(options).ok()) << "one run after another may have it";
}

TEST_F(LcmFile, ThatCannotBeMadeIsAnError) {
  LcmEstimatorOptions options;
  options.url = "file://" + (folder_.path() / "none" / "x.lcm").string() + "?mode=w";
  options.lockstep = false;
  const auto door = create_lcm_estimator(options);
  ASSERT_FALSE(door.ok());
  EXPECT_EQ(door.error().code, ErrorCode::kIo);
}

}  // namespace
}  // namespace overfly
