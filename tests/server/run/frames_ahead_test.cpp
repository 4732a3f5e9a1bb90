// Lockstep flights that make frames ahead of their estimators: how far, and that the record does
// not depend on it.
#include "server/run/frames_ahead.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <stdexcept>
#include <thread>

#include "server/files/whole_file.hpp"
#include "server/record/run_folder.hpp"
#include "server/run/run_options.hpp"
#include "tests/server/run/witness_run.hpp"
#include "tests/server/support/wrapped_renderer.hpp"

namespace overfly::server {
namespace {

using overfly::testing::TemporaryFolder;
using testing::small_scenario;

constexpr const char* kTwoSlow =
    R"(estimators=[{"name":"a","type":"feature"},{"name":"b","type":"feature"}])";

/// Counts the images, and fails at one of them.
class Counting final : public testing::WrappedRenderer {
 public:
  struct Shared {
    std::atomic<int> images{0};
    int fails_at = -1;
    bool throws = false;
  };
  using Renderer::render_camera;
  Counting(std::unique_ptr<renderer::Renderer> inner, Shared& shared)
      : WrappedRenderer(std::move(inner)), shared_(shared) {}
  Result<renderer::CameraFrame> render_camera(const renderer::CameraRequest& request) override {
    if (shared_.images++ == shared_.fails_at) {
      if (shared_.throws) throw std::runtime_error("a library's fault");
      return Error{ErrorCode::kIo, "the disk is gone"};
    }
    return inner().render_camera(request);
  }

 private:
  Shared& shared_;
};

/// Calls a function before each answer, and says a line of its own about every third frame.
class Slow final : public VoPort {
 public:
  explicit Slow(std::function<void(std::int64_t)> before) : before_(std::move(before)) {}
  std::string type() const override { return "slow"; }
  std::map<std::string, std::string> effective_parameters() const override { return {}; }
  Result<VoEstimate> track(const VoFrame& frame) override {
    if (before_) before_(frame.index);
    VoEstimate estimate;
    estimate.sample.state = frame.index % 5 == 0 ? TrackingState::kLost : TrackingState::kTracking;
    estimate.sample.T_vo_camera.translation.x() = static_cast<double>(frame.index);
    if (frame.index % 3 == 0) said_.push_back("frame " + std::to_string(frame.index));
    return estimate;
  }
  void set_debug(bool /*wanted*/) override {}
  std::vector<std::string> take_log() override { return std::exchange(said_, {}); }

 private:
  std::function<void(std::int64_t)> before_;
  std::vector<std::string> said_;
};

struct Flight {
  TemporaryFolder folder;
  Counting::Shared drawn;
  std::map<std::string, std::function<void(std::int64_t)>> before;  ///< by estimator
  std::atomic<bool> cancel{false};
  RunOptions options;

