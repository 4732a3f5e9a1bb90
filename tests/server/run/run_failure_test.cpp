// Runs that end by an exception: too little memory, a thread that cannot be started, a fault of a
// library. Each ends as failed with its reason, and the program continues.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <chrono>
#include <functional>
#include <new>
#include <system_error>
#include <thread>
#include <vector>

#include "server/files/whole_file.hpp"
#include "server/record/run_folder.hpp"
#include "server/record/run_info_file.hpp"
#include "server/record/run_lock.hpp"
#include "server/run/run_options.hpp"
#include "server/run/run_recorder.hpp"
#include "server/runs/run_memory.hpp"
#include "tests/server/support/manager_fixture.hpp"
#include "vo_bridges/vo_port.hpp"

namespace overfly::server {
namespace {

namespace fs = std::filesystem;
using overfly::testing::TemporaryFolder;
using ::testing::HasSubstr;

/// Leaves this process two more files to open, as long as it lives.
class FewFiles {
 public:
  FewFiles() {
    ::getrlimit(RLIMIT_NOFILE, &before_);
    rlimit few = before_;
    few.rlim_cur = 256;
    ::setrlimit(RLIMIT_NOFILE, &few);
    for (int file = 0; file >= 0;) {
      file = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
      if (file >= 0) files_.push_back(file);
    }
    for (int i = 0; i < 2; ++i) close_one();
  }
  ~FewFiles() {
    while (!files_.empty()) close_one();
    ::setrlimit(RLIMIT_NOFILE, &before_);
  }
  FewFiles(const FewFiles&) = delete;
  FewFiles& operator=(const FewFiles&) = delete;

 private:
  void close_one() {
    ::close(files_.back());
    files_.pop_back();
  }

