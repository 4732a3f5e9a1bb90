// Run folders with changed, damaged or truncated files: they are listed with what is wrong, without
// an exception.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <utility>

#include "evaluation/evaluation.hpp"
#include "server/files/whole_file.hpp"
#include "server/record/run_folder.hpp"
#include "server/record/run_info_file.hpp"
#include "server/run/run_options.hpp"
#include "server/runs/run_manager.hpp"
#include "server/timeline/row_alignment.hpp"
#include "server/timeline/run_timeline.hpp"
#include "tests/server/support/server_fixture.hpp"

namespace overfly::server {
namespace {

namespace fs = std::filesystem;
using overfly::testing::TemporaryFolder;
using ::testing::HasSubstr;
using Json = nlohmann::json;

/// A run with two cameras and two estimators, flown once for all tests, and a manager that lists
/// it.
class RunDamage : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    place_ = new TemporaryFolder();
    fs::create_directories(place_->path() / "scenarios");
    RunOptions options;
    options.folder = run();
    options.renderer_factory = testing::noop_factory();
    const Scenario scenario = testing::small_scenario(
        {"duration_s=0.4",
         R"(cameras=[{"name":"a","width_px":64,"height_px":48,"rate_hz":10},{"name":"b","width_px":64,"height_px":48,"rate_hz":10}])",
         R"(estimators=[{"name":"p","type":"perfect"},{"name":"d","type":"drifting","camera":"b"}])"});
    const auto flown = run_scenario(scenario, options);
    ASSERT_TRUE(flown.ok()) << flown.error().message;
  }
  static void TearDownTestSuite() { delete std::exchange(place_, nullptr); }

  void SetUp() override {
    RunManagerOptions options;
    options.runs_folder = place_->path() / "runs";
    options.scenarios_folder = place_->path() / "scenarios";
    options.renderer_factory = testing::noop_factory();
    manager_ = std::move(RunManager::create(options).value());
  }

  static fs::path run() { return place_->path() / "runs" / "r"; }

  /// The run as it is listed now; every test expects it in the list.
  RunInfo listed() const {
    const RunList runs = manager_->runs();
    EXPECT_EQ(runs.size(), 1U);
    return runs.empty() ? RunInfo() : *runs.front();
  }

  /// Opens the run and reads all that a viewer reads.
  void open_and_read() const {
    const auto timeline = RunTimeline::open(run());
    if (!timeline) {
      EXPECT_EQ(timeline.error().code, ErrorCode::kUnreadable) << timeline.error().message;
      EXPECT_THAT(timeline.error().message, HasSubstr("json"));
      return;
    }
    for (std::size_t i = 0; i < (*timeline)->estimators().size(); ++i) {
      for (const auto mode : evaluation::all_alignment_modes()) {
        (void)RowAlignment::of(**timeline, i, evaluation::to_string(mode));
      }
      (void)(*timeline)->estimates(i, 0, 100);
    }
    (void)(*timeline)->statuses();
    (void)(*timeline)->frame_at(0);
  }

  /// Replaces the file by `text` while `look` runs.
  static void with_text(const fs::path& file,
                        const std::string& text,
                        const std::function<void()>& look) {
    const std::string whole = overfly::testing::read_text(file);
    ASSERT_TRUE(write_whole(file, text).ok());
    look();
    ASSERT_TRUE(write_whole(file, whole).ok());
  }

  const RunManager& manager() const { return *manager_; }

 private:
  static TemporaryFolder* place_;
  std::unique_ptr<RunManager> manager_;
};

TemporaryFolder* RunDamage::place_ = nullptr;

/// The JSON pointers of every value of a document, including arrays and objects.
std::vector<Json::json_pointer> pointers_of(const Json& document) {
  std::vector<Json::json_pointer> pointers;
  const std::function<void(const Json&, const Json::json_pointer&)> add =
      [&](const Json& value, const Json::json_pointer& at) {
        if (!at.empty()) pointers.push_back(at);
        if (value.is_object()) {
          for (const auto& [name, field] : value.items()) add(field, at / name);
        }
        // Elements of an array are alike: only the first is used.
        if (value.is_array() && !value.empty()) add(value.front(), at / 0);
      };
  add(document, Json::json_pointer());
  return pointers;
}

/// Values to replace another with.
std::vector<Json> other_values() {
  return {nullptr,
          "../../../etc/passwd",
          -1,
          std::numeric_limits<std::uint64_t>::max(),
          1e300,
          Json::array({nullptr, Json::object()})};
}

std::vector<Json> mutations_of(const Json& document, const std::vector<Json>& values) {
  std::vector<Json> mutations;
  for (const Json::json_pointer& pointer : pointers_of(document)) {
    for (const Json& value : values) {
      Json changed = document;
      changed[pointer] = value;
      mutations.push_back(std::move(changed));
    }
    Json without = document;
    Json& parent = without[pointer.parent_pointer()];
    if (!parent.is_object()) continue;
    parent.erase(pointer.back());
    mutations.push_back(std::move(without));
  }
  return mutations;
}

