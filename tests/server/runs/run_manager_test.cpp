// The runs of a server: start, queue, list, cancel, removal, and what a restart finds.
#include "server/runs/run_manager.hpp"
#include "server/record/run_info_file.hpp"
#include "server/record/run_lock.hpp"
#include "server/timeline/run_timeline.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/files/whole_file.hpp"
#include "server/record/run_folder.hpp"
#include "server/scenario/document/scenario_file.hpp"
#include "server/scenario/document/scenario_override.hpp"
#include "tests/server/support/manager_fixture.hpp"

namespace overfly::server {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class RunManagerTest : public testing::ManagerTest {
 protected:
  using ManagerTest::manager;
  [[nodiscard]] std::unique_ptr<RunManager> trusting_manager() const {
    RunManagerOptions trusting = options();
    trusting.allow_commands = true;
    return std::move(RunManager::create(trusting).value());
  }

  /// As a server sets it: clients may only name files in the data folders.
  [[nodiscard]] std::unique_ptr<RunManager> confined_manager(
      std::vector<fs::path> data_folders) const {
    RunManagerOptions confined = options();
    confined.data_folders = std::move(data_folders);
    return std::move(RunManager::create(confined).value());
  }
};

TEST_F(RunManagerTest, AnswersAboutAFolderOfDeepJson) {
  const auto runs = manager();
  const std::string deep = std::string(100'000, '[') + std::string(100'000, ']');
  const RunInfo done = wait_for_end(*runs, runs->start("small", perfect()).value().id);
  const fs::path folder = runs->folder(done.id).value();
  overfly::testing::write_text(metrics_file(folder), deep);
  const auto timeline = RunTimeline::open(folder);
  ASSERT_TRUE(timeline.ok()) << "the run plays without its metrics";
  EXPECT_THAT((*timeline)->info().problem, HasSubstr("metrics.json: is nested more than 64 deep"));
  overfly::testing::write_text(scenario_file(folder), deep);
  EXPECT_THAT(load_scenario(scenario_file(folder)).error().message,
              HasSubstr("scenario.json: is nested more than 64 deep"));
  overfly::testing::write_text(manifest_file(folder), deep);
  const RunList listed = manager()->runs();
  ASSERT_EQ(listed.size(), 1U);
  EXPECT_EQ(listed[0]->status, RunStatus::kUnreadable);
  EXPECT_THAT(listed[0]->problem, HasSubstr("manifest.json: is nested more than 64 deep"));
}

TEST_F(RunManagerTest, FliesOverFilesInsideOfItsDataFoldersOnly) {
  const std::string outside = ": must be a file inside of the server's data folders";
  const auto bare = confined_manager({});
  EXPECT_THAT(bare->start("small", {}).error().message,
              HasSubstr("world.manifest = " + testing::small_world().string() + outside));
  EXPECT_THAT(bare->library().list().at(0).error, HasSubstr(outside));
  const auto runs = confined_manager({testing::small_world().parent_path()});
  EXPECT_EQ(runs->library().list().at(0).error, "");
  const auto started = runs->start("small", perfect());
  ASSERT_TRUE(started.ok()) << started.error().message;
  EXPECT_EQ(wait_for_end(*runs, started->id).status, RunStatus::kCompleted);
  // A run's own files are not data, even if the folder of runs is in a data folder.
  const auto among = confined_manager({root(), testing::small_world().parent_path()});
  const std::string planted = scenario_file(runs->folder(started->id).value()).string();
  EXPECT_THAT(among->start("small", {{"world.manifest", planted}}).error().message,
              HasSubstr(planted + outside));
}

TEST_F(RunManagerTest, OpensOnlyTheLinksThatTheOperatorAllows) {
  nlohmann::json document = testing::small_document();
  document["flight"] = {{"mavlink", {{"link", "tcp:127.0.0.1:1"}, {"patience_s", 0.1}}}};
  overfly::testing::write_text(root() / "scenarios" / "live.json", document.dump());
  EXPECT_THAT(manager()->start("live", {}).error().message,
              HasSubstr("the server was not started with --allow-link tcp:127.0.0.1:1"));
  RunManagerOptions allowing = options();
  allowing.allowed_links = {"tcp:127.0.0.1:1"};
  const auto runs = std::move(RunManager::create(allowing).value());
  const auto started = runs->start("live", {});
  ASSERT_TRUE(started.ok()) << started.error().message;
  EXPECT_EQ(wait_for_end(*runs, started->id).status, RunStatus::kFailed);  // nobody listens
  // Another link, or what the vehicle has to do, only as in the scenario's file.
  EXPECT_TRUE(runs->library().load_to_fly("live", {{"duration_s", 1}}).ok());
  const auto arming = runs->library().load_to_fly("live", {{"flight.mavlink.arm_and_start", true}});
  EXPECT_EQ(arming.error().code, ErrorCode::kForbidden);
  EXPECT_THAT(arming.error().message,
              HasSubstr("flight.mavlink: must be as in the scenario's file"));
  EXPECT_EQ(runs->start("small", {{"flight.mavlink.link", "tcp:127.0.0.1:1"}}).error().code,
            ErrorCode::kForbidden);
}

/// A document with any field of `lcm` has the default URL filled in.
TEST_F(RunManagerTest, TheDefaultNetworkOfLcmIsOpenToClients) {
  const auto runs = std::move(RunManager::create(options()).value());
  const auto load = [&](const char* lcm) {
    const nlohmann::json estimator = {
        {"name", "x"}, {"type", "lcm"}, {"lcm", nlohmann::json::parse(lcm)}};
    return runs->library().load_to_fly("small",
                                       {{"estimators", nlohmann::json::array({estimator})}});
  };
  EXPECT_TRUE(load(R"({"channel_prefix": "MINE_"})").ok());
  EXPECT_EQ(load(R"({"url": "udpm://239.255.76.68:7667?ttl=1"})").error().code,
            ErrorCode::kForbidden);
}

TEST_F(RunManagerTest, TakesTheFolderDataOfScenarioFilesForDeclared) {
  nlohmann::json document = testing::small_document();
  document["world"] = {{"manifest", testing::small_world().filename().string()}};
  document["data"] = testing::small_world().parent_path().string();
  overfly::testing::write_text(root() / "scenarios" / "named.json", document.dump());
  const auto runs = confined_manager({});
  const auto started = runs->start("named", perfect());
  ASSERT_TRUE(started.ok()) << started.error().message;
  EXPECT_EQ(wait_for_end(*runs, started->id).status, RunStatus::kCompleted);
  EXPECT_TRUE(runs->scenario_of(started->id).ok());
  // Neither an override nor the copy in a run folder may declare data folders.
  EXPECT_FALSE(runs->start("named", {{"data", "/etc"}, {"world.manifest", "passwd"}}).ok());
  fs::remove(root() / "scenarios" / "named.json");
  EXPECT_THAT(runs->start("small", {}).error().message, HasSubstr("data folders"));
}

TEST_F(RunManagerTest, ListsAFolderWhoseManifestCannotBeReadWithTheReason) {
  for (const char* target : {"/proc/self/mem", "/dev/zero"}) {
    const fs::path folder = root() / "runs" / "bad";
    fs::create_directories(folder);
    fs::create_symlink(target, manifest_file(folder));
    const RunList listed = manager()->runs();
    ASSERT_EQ(listed.size(), 1U) << target;
    EXPECT_EQ(listed[0]->status, RunStatus::kUnreadable);
    EXPECT_THAT(listed[0]->problem, HasSubstr("manifest.json"));
    fs::remove_all(folder);
  }
}

TEST_F(RunManagerTest, FliesAScenarioAndFindsItAgainInANewProcess) {
  std::string id;
  {
    const auto runs = manager();
    const auto started = runs->start("small", perfect());
    ASSERT_TRUE(started.ok()) << started.error().message;
    id = started->id;
    EXPECT_THAT(id, HasSubstr("small"));
    const RunInfo done = wait_for_end(*runs, id);
    EXPECT_EQ(done.status, RunStatus::kCompleted) << done.error;
    EXPECT_EQ(done.id, id);
    EXPECT_EQ(runs->world_of(id).value()->tiles->attribution(), done.attribution);
  }
  const auto runs = manager();
  ASSERT_EQ(runs->runs().size(), 1U);
  EXPECT_EQ(runs->runs()[0]->id, id);
  EXPECT_EQ(runs->runs()[0]->estimators, std::vector<std::string>{"p"});
  EXPECT_EQ(runs->run(id).value().frames, 21);
  const auto timeline = runs->timeline(id);
  ASSERT_TRUE(timeline.ok()) << timeline.error().message;
  EXPECT_EQ((*timeline)->frame_count(), 21U);
  EXPECT_EQ(runs->timeline(id).value(), *timeline) << "read only once";
  EXPECT_TRUE(runs->world_of(id).ok());
  EXPECT_TRUE(runs->remove(id).ok());
  EXPECT_THAT(runs->runs(), IsEmpty());
  EXPECT_EQ(runs->remove(id).error().code, ErrorCode::kNotFound);
}

TEST_F(RunManagerTest, SameIdempotencyKeyGivesTheSameRun) {
  const auto runs = manager();
  const std::string first = runs->start("small", {}, {"k"}).value().id;
  EXPECT_EQ(runs->start("small", {}, {"k"}).value().id, first);
  const std::string other = runs->start("small", {}, {"k2"}).value().id;
  EXPECT_NE(other, first);
  wait_for_end(*runs, other);
}

TEST_F(RunManagerTest, QueuedRunWaitsCanBeCancelledAndRemoved) {
  const auto runs = manager();
  const std::string first = runs->start("small", endless()).value().id;
  const std::string second = runs->start("small", {}).value().id;
  wait_for_first_frame(*runs->timeline(first).value());
  EXPECT_EQ(runs->timeline(second).value()->info().status, RunStatus::kQueued);
  EXPECT_EQ(runs->remove(second).error().code, ErrorCode::kConflict);
  EXPECT_TRUE(runs->cancel(second).ok());
  EXPECT_EQ(runs->timeline(second).value()->info().status, RunStatus::kCancelled);
  EXPECT_EQ(runs->cancel(second).error().code, ErrorCode::kConflict);
  EXPECT_TRUE(runs->remove(second).ok());
  EXPECT_TRUE(runs->cancel(first).ok());
  EXPECT_EQ(wait_for_end(*runs, first).status, RunStatus::kCancelled);
  EXPECT_EQ(runs->cancel(first).error().code, ErrorCode::kConflict);
}

TEST_F(RunManagerTest, DestructorCancelsWhatFlies) {
  std::string id;
  {
    const auto runs = manager();
    id = runs->start("small", endless()).value().id;
    wait_for_first_frame(*runs->timeline(id).value());
  }
  EXPECT_EQ(read_run_info(root() / "runs" / id).value().status, RunStatus::kCancelled);
}

TEST_F(RunManagerTest, RunLeftByAKilledProcessIsInterrupted) {
  const auto runs = manager();
  const std::string id = runs->start("small", perfect()).value().id;
  wait_for_end(*runs, id);
  // After a kill: "running" in the manifest, no lock, a truncated line, no derived files.
  const fs::path killed = root() / "runs" / "killed";
  fs::copy(root() / "runs" / id, killed, fs::copy_options::recursive);
  auto manifest = read_json(manifest_file(killed)).value();
  manifest["status"] = "running";
  overfly::testing::write_text(manifest_file(killed), manifest.dump());
  overfly::testing::write_text(killed / ".running", "");
  fs::remove(metrics_file(killed));
  const std::string frames =
      overfly::testing::read_text(CameraFiles::of_main_camera(killed).rows());
  overfly::testing::write_text(CameraFiles::of_main_camera(killed).rows(),
                               frames.substr(0, frames.size() - 40));

  const auto timeline = runs->timeline("killed");
  ASSERT_TRUE(timeline.ok()) << timeline.error().message;
  EXPECT_EQ((*timeline)->info().status, RunStatus::kInterrupted);
  EXPECT_EQ((*timeline)->frame_count(), 20U);
  EXPECT_EQ((*timeline)->estimate_count(0), 20U) << "one whose frame is lost is left out";
  EXPECT_EQ((*timeline)->info().frames, 20);
  EXPECT_TRUE(runs->remove("killed").ok());
}

TEST_F(RunManagerTest, RunThatAnotherProcessWritesIsRunningAndStays) {
  const auto runs = manager();
  const std::string id = runs->start("small", {}).value().id;
  wait_for_end(*runs, id);
  const fs::path other = root() / "runs" / "other";
  fs::copy(root() / "runs" / id, other, fs::copy_options::recursive);
  auto manifest = read_json(manifest_file(other)).value();
  manifest["status"] = "running";
  overfly::testing::write_text(manifest_file(other), manifest.dump());
  const RunLock lock = std::move(RunLock::take(other)).value();
  EXPECT_EQ(runs->timeline("other").value()->info().status, RunStatus::kRunning);
  EXPECT_EQ(runs->remove("other").error().code, ErrorCode::kConflict);
  EXPECT_EQ(runs->set_notes("other", {}).error().code, ErrorCode::kConflict);
  EXPECT_EQ(RunLock::take(other).error().code, ErrorCode::kConflict);
}

TEST_F(RunManagerTest, RefusesWhatItDoesNotKnow) {
  const auto runs = manager();
  EXPECT_EQ(runs->start("no", {}).error().code, ErrorCode::kNotFound);
  EXPECT_EQ(runs->start("../small", {}).error().code, ErrorCode::kNotFound);
  const auto bad = runs->start("small", {{"camera.fov_deg", 190}});
  EXPECT_EQ(bad.error().code, ErrorCode::kInvalidArgument);
  EXPECT_THAT(bad.error().message, HasSubstr("camera.fov_deg = 190"));
  EXPECT_EQ(runs->folder("..").error().code, ErrorCode::kNotFound);
  EXPECT_EQ(runs->folder("a/b").error().code, ErrorCode::kNotFound);
  EXPECT_EQ(runs->timeline("no").error().code, ErrorCode::kNotFound);
  EXPECT_EQ(runs->library().document("small").value().at("camera").at("width_px"), 160);
  ASSERT_EQ(runs->library().list().size(), 1U);
}

/// A run of a file on the server's disk may be repeated, but not with other names in it.
TEST_F(RunManagerTest, ClientsMayUseTheCommandsOfScenarioFilesOnly) {
  nlohmann::json document = testing::small_document();
  document["estimators"] = nlohmann::json::parse(
      R"([{"name":"a","type":"process","command":["./vo","--fast"]},{"name":"b","type":"feature"}])");
  overfly::testing::write_text(root() / "scenarios" / "doors.json", document.dump());
  const auto runs = manager();
  const auto check = [&](const char* text) {
    return runs->library().load_to_fly("doors", {parse_override(text).value()});
  };
  EXPECT_TRUE(check("duration_s=1").ok());
  EXPECT_TRUE(check(R"(estimators.0.parameters={"features":1000})").ok());
  EXPECT_TRUE(
      check(R"(estimators.1={"name":"c","type":"process","command":["./vo","--fast"]})").ok());
  const auto other = check(R"(estimators.0.command=["./vo","--slow"])");
  ASSERT_FALSE(other.ok());
  EXPECT_THAT(other.error().message, HasSubstr("estimators.0.command"));
  EXPECT_FALSE(check(R"(estimators.0.command.0="/bin/sh")").ok());
  EXPECT_TRUE(trusting_manager()
                  ->library()
                  .load_to_fly("doors", {parse_override(R"(estimators.0.command=["x"])").value()})
                  .ok());
}

}  // namespace
}  // namespace overfly::server