  rlimit before_{};
  std::vector<int> files_;
};

[[noreturn]] void throw_bad_alloc() { throw std::bad_alloc(); }
[[noreturn]] void throw_no_thread() {
  throw std::system_error(std::make_error_code(std::errc::resource_unavailable_try_again));
}
[[noreturn]] void throw_other() { throw std::runtime_error("a library's fault"); }

struct Failure {
  std::function<void()> raise;
  std::string told;
};

std::vector<Failure> failures() {
  return {{throw_bad_alloc, "not enough memory"},
          {throw_no_thread, "Resource temporarily unavailable"},
          {throw_other, "a library's fault"}};
}

/// Checks the folder of a run that failed for this reason.
void expect_failed(const fs::path& folder, const std::string& told) {
  const auto info = read_run_info(folder);
  ASSERT_TRUE(info.ok()) << info.error().message;
  EXPECT_EQ(info->status, RunStatus::kFailed);
  EXPECT_THAT(info->error, HasSubstr(told));
  EXPECT_FALSE(RunLock::held(folder));
  const auto rows = read_lines(log_file(folder));
  ASSERT_TRUE(rows.ok() && !rows->empty());
  EXPECT_EQ(rows->back().at("level"), "error");
  EXPECT_THAT(rows->back().at("text").get<std::string>(), HasSubstr(told));
}

TEST(RunFailure, ExceptionOfTheRendererEndsTheRun) {
  for (const Failure& failure : failures()) {
    const TemporaryFolder folder;
    RunOptions options;
    options.folder = folder.path() / "r";
    options.renderer_factory = [&](auto) -> Result<std::unique_ptr<renderer::Renderer>> {
      failure.raise();
      return Error{};
    };
    const auto run = run_scenario(testing::small_scenario(), options);
    ASSERT_FALSE(run.ok());
    EXPECT_THAT(run.error().message, HasSubstr(failure.told));
    expect_failed(options.folder, failure.told);
  }
}

TEST(RunFailure, ExceptionWhereAnEstimatorIsMadeEndsTheRun) {
  for (const Failure& failure : failures()) {
    const TemporaryFolder folder;
    RunOptions options;
    options.folder = folder.path() / "r";
    options.renderer_factory = testing::noop_factory();
    options.estimator_factory = [&](const EstimatorSpec&) -> Result<std::unique_ptr<VoPort>> {
      failure.raise();
      return Error{};
    };
    const auto scenario =
        testing::small_scenario({R"(estimators=[{"name":"p","type":"perfect"}])"});
    ASSERT_FALSE(run_scenario(scenario, options).ok());
    expect_failed(options.folder, failure.told);
  }
}

TEST(RunFailure, ExceptionInFlightEndsTheRunAfterItsLastFrame) {
  const TemporaryFolder folder;
  RunOptions options;
  options.folder = folder.path() / "r";
  options.renderer_factory = testing::noop_factory();
  options.progress = [&](const RunInfo& info) {
    // Kept free for the end of the manifest.
    EXPECT_EQ(fs::file_size(RunLock::file_of(options.folder)), 256U << 10U);
    if (info.frames == 5) throw_bad_alloc();
  };
  const auto scenario = testing::small_scenario({R"(estimators=[{"name":"p","type":"perfect"}])"});
  ASSERT_FALSE(run_scenario(scenario, options).ok());
  expect_failed(options.folder, "not enough memory");
  EXPECT_EQ(read_run_info(options.folder).value().frames, 5);
  EXPECT_TRUE(fs::exists(metrics_file(options.folder)));
}

class RunFailureOfManager : public testing::ManagerTest {};

TEST_F(RunFailureOfManager, ManagerGoesOnAfterEachFailure) {
  int made = 0;
  RunManagerOptions failing = options();
  failing.renderer_factory = [&](std::shared_ptr<const terrain::TileSource> tiles)
      -> Result<std::unique_ptr<renderer::Renderer>> {
    const auto all = failures();
    if (static_cast<std::size_t>(made) < all.size()) all[made++].raise();
    return renderer::create_noop_renderer(std::move(tiles));
  };
  const auto runs = std::move(RunManager::create(failing).value());
  for (const Failure& failure : failures()) {
    const std::string id = runs->start("small", perfect()).value().id;
    const RunInfo failed = wait_for_end(*runs, id);
    EXPECT_EQ(failed.status, RunStatus::kFailed);
    EXPECT_THAT(failed.error, HasSubstr(failure.told));
    EXPECT_TRUE(fs::exists(metrics_file(folder_of(id))));
    EXPECT_TRUE(runs->run(id).value().results.empty()) << "says nothing about its estimator";
    EXPECT_TRUE(runs->remove(id).ok());
  }
  const std::string id = runs->start("small", {}).value().id;
  EXPECT_EQ(wait_for_end(*runs, id).status, RunStatus::kCompleted);
}

/// As on a full disk: neither rows nor the manifest can be written.
TEST_F(RunFailureOfManager, EndThatCannotBeWrittenIsKnownAndLogged) {
  std::string logged;
  RunManagerOptions logging = options();
  logging.log = [&](const std::string& level, const std::string& text) {
    logged += level + ": " + text + "\n";
  };
  std::string id;
  {
    const auto runs = std::move(RunManager::create(logging).value());
    std::vector<Override> recording = endless();
    recording.push_back({"recording.frames", true});
    id = runs->start("small", recording).value().id;
    wait_for_first_frame(*runs->timeline(id).value());
    fs::create_directory(manifest_file(folder_of(id)).string() + ".part");
    fs::rename(folder_of(id) / "frames", folder_of(id) / "away");
    const RunInfo failed = wait_for_end(*runs, id);
    EXPECT_EQ(failed.status, RunStatus::kFailed);
    EXPECT_THAT(failed.error, HasSubstr("frames"));
    // The thread that flew the run notes it a moment later.
    for (int i = 0; i < 2000 && runs->run(id).value().status != RunStatus::kFailed; ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    EXPECT_EQ(runs->run(id).value().error, failed.error);
    EXPECT_EQ(runs->runs().front()->status, RunStatus::kFailed);
  }
  EXPECT_THAT(logged, HasSubstr("error: run " + id + " failed: "));
  EXPECT_EQ(read_run_info(folder_of(id)).value().status, RunStatus::kInterrupted);
}

TEST_F(RunFailureOfManager, FlightWhoseEndCannotBeWrittenHasNotCompleted) {
  const auto runs = std::move(RunManager::create(options()).value());
  const std::string id =
      runs->start("small", {{"duration_s", 2}, {"pacing", "real_time"}}).value().id;
  wait_for_first_frame(*runs->timeline(id).value());
  fs::create_directory(manifest_file(folder_of(id)).string() + ".part");
  const RunInfo failed = wait_for_end(*runs, id);
  EXPECT_EQ(failed.status, RunStatus::kFailed);
  EXPECT_THAT(failed.error, HasSubstr("manifest.json"));
}

TEST(RunMemory, GrowsWithCamerasPixelsAndChannels) {
  const auto images_of = [](const std::string& cameras) {
    return memory_of(testing::small_scenario({"cameras=" + cameras})).images_bytes;
  };
  const std::string small = R"({"name":"a","width_px":1024,"height_px":1024})";
  const std::string colour = R"({"name":"a","width_px":1024,"height_px":1024,"color":"rgb"})";
  const std::string large = R"({"name":"a","width_px":2048,"height_px":2048})";
  const std::string second = R"({"name":"b","width_px":1024,"height_px":1024})";
  const auto one = images_of("[" + small + "]");
  EXPECT_GE(one, 2U << 20U) << "at least the image in the making and the one that is shown";
  EXPECT_EQ(images_of("[" + large + "]"), 4 * one);
  EXPECT_GT(images_of("[" + colour + "]"), 2 * one);
  EXPECT_GE(images_of("[" + small + "," + second + "]"), one + (2U << 20U));
  const auto with = memory_of(testing::small_scenario(
      {"cameras=[" + small + "]", R"(estimators=[{"name":"p","type":"perfect"}])"}));
  EXPECT_GT(with.images_bytes, one);
}

TEST(RunMemory, RefusalNamesFieldValueAndLimit) {
  std::string cameras;
  for (int i = 0; i < 8; ++i) {
    cameras += std::string(i == 0 ? "" : ",") + R"({"name":"c)" + std::to_string(i) +
               R"(","width_px":8192,"height_px":8192,"color":"rgb"})";
  }
  const Scenario scenario = testing::small_scenario({"cameras=[" + cameras + "]"});
  constexpr std::uint64_t kGib = std::uint64_t{1} << 30U;
  EXPECT_GT(memory_of(scenario).images_bytes, 2 * kGib) << "as was measured";
  const Status refused = MemoryBudget(2 * kGib, true).check(scenario);
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().code, ErrorCode::kUnsupported);
  EXPECT_THAT(refused.error().message, HasSubstr("cameras = 8 of up to 8192 x 8192 px in colour"));
  EXPECT_THAT(refused.error().message, HasSubstr("of the limit of 2048 MiB"));
  EXPECT_TRUE(MemoryBudget(64 * kGib, true).check(scenario).ok());
  EXPECT_TRUE(MemoryBudget(kGib, true).check(testing::small_scenario()).ok());
  EXPECT_GT(machine_memory_bytes(), kGib / 4);
}

