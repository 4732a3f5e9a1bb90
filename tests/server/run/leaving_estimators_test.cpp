// However a run ends, its estimators end before its folder is unlocked.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <vector>

#include "server/files/whole_file.hpp"
#include "server/record/run_folder.hpp"
#include "server/record/run_info_file.hpp"
#include "server/record/run_lock.hpp"
#include "server/run/run_options.hpp"
#include "tests/server/support/server_fixture.hpp"

namespace overfly::server {
namespace {

namespace fs = std::filesystem;
using overfly::testing::TemporaryFolder;
using ::testing::Each;
using ::testing::HasSubstr;
using ::testing::SizeIs;

/// Records at its end whether its run still holds the folder's lock. Draws a debug image of any
/// frame.
class Leaver final : public VoPort {
 public:
  Leaver(fs::path folder, std::vector<bool>& held) : folder_(std::move(folder)), held_(held) {}
  ~Leaver() override { held_.push_back(RunLock::held(folder_)); }
  Leaver(const Leaver&) = delete;
  Leaver& operator=(const Leaver&) = delete;
  std::string type() const override { return "leaver"; }
  std::map<std::string, std::string> effective_parameters() const override {
    return {{"threshold", "7"}};
  }
  Result<VoEstimate> track(const VoFrame& frame) override {
    VoEstimate estimate;
    estimate.sample.frame = frame.index;
    estimate.sample.t_ns = frame.t_ns;
    estimate.debug_image = *frame.image;
    return estimate;
  }
  void set_debug(bool /*wanted*/) override {}

 private:
  fs::path folder_;
  std::vector<bool>& held_;
};

class LeavingEstimators : public ::testing::Test {
 protected:
  LeavingEstimators() {
    options_.folder = folder_.path() / "r";
    options_.renderer_factory = testing::noop_factory();
  }
  void fly_leavers() {
    options_.estimator_factory = [&](const EstimatorSpec& spec) -> Result<std::unique_ptr<VoPort>> {
      if (spec.name == "bad") return Error{ErrorCode::kInvalidArgument, "bad: is not to be made"};
      return std::unique_ptr<VoPort>(std::make_unique<Leaver>(options_.folder, held_));
    };
  }
  /// From the fifth frame on no debug image can be written.
  void break_the_recorder() {
    options_.progress = [this](const RunInfo& info) {
      if (info.frames != 5) return;
      fs::remove_all(options_.folder / "debug");
      overfly::testing::write_text(options_.folder / "debug", "in the way");
    };
  }
  Result<RunResult> flown(const std::string& estimators) {
    return run_scenario(
        testing::small_scenario({"estimators=" + estimators, "recording.debug_hz=100"}), options_);
  }

  TemporaryFolder folder_;
  RunOptions options_;
  std::vector<bool> held_;
};

constexpr const char* kTwo = R"([{"name":"a","type":"feature"},{"name":"b","type":"feature"}])";

TEST_F(LeavingEstimators, AtTheEndOfTheFlight) {
  fly_leavers();
  EXPECT_TRUE(flown(kTwo).ok());
  EXPECT_THAT(held_, SizeIs(2));
  EXPECT_THAT(held_, Each(true));
}

TEST_F(LeavingEstimators, WhenWhatTheySayCannotBeRecorded) {
  fly_leavers();
  break_the_recorder();
  const auto run = flown(kTwo);
  ASSERT_FALSE(run.ok());
  EXPECT_THAT(run.error().message, HasSubstr("debug"));
  EXPECT_THAT(held_, SizeIs(2));
  EXPECT_THAT(held_, Each(true));
  EXPECT_EQ(read_run_info(options_.folder)->status, RunStatus::kFailed);
}

TEST_F(LeavingEstimators, WhenAnotherCannotBeMade) {
  fly_leavers();
  const auto run = flown(R"([{"name":"a","type":"feature"},{"name":"bad","type":"feature"}])");
  ASSERT_FALSE(run.ok());
  EXPECT_EQ(run.error().message, "bad: is not to be made");
  EXPECT_THAT(held_, SizeIs(1));
  EXPECT_THAT(held_, Each(true));
}

TEST_F(LeavingEstimators, WhenTheRunIsCancelled) {
  fly_leavers();
  std::atomic<bool> cancel = false;
  options_.cancel = &cancel;
  options_.progress = [&](const RunInfo& info) { cancel = info.frames > 3; };
  const auto run = flown(kTwo);
  ASSERT_TRUE(run.ok()) << run.error().message;
  EXPECT_EQ(run->info.status, RunStatus::kCancelled);
  EXPECT_THAT(held_, SizeIs(2));
  EXPECT_THAT(held_, Each(true));
}

TEST_F(LeavingEstimators, ProcessesStillAtWorkAreEndedFirst) {
  const fs::path script = folder_.path() / "leaver.py";
  const std::string client = overfly::testing::source_file("vo_bridges/client").string();
  // It ends when the connection closes and reports what it then finds two folders up.
  overfly::testing::write_text(script,
                               "import fcntl, os, sys\n"
                               "sys.path.insert(0, '" +
                                   client + "')\n" +
                                   R"(import overfly_vo
class Leaver(overfly_vo.Estimator):
    name = 'leaver'
    def calibrate(self, calibration): pass
    def track(self, frame):
        picture = (frame.width_px, frame.height_px, 1, frame.pixels)
        return overfly_vo.Answer(debug_image=picture if frame.debug_wanted else None)
try:
    overfly_vo.run(Leaver())
finally:
    try:
        fcntl.flock(open('../../.running'), fcntl.LOCK_SH | fcntl.LOCK_NB)
        found = 'free'
    except BlockingIOError:
        found = 'held'
    except OSError as error:
        found = str(error)
    open('../../../found_' + os.path.basename(os.getcwd()), 'w').write(found)
)");
  break_the_recorder();
  const std::string command =
      R"("type":"process","command":["python3",")" + script.string() + "\"]}";
  const auto run = flown(R"([{"name":"p",)" + command + R"(,{"name":"q",)" + command + "]");
  ASSERT_FALSE(run.ok());
  EXPECT_THAT(run.error().message, HasSubstr("debug"));
  EXPECT_EQ(overfly::testing::read_text(folder_.path() / "found_p"), "held");
  EXPECT_EQ(overfly::testing::read_text(folder_.path() / "found_q"), "held");
}

}  // namespace
}  // namespace overfly::server
