// Runs of sweeps, which a server shows under the ids SWEEP.RUN.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/record/run_folder.hpp"
#include "server/runs/run_places.hpp"
#include "tests/server/support/manager_fixture.hpp"

namespace overfly::server {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr const char* kRun = "0123456789abcdef0123";

TEST(RunPlaces, TellsRunsOfSweepsFromOthersByTheirIds) {
  const overfly::testing::TemporaryFolder folder;
  const fs::path runs = folder.path() / "runs";
  const RunPlaces places(runs, {"/sweeps"});
  const std::string id = std::string("night.1.") + kRun;
  EXPECT_EQ(places.of(id), fs::path("/sweeps/night.1/runs") / kRun);
  EXPECT_EQ(places.in_group(id)->group, "/sweeps/night.1");
  for (const char* other : {"course-20261125",
                            "0123456789abcdef0123",
                            "a.0123456789abcdef012",
                            "a.0123456789ABCDEF0123",
                            "a-0123456789abcdef0123"}) {
    EXPECT_EQ(places.of(other), runs / other);
    EXPECT_FALSE(places.in_group(other)) << other;
  }
  EXPECT_EQ(RunPlaces(runs, {""}).of(id), runs / id) << "no folder of sweeps";
  fs::create_directories(runs / id);
  EXPECT_EQ(places.of(id), runs / id) << "the folder of runs precedes";
}

class SweepRuns : public testing::ManagerTest {
 protected:
  SweepRuns() : id_(std::string("night.") + kRun) {
    const std::string flown = fly(*manager());
    fs::create_directories(sweeps() / "night/runs");
    fs::rename(folder_of(flown), sweeps() / "night/runs" / kRun);
  }
  [[nodiscard]] fs::path sweeps() const { return root() / "sweeps"; }
  [[nodiscard]] std::unique_ptr<RunManager> showing_manager() const {
    RunManagerOptions showing = options();
    showing.sweeps_folder = sweeps();
    showing.data_folders = std::vector<fs::path>{root()};
    return std::move(RunManager::create(showing).value());
  }
  const std::string id_;
};

TEST_F(SweepRuns, ArePlayedButNotListed) {
  const auto runs = showing_manager();
  EXPECT_THAT(runs->runs(), IsEmpty());
  EXPECT_EQ(runs->run(id_).value().id, id_);
  EXPECT_EQ(runs->run(id_).value().status, RunStatus::kCompleted);
  const auto timeline = runs->timeline(id_).value();
  EXPECT_EQ(timeline->info().id, id_);
  EXPECT_EQ(timeline->frame_count(), 21);
  EXPECT_EQ(runs->folder(id_).value(), sweeps() / "night/runs" / kRun);
  EXPECT_TRUE(runs->document_of(id_).ok());
}

TEST_F(SweepRuns, StayWhereTheyAre) {
  const auto runs = showing_manager();
  const Status removed = runs->remove(id_);
  ASSERT_FALSE(removed.ok());
  EXPECT_EQ(removed.error().code, ErrorCode::kConflict);
  EXPECT_THAT(removed.error().message, HasSubstr("belongs to a sweep"));
  EXPECT_TRUE(fs::exists(manifest_file(sweeps() / "night/runs" / kRun)));
  EXPECT_EQ(runs->cancel(id_).error().code, ErrorCode::kConflict);
}

TEST_F(SweepRuns, AreAbsentWithoutTheirFolder) {
  EXPECT_EQ(manager()->run(id_).error().code, ErrorCode::kNotFound);
  EXPECT_EQ(manager()->timeline(id_).error().code, ErrorCode::kNotFound);
  const auto runs = showing_manager();
  for (const char* other : {"day.0123456789abcdef0123",
                            "night.1123456789abcdef0123",
                            "...0123456789abcdef0123",
                            "../night.0123456789abcdef0123"}) {
    EXPECT_EQ(runs->run(other).error().code, ErrorCode::kNotFound) << other;
    EXPECT_EQ(runs->timeline(other).error().code, ErrorCode::kNotFound) << other;
  }
}

/// A scenario must not name what others flew.
TEST_F(SweepRuns, AreNoDataOfScenarios) {
  const auto runs = showing_manager();
  const SourcePolicy sources = runs->data_folders().sources;
  EXPECT_FALSE(sources.check(sweeps() / "night/runs" / kRun / "manifest.json", "file").ok());
  EXPECT_TRUE(sources.check(root() / "scenarios/small.json", "file").ok());
}

}  // namespace
}  // namespace overfly::server