TEST_F(RunFailureOfManager, RunThatNeedsTooMuchMemoryIsRefused) {
  RunManagerOptions little = options();
  little.memory_limit_bytes = std::uint64_t{64} << 20U;
  const auto runs = std::move(RunManager::create(little).value());
  StartReport report;
  const auto refused =
      runs->start("small", {{"camera.width_px", 4096}, {"camera.height_px", 4096}}, {}, &report);
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(report.refusal, StartReport::Refusal::kMemory);
  EXPECT_TRUE(fs::is_empty(root() / "runs"));
  EXPECT_EQ(wait_for_end(*runs, runs->start("small", {}).value().id).status, RunStatus::kCompleted);
}

/// Two runs that fit only one at a time fly one after the other, although two may fly at a time.
TEST_F(RunFailureOfManager, RunsWaitForEachOthersMemory) {
  RunManagerOptions two = options();
  two.max_parallel_runs = 2;
  const Scenario scenario = testing::small_scenario();
  // Half of the limit is for the caches; the images of one run take most of the rest.
  two.memory_limit_bytes = 3 * memory_of(scenario).images_bytes;
  const auto runs = std::move(RunManager::create(two).value());
  const std::string first = runs->start("small", endless()).value().id;
  wait_for_first_frame(*runs->timeline(first).value());
  const std::string second = runs->start("small", {}).value().id;
  // A worker is free: with enough memory it would have drawn a frame of the second run before the
  // first one has this many more.
  const auto timeline = runs->timeline(first).value();
  const std::size_t enough = timeline->frame_count() + 500;
  for (std::uint64_t seen = 0; timeline->frame_count() < enough;) {
    seen = timeline->wait_for_change(seen, 1000);
  }
  EXPECT_EQ(runs->run(second).value().status, RunStatus::kQueued);
  EXPECT_TRUE(runs->cancel(first).ok());
  EXPECT_EQ(wait_for_end(*runs, second).status, RunStatus::kCompleted);
}

TEST(RunFailure, ARunThatCannotBeginLeavesNothingThatLooksLikeOne) {
  const TemporaryFolder folder;
  const Scenario scenario = testing::small_scenario();
  {
    const FewFiles few;
    const auto recorder = RunRecorder::create(folder.path() / "r", scenario, nullptr, false);
    ASSERT_FALSE(recorder.ok());
    EXPECT_THAT(recorder.error().message, HasSubstr("Too many open files"));
  }
  EXPECT_TRUE(fs::is_empty(folder.path() / "r"));
  EXPECT_TRUE(RunRecorder::create(folder.path() / "r", scenario, nullptr, false).ok());
}

}  // namespace
}  // namespace overfly::server