TEST_F(RunDamage, EveryFieldOfEveryDocumentMayBeWrong) {
  for (const fs::path& file : {manifest_file(run()), timings_file(run()), metrics_file(run())}) {
    const Json document = read_json(file).value();
    int count = 0;
    const bool is_listed = file == manifest_file(run());
    // Only few of the many figures are read back.
    const std::vector<Json> values =
        is_listed ? other_values() : std::vector<Json>{nullptr, "../../../etc/passwd"};
    for (const Json& changed : mutations_of(document, values)) {
      with_text(file, changed.dump(), [&] {
        if (is_listed) {
          EXPECT_EQ(listed().id, "r") << changed.dump();
        }
        open_and_read();
      });
      ++count;
    }
    EXPECT_GT(count, 50) << file;
  }
}

TEST_F(RunDamage, EveryFieldOfTheScenarioMayBeWrong) {
  const Json document = read_json(scenario_file(run())).value();
  for (const Json& changed : mutations_of(document, {nullptr, 1e300})) {
    with_text(scenario_file(run()), changed.dump(), [&] {
      EXPECT_EQ(listed().status, RunStatus::kCompleted);
      (void)manager().scenario_of("r");
    });
  }
}

TEST_F(RunDamage, EveryFieldOfEveryRowMayBeWrong) {
  for (const fs::path& file : {CameraFiles::of_main_camera(run()).rows(),
                               CameraFiles(run(), 1, "b").rows(),
                               estimate_file(run(), "p"),
                               log_file(run())}) {
    const std::string whole = overfly::testing::read_text(file);
    const std::size_t end = whole.find('\n');
    const Json row = Json::parse(whole.substr(0, end));
    for (const Json& changed : mutations_of(row, other_values())) {
      with_text(file, changed.dump() + whole.substr(end), [&] { open_and_read(); });
    }
  }
  EXPECT_EQ(listed().problem, "");
}

TEST_F(RunDamage, EveryDocumentMayBeCutShortOrBeSomethingElse) {
  for (const fs::path& file : {manifest_file(run()),
                               scenario_file(run()),
                               timings_file(run()),
                               metrics_file(run()),
                               CameraFiles::of_main_camera(run()).rows(),
                               estimate_file(run(), "p"),
                               log_file(run())}) {
    const std::string whole = overfly::testing::read_text(file);
    const std::string texts[] = {"",
                                 whole.substr(0, 1),
                                 whole.substr(0, whole.size() / 2),
                                 "[]\n",
                                 "null\n",
                                 "\"text\"\n",
                                 "12\n",
                                 std::string(64, '\0'),
                                 "\xff\xfe{}\n"};
    for (const std::string& text : texts) {
      with_text(file, text, [&] {
        EXPECT_EQ(listed().id, "r") << file;
        open_and_read();
      });
    }
  }
}

TEST_F(RunDamage, ListNamesFileAndField) {
  const Json manifest = read_json(manifest_file(run())).value();
  for (const char* field : {"format_version",
                            "status",
                            "scenario",
                            "title",
                            "duration_ns",
                            "frames",
                            "frames_total",
                            "pacing",
                            "estimators",
                            "cameras",
                            "world"}) {
    Json changed = manifest;
    changed[field] = false;
    with_text(manifest_file(run()), changed.dump(), [&] {
      const RunInfo info = listed();
      EXPECT_THAT(info.problem, HasSubstr("manifest.json")) << field;
      EXPECT_THAT(info.problem, HasSubstr(field));
      EXPECT_EQ(info.created_utc.substr(0, 2), "20") << "the rest is read";
    });
  }
  EXPECT_EQ(listed().problem, "");
  with_text(manifest_file(run()), "{", [&] {
    EXPECT_EQ(listed().status, RunStatus::kUnreadable);
    EXPECT_THAT(listed().problem, HasSubstr("manifest.json, line 1"));
  });
  Json odd = manifest;
  odd["status"] = "done";
  with_text(manifest_file(run()), odd.dump(), [&] {
    EXPECT_EQ(listed().status, RunStatus::kUnreadable);
    EXPECT_THAT(listed().problem, HasSubstr("status = \"done\": must be running, completed"));
  });
}

TEST_F(RunDamage, TimeOfCreationMayBeWrong) {
  for (const Json& wrong : other_values()) {
    with_text(created_file(run()), Json{{"created_utc", wrong}}.dump(), [&] {
      const auto info = read_run_info(run());
      ASSERT_TRUE(info.ok());
      EXPECT_EQ(info->status, RunStatus::kCompleted);
      EXPECT_THAT(info->problem, HasSubstr("created.json: created_utc = "));
      EXPECT_EQ(listed().id, "r");
    });
  }
}

/// A run can be played without its derived files; the problem is reported.
TEST_F(RunDamage, RunWithoutReadableTimingsOrMetricsPlays) {
  for (const fs::path& file : {timings_file(run()), metrics_file(run())}) {
    with_text(file, "[", [&] {
      const auto opened = RunTimeline::open(run());
      ASSERT_TRUE(opened.ok()) << opened.error().message;
      EXPECT_EQ((*opened)->frame_count(), 5U);
      EXPECT_THAT((*opened)->info().problem, HasSubstr(file.filename().string()));
    });
  }
}

}  // namespace
}  // namespace overfly::server
