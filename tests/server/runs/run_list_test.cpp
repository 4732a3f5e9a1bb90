// The list of runs is kept in memory and always agrees with the folder.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "server/files/whole_file.hpp"
#include "server/record/run_folder.hpp"
#include "server/record/run_info.hpp"
#include "server/record/run_lock.hpp"
#include "server/runs/run_notes.hpp"
#include "server/scoring/run_metrics_json.hpp"
#include "tests/server/support/manager_fixture.hpp"

namespace overfly::server {
namespace {

namespace fs = std::filesystem;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

class RunListTest : public testing::ManagerTest {
 protected:
  /// A copy of a completed run, as another program leaves it, with its own creation time.
  void copy_run(const std::string& id, const std::string& to, const std::string& created_utc) {
    fs::copy(folder_of(id), folder_of(to), fs::copy_options::recursive);
    overfly::testing::write_text(created_file(folder_of(to)),
                                 nlohmann::json{{"created_utc", created_utc}}.dump());
  }
  void change_manifest(const std::string& id, const std::string& field, const std::string& value) {
    nlohmann::json manifest = read_json(manifest_file(folder_of(id))).value();
    manifest[field] = value;
    ASSERT_TRUE(write_json(manifest_file(folder_of(id)), manifest).ok());
  }
};

TEST_F(RunListTest, SeesWhatOtherProgramsAddChangeAndRemove) {
  const auto runs = manager();
  const std::string id = fly(*runs);
  copy_run(id, "older", "2020-01-01T00:00:00Z");
  copy_run(id, "newer", "2100-01-01T00:00:00.000Z");
  EXPECT_THAT(ids_of(runs->runs()), ElementsAre("newer", id, "older"));
  change_manifest("older", "title", "Another title");
  EXPECT_EQ(runs->runs()[2]->title, "Another title");
  EXPECT_EQ(runs->run("older").value().title, "Another title");
  change_manifest("older", "title", "A third title");
  EXPECT_EQ(runs->run("older").value().title, "A third title");
  EXPECT_EQ(runs->runs()[2]->title, "A third title");
  fs::remove_all(folder_of("newer"));
  EXPECT_THAT(ids_of(runs->runs()), ElementsAre(id, "older"));
  EXPECT_EQ(runs->run("newer").error().code, ErrorCode::kNotFound);
  fs::create_directories(folder_of("later"));
  EXPECT_EQ(runs->runs().size(), 2U) << "no run without a manifest";
  EXPECT_EQ(runs->run("later").error().code, ErrorCode::kNotFound);
  fs::copy(manifest_file(folder_of(id)), manifest_file(folder_of("later")));
  EXPECT_THAT(ids_of(runs->runs()), Contains("later"));
}

TEST_F(RunListTest, SharesWhatHasNotChanged) {
  const auto runs = manager();
  const std::string id = fly(*runs);
  copy_run(id, "older", "2020-01-01T00:00:00Z");
  // After a tick of the file system's clock, an unchanged stamp means an unchanged file.
  const auto listed = [&] { return runs->runs().back(); };
  auto before = listed();
  auto after = listed();
  for (; before != after; after = listed()) before = after;
  EXPECT_EQ(listed(), after) << "not read again";
  change_manifest("older", "title", "Another title");
  EXPECT_NE(listed(), after);
}

TEST_F(RunListTest, ShowsHowTheEstimatorsPerformed) {
  const std::string id = fly(*manager());
  const auto runs = manager();
  nlohmann::json metrics = read_json(metrics_file(folder_of(id))).value();
  nlohmann::json& estimator = metrics.at("estimators").at("p");
  estimator["outcome"] = "LOST";
  estimator.at("alignments").at("init_scale")["position_rmse_m"] = 3.5;
  metrics.at("flight")["path_length_m"] = 700.0;
  // As `overfly evaluate --run` does, which changes no other file.
  ASSERT_TRUE(write_json(metrics_file(folder_of(id)), metrics).ok());
  const std::vector<EstimatorResult> results = runs->run(id).value().results;
  ASSERT_EQ(results.size(), 1U);
  EXPECT_EQ(results[0].estimator, "p");
  EXPECT_EQ(results[0].outcome, evaluation::Outcome::kLost);
  EXPECT_DOUBLE_EQ(results[0].position_rmse_m.value(), 3.5);
  EXPECT_DOUBLE_EQ(results[0].position_rmse_percent.value(), 0.5);
  overfly::testing::write_text(metrics_file(folder_of(id)), "{");
  EXPECT_THAT(runs->run(id).value().problem, ::testing::HasSubstr("metrics.json"));
  EXPECT_TRUE(runs->run(id).value().results.empty());
}

TEST_F(RunListTest, ShowsWhatPeopleWroteAboutARun) {
  const std::string id = fly(*manager());
  const auto runs = manager();
  EXPECT_TRUE(runs->run(id).value().tags.empty());
  const RunNotes notes{{"baseline", "for the paper"}, "Wind from the west.\nFly again."};
  ASSERT_TRUE(runs->set_notes(id, notes).ok());
  EXPECT_EQ(runs->runs().front()->tags, notes.tags);
  EXPECT_EQ(runs->run(id).value().note, notes.note);
  ASSERT_TRUE(write_notes(folder_of(id), {{"by another program"}, ""}).ok());
  EXPECT_THAT(runs->runs().front()->tags, ElementsAre("by another program"));
  ASSERT_TRUE(runs->set_notes(id, {}).ok());
  EXPECT_FALSE(fs::exists(notes_file(folder_of(id))));
  EXPECT_TRUE(runs->run(id).value().tags.empty());
  overfly::testing::write_text(notes_file(folder_of(id)), R"({"tags":[""],"note":""})");
  EXPECT_THAT(runs->run(id).value().problem, ::testing::HasSubstr("notes.json: tags.0: must"));
  EXPECT_EQ(runs->run(id).value().status, RunStatus::kCompleted);
  EXPECT_EQ(runs->set_notes("nobody", {}).error().code, ErrorCode::kNotFound);
  EXPECT_EQ(runs->set_notes("../x", {}).error().code, ErrorCode::kNotFound);
}

TEST(RunNotes, AreRefusedBeyondTheirLimits) {
  const overfly::testing::TemporaryFolder folder;
  const std::vector<std::pair<RunNotes, std::string>> refused = {
      {{std::vector<std::string>(17, "t"), ""}, "tags: must have at most 16"},
      {{{"a", ""}, ""}, "tags.1: must have 1 to 40 bytes"},
      {{{std::string(41, 'a')}, ""}, "tags.0: must have 1 to 40 bytes"},
      {{{"a,b"}, ""}, "tags.0: must have no comma"},
      {{{" a"}, ""}, "tags.0: must have no comma"},
      {{{"a\nb"}, ""}, "tags.0: must have no comma"},
      {{{"a", "a"}, ""}, "tags.1: must differ"},
      {{{}, std::string(4001, 'x')}, "note: must have at most 4000 bytes"},
      {{{}, "a\x1b[31m"}, "note: must have no control characters"},
  };
  for (const auto& [notes, message] : refused) {
    const Status status = write_notes(folder.path(), notes);
    ASSERT_FALSE(status.ok()) << message;
    EXPECT_EQ(status.error().code, ErrorCode::kInvalidArgument);
    EXPECT_THAT(status.error().message, ::testing::HasSubstr(message));
  }
  EXPECT_FALSE(fs::exists(notes_file(folder.path())));
  EXPECT_EQ(read_notes(folder.path()).value(), RunNotes{});
}

/// Files that grow with the flight are not opened: opening a pipe would block.
TEST_F(RunListTest, ReadsNoFileThatGrowsWithTheFlight) {
  const auto runs = manager();
  const std::string id = fly(*runs);
  for (const fs::path& file : {timings_file(folder_of(id)),
                               CameraFiles::of_main_camera(folder_of(id)).rows(),
                               estimate_file(folder_of(id), "p"),
                               log_file(folder_of(id))}) {
    fs::remove(file);
    ASSERT_EQ(::mkfifo(file.c_str(), 0600), 0);
  }
  const auto again = manager();
  ASSERT_EQ(again->runs().size(), 1U);
  EXPECT_EQ(again->runs()[0]->frames, 21);
  EXPECT_EQ(again->runs()[0]->problem, "");
  EXPECT_EQ(again->run(id).value().status, RunStatus::kCompleted);
}

/// The duration of an interrupted run is that of its last row, however many rows there are.
TEST_F(RunListTest, CountsFramesOfAnInterruptedRunFromItsLastRow) {
  const auto runs = manager();
  const std::string id = fly(*runs);
  change_manifest(id, "status", "running");
  const std::string rows =
      overfly::testing::read_text(CameraFiles::of_main_camera(folder_of(id)).rows());
  fs::resize_file(CameraFiles::of_main_camera(folder_of(id)).rows(), 0);
  fs::resize_file(CameraFiles::of_main_camera(folder_of(id)).rows(),
                  std::uintmax_t{1} << 33U);  // only holes
  const int file =
      ::open(CameraFiles::of_main_camera(folder_of(id)).rows().c_str(), O_WRONLY | O_APPEND);
  ASSERT_EQ(::write(file, ("\n" + rows).data(), rows.size() + 1),
            static_cast<ssize_t>(rows.size() + 1));
  ::close(file);
  EXPECT_EQ(manager()->runs()[0]->status, RunStatus::kInterrupted);
  EXPECT_EQ(manager()->runs()[0]->frames, 21);
}

TEST_F(RunListTest, RunOfAnotherProcessRunsUntilItsLockIsFree) {
  const auto runs = manager();
  const std::string id = fly(*runs);
  copy_run(id, "other", "2100-01-01T00:00:00Z");
  change_manifest("other", "status", "running");
  {
    const RunLock lock = std::move(RunLock::take(folder_of("other"))).value();
    EXPECT_EQ(runs->runs()[0]->status, RunStatus::kRunning);
    EXPECT_EQ(runs->run("other").value().status, RunStatus::kRunning);
  }
  EXPECT_EQ(runs->runs()[0]->status, RunStatus::kInterrupted);
}

TEST_F(RunListTest, TimeOfCreationStandsInAFileOfItsOwn) {
  const auto runs = manager();
  const RunInfo asked = runs->start("small", perfect()).value();
  wait_for_end(*runs, asked.id);
  EXPECT_FALSE(read_json(timings_file(folder_of(asked.id))).value().contains("created_utc"));
  EXPECT_EQ(read_json(created_file(folder_of(asked.id))).value().at("created_utc"),
            asked.created_utc);
  EXPECT_EQ(manager()->runs()[0]->created_utc, asked.created_utc);
  // A folder of an earlier version: the time of its scenario file is its creation time.
  fs::remove(created_file(folder_of(asked.id)));
  const std::string written = manager()->runs()[0]->created_utc;
  EXPECT_EQ(written.substr(0, 15), asked.created_utc.substr(0, 15));
  EXPECT_EQ(manager()->runs()[0]->problem, "");
}

TEST_F(RunListTest, RunsThatWaitAreListedAndHaveNoFolderToRead) {
  const auto runs = manager();
  const std::string first = runs->start("small", endless()).value().id;
  const std::string second = runs->start("small", {}).value().id;
  EXPECT_THAT(ids_of(runs->runs()), ElementsAre(second, first));
  EXPECT_EQ(runs->run(second).value().status, RunStatus::kQueued);
  EXPECT_THAT(manager()->runs(), ::testing::SizeIs(::testing::Le(1U)));
  EXPECT_TRUE(runs->cancel(first).ok());
  wait_for_end(*runs, second);
}

TEST_F(RunListTest, NewMetricsReachThoseWhoWatch) {
  const auto runs = manager();
  const std::string id = fly(*runs);
  const auto timeline = runs->timeline(id).value();
  RunMetrics metrics = *timeline->metrics();
  metrics.flight.path_length_m = 1.5;
  ASSERT_TRUE(write_json(metrics_file(folder_of(id)), json_from(metrics)).ok());
  // Watchers are notified although nobody asks for the run.
  std::uint64_t seen = timeline->revision();
  while (timeline->metrics()->flight.path_length_m != 1.5) {
    seen = timeline->wait_for_change(seen, 1000);
  }
  metrics.flight.path_length_m = 2.5;
  ASSERT_TRUE(write_json(metrics_file(folder_of(id)), json_from(metrics)).ok());
  const auto asked = runs->timeline(id).value();
  EXPECT_EQ(asked, timeline) << "a watched run stays the same";
  EXPECT_EQ(asked->metrics()->flight.path_length_m, 2.5);
}

TEST_F(RunListTest, FolderPutInARunsPlaceIsReadAnew) {
  const auto runs = manager();
  const std::string id = fly(*runs);
  const auto before = runs->timeline(id).value();
  change_manifest(id, "title", "Another run");
  auto after = runs->timeline(id).value();
  // The thread that flew the run may hold its time line for a moment longer.
  while (after == before) after = runs->timeline(id).value();
  EXPECT_NE(before, after);
  EXPECT_EQ(after->info().title, "Another run");
  fs::remove_all(folder_of(id));
  EXPECT_EQ(runs->timeline(id).error().code, ErrorCode::kNotFound);
  EXPECT_THAT(runs->runs(), IsEmpty());
}

}  // namespace
}  // namespace overfly::server