  Flight() {
    options.folder = folder.path() / "r";
    options.cancel = &cancel;
    options.renderer_factory = [this](std::shared_ptr<const terrain::TileSource> tiles) {
      return Result<std::unique_ptr<renderer::Renderer>>(
          std::make_unique<Counting>(renderer::create_noop_renderer(std::move(tiles)), drawn));
    };
    options.estimator_factory = [this](const EstimatorSpec& spec) {
      return Result<std::unique_ptr<VoPort>>(std::make_unique<Slow>(before[spec.name]));
    };
  }
  std::size_t lines_of(const std::filesystem::path& file) const {
    return read_lines(file).value().size();
  }
};

TEST(FramesAhead, AreLimitedByNumberAndMemory) {
  const auto of = [](std::vector<std::string> overrides, const char* camera) {
    overrides.push_back(std::string("cameras=[{\"name\":\"a\",") + camera + "}]");
    return lockstep_frames_ahead(small_scenario(overrides));
  };
  EXPECT_EQ(of({kTwoSlow}, R"("width_px":1280,"height_px":960)"), kMostFramesAhead);
  EXPECT_EQ(of({kTwoSlow}, R"("width_px":4096,"height_px":4096)"), 2U);
  EXPECT_EQ(of({kTwoSlow}, R"("width_px":8192,"height_px":8192)"), 0U);
  EXPECT_EQ(of({kTwoSlow}, R"("width_px":2048,"height_px":2048,"color":"rgb")"), 2U);
  EXPECT_EQ(of({kTwoSlow, "pacing=real_time"}, R"("width_px":1280,"height_px":960)"), 0U);
  EXPECT_EQ(of({}, R"("width_px":1280,"height_px":960)"), 0U) << "nobody to wait for";
}

/// An estimator that takes its time for the first frame lets the flight go on up to the limit.
TEST(FramesAhead, AreMadeWhileAnEstimatorWorksUpToTheLimit) {
  Flight flight;
  const Scenario scenario = small_scenario({kTwoSlow, "duration_s=4"});
  // The frame in progress, those that wait, and one whose record waits for an answer.
  const int most = 2 + static_cast<int>(lockstep_frames_ahead(scenario));
  int made = 0;
  flight.before["b"] = [&](std::int64_t frame) {
    if (frame != 0) return;
    for (int i = 0; i < 5000 && flight.drawn.images < most; ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    made = flight.drawn.images;
  };
  const auto run = run_scenario(scenario, flight.options);
  ASSERT_TRUE(run.ok()) << run.error().message;
  EXPECT_EQ(made, most);
  EXPECT_EQ(run->info.frames, 41);
}

/// However long the estimators take, the files are those of a flight without any waiting.
TEST(FramesAhead, DoNotChangeTheRecord) {
  const std::vector<std::string> overrides = {
      kTwoSlow,
      R"(faults=[{"kind":"dropped_frames","at_s":0.35,"duration_s":0.2},{"kind":"frozen_frame","at_s":0.95,"duration_s":0.3}])",
      R"(sensors={"imu":{"rate_hz":50}})",
      "recording.frames=true",
      "duration_s=4"};
  std::vector<std::vector<std::pair<std::string, std::string>>> records;
  for (const int slow : {0, 1, 2}) {
    Flight flight;
    for (const char* name : {"a", "b"}) {
      const int own = name[0] == 'a' ? 1 : 2;
      flight.before[name] = [=](std::int64_t frame) {
        const std::int64_t ms = slow == 0 ? 0 : (frame * 7 * own + slow) % 5 == 0 ? 12 : frame % 3;
        std::this_thread::sleep_for(std::chrono::milliseconds(ms));
      };
    }
    const auto run = run_scenario(small_scenario(overrides), flight.options);
    ASSERT_TRUE(run.ok()) << run.error().message;
    records.push_back(testing::contents_without_timings(flight.options.folder));
  }
  ASSERT_GT(records[0].size(), 25U);
  EXPECT_EQ(records[0], records[1]);
  EXPECT_EQ(records[0], records[2]);
}

TEST(FramesAhead, AFrameThatCannotBeMadeEndsTheFlightAfterTheFramesBeforeIt) {
  for (const bool throws : {false, true}) {
    Flight flight;
    flight.drawn.fails_at = 7;
    flight.drawn.throws = throws;
    flight.before["a"] = [](std::int64_t) {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    };
    const auto run = run_scenario(small_scenario({kTwoSlow}), flight.options);
    ASSERT_FALSE(run.ok());
    EXPECT_THAT(run.error().message,
                ::testing::HasSubstr(throws ? "a library's fault" : "the disk is gone"));
    const auto frames = CameraFiles(flight.options.folder, kMainCamera, "a").rows();
    EXPECT_EQ(flight.lines_of(frames), 7U);
    if (throws) continue;
    EXPECT_EQ(flight.lines_of(estimate_file(flight.options.folder, "a")), 7U);
    EXPECT_EQ(flight.lines_of(estimate_file(flight.options.folder, "b")), 7U);
  }
}

/// The answers to frames that were made ahead of the last recorded one are not recorded.
TEST(FramesAhead, CancelEndsTheRecordWithTheAnswersToItsLastFrame) {
  Flight flight;
  const auto wait_for = [](const std::function<bool()>& condition) {
    for (int i = 0; i < 5000 && !condition(); ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  };
  std::atomic<int> tracked{0};
  flight.before["a"] = [&](std::int64_t frame) {
    tracked = static_cast<int>(frame);
    // Frames wait, and b is ahead of a.
    if (frame == 3) wait_for([&] { return flight.drawn.images >= 12; });
    if (frame < 5) return;
    wait_for([&] { return flight.cancel.load(); });
    std::this_thread::sleep_for(std::chrono::milliseconds(100));  // to forget the waiting frames
  };
  flight.options.progress = [&](const RunInfo& info) {
    if (info.frames == 5) flight.cancel = true;
  };
  const auto run = run_scenario(small_scenario({kTwoSlow}), flight.options);
  ASSERT_TRUE(run.ok()) << run.error().message;
  EXPECT_EQ(run->info.status, RunStatus::kCancelled);
  EXPECT_EQ(run->info.frames, 5);
  for (const char* name : {"a", "b"}) {
    EXPECT_EQ(flight.lines_of(estimate_file(flight.options.folder, name)), 5U) << name;
  }
  EXPECT_LE(tracked, 6) << "waiting frames are forgotten";
}

}  // namespace
}  // namespace overfly::server
