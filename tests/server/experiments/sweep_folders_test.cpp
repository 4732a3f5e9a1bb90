// What a folder of sweeps tells a client.
#include "server/experiments/sweep_folders.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/experiments/sweep_progress.hpp"
#include "server/record/run_lock.hpp"
#include "tests/support/support.hpp"

namespace overfly::server::experiments {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using overfly::testing::TemporaryFolder;
using overfly::testing::write_text;

constexpr const char* kSweep = R"({"title": "Two heights", "estimator_names": ["feature", 3],
  "repeats": {"most": 4}, "version": "1 abc",
  "axes": [{"path": "h", "label": "Height", "unit": "m"}, {"name": "air"}, 5],
  "axis_values": {"h": [50, 100], "air": ["calm"]}})";

TEST(SweepFolders, ListsSweepsNewestFirst) {
  const TemporaryFolder folder;
  for (const char* name : {"a", "b", "c"}) {
    fs::create_directories(folder.path() / name);
    write_text(folder.path() / name / "sweep.json", kSweep);
  }
  write_text(folder.path() / "b/results.jsonl", "");
  const auto later = fs::last_write_time(folder.path() / "c/sweep.json") + std::chrono::hours(1);
  fs::last_write_time(folder.path() / "b/results.jsonl", later);
  fs::last_write_time(folder.path() / "a/sweep.json", later - std::chrono::hours(2));
  fs::create_directories(folder.path() / "none");
  fs::create_directories(folder.path() / "broken");
  write_text(folder.path() / "broken/sweep.json", "{");
  std::vector<std::string> names;
  const Json list = sweep_list(folder.path());
  for (const Json& entry : list.at("sweeps")) names.push_back(entry["name"]);
  EXPECT_EQ(names, (std::vector<std::string>{"b", "c", "a"}));
  EXPECT_TRUE(sweep_list(folder.path() / "absent").at("sweeps").empty());
  EXPECT_TRUE(sweep_list("").at("sweeps").empty());
}

TEST(SweepFolders, TellsAxesAndProgress) {
  const TemporaryFolder folder;
  const fs::path sweep = folder.path() / "s";
  fs::create_directories(sweep);
  write_text(sweep / "sweep.json", kSweep);
  Json entry = sweep_entry(folder.path(), "s").value();
  EXPECT_EQ(entry["title"], "Two heights");
  EXPECT_EQ(entry["estimators"], Json::array({"feature"}));
  EXPECT_EQ(entry["repeats"], 4);
  EXPECT_EQ(entry["axes"],
            Json::parse(R"([{"name": "h", "label": "Height", "unit": "m", "values": [50, 100]},
                            {"name": "air", "label": "air", "unit": "", "values": ["calm"]}])"));
  EXPECT_EQ(entry["flying"], false);
  EXPECT_EQ(entry["progress"], nullptr);
  SweepProgress progress;
  ASSERT_TRUE(write_progress(sweep, progress).ok());
  EXPECT_EQ(sweep_entry(folder.path(), "s").value()["progress"]["left_s"], nullptr) << "unknown";
  progress.passed = 3;
  progress.most = 8;
  progress.left_s = 12.5;
  ASSERT_TRUE(write_progress(sweep, progress).ok());
  const auto lock = RunLock::take(sweep);
  ASSERT_TRUE(lock.ok());
  entry = sweep_entry(folder.path(), "s").value();
  EXPECT_EQ(entry["flying"], true);
  EXPECT_EQ(entry["progress"]["passed"], 3);
  EXPECT_EQ(entry["progress"]["most"], 8);
  EXPECT_EQ(entry["progress"]["left_s"], 12.5);
}

TEST(SweepFolders, AFolderOfSomethingElseDoesNotBecomeASweep) {
  const TemporaryFolder folder;
  const fs::path out = folder.path() / "out";
  EXPECT_TRUE(check_sweep_folder(out).ok()) << "absent";
  fs::create_directories(out / "runs");
  write_text(out / ".running", "");
  EXPECT_TRUE(check_sweep_folder(out).ok()) << "a sweep that was killed at its start";
  write_text(out / "manifest.json", "{}");
  const Status refused = check_sweep_folder(out);
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().code, ErrorCode::kConflict);
  EXPECT_THAT(refused.error().message, ::testing::HasSubstr("it has manifest.json"));
  write_text(out / "sweep.json", "{}");
  EXPECT_TRUE(check_sweep_folder(out).ok());
}

TEST(SweepFolders, AHuntAndASweepDoNotShareAFolder) {
  const TemporaryFolder folder;
  const fs::path sweep = folder.path() / "sweep";
  const fs::path hunt = folder.path() / "hunt";
  const fs::path study = folder.path() / "study";
  EXPECT_TRUE(check_hunt_folder(hunt).ok()) << "absent";
  for (const fs::path& each : {sweep, hunt, study}) fs::create_directories(each / "runs");
  EXPECT_TRUE(check_hunt_folder(hunt).ok()) << "without other files";
  write_text(sweep / "sweep.json", "{}");
  write_text(hunt / "sweep.json", "{}");
  write_text(hunt / "hunt.json", "{}");
  write_text(study / "study.json", "{}");
  EXPECT_TRUE(check_hunt_folder(hunt).ok());
  EXPECT_TRUE(check_hunt_folder(study).ok());
  const Status of_sweep = check_hunt_folder(sweep);
  ASSERT_FALSE(of_sweep.ok());
  EXPECT_EQ(of_sweep.error().code, ErrorCode::kConflict);
  EXPECT_THAT(of_sweep.error().message, ::testing::HasSubstr("is the folder of a sweep"));
  const Status of_hunt = check_sweep_folder(hunt);
  ASSERT_FALSE(of_hunt.ok());
  EXPECT_THAT(of_hunt.error().message, ::testing::HasSubstr("is the folder of a hunt"));
  fs::remove(sweep / "sweep.json");
  write_text(sweep / "manifest.json", "{}");
  const Status of_run = check_hunt_folder(sweep);
  ASSERT_FALSE(of_run.ok());
  EXPECT_THAT(of_run.error().message,
              ::testing::HasSubstr("is no folder of a hunt (hunt.json is missing), and not empty"));
}

TEST(SweepFolders, SurvivesDamagedFiles) {
  const TemporaryFolder folder;
  const fs::path sweep = folder.path() / "s";
  fs::create_directories(sweep);
  for (const char* damaged :
       {"{}",
        R"({"title": 1, "axes": {}, "repeats": [], "estimator_names": "x"})",
        R"({"axes": [{"path": 7}], "axis_values": [], "repeats": {"most": "many"}})"}) {
    write_text(sweep / "sweep.json", damaged);
    write_text(sweep / "progress.json", damaged);
    const auto entry = sweep_entry(folder.path(), "s");
    ASSERT_TRUE(entry.ok()) << damaged;
    EXPECT_EQ((*entry)["repeats"], 1);
    EXPECT_EQ((*entry)["progress"], nullptr);
  }
  write_text(sweep / "sweep.json", "[]");
  EXPECT_EQ(sweep_entry(folder.path(), "s").error().code, ErrorCode::kUnreadable);
  for (const char* name : {"none", "", "..", "../s", "s/../s"}) {
    EXPECT_EQ(sweep_entry(folder.path(), name).error().code, ErrorCode::kNotFound) << name;
  }
}

}  // namespace
}  // namespace overfly::server::experiments
