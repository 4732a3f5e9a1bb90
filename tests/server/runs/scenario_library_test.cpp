// Scenarios that clients save: names, limits, what they may contain, flights of them.
#include "server/runs/scenario_library.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/files/whole_file.hpp"
#include "tests/server/support/manager_fixture.hpp"

namespace overfly::server {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using ::testing::HasSubstr;

class ScenarioLibraryTest : public testing::ManagerTest {
 protected:
  [[nodiscard]] std::unique_ptr<RunManager> saving_manager() const {
    RunManagerOptions saving = options();
    saving.saved_scenarios_folder = saved();
    saving.data_folders = {testing::small_world().parent_path()};
    return std::move(RunManager::create(saving).value());
  }
  [[nodiscard]] fs::path saved() const { return root() / "saved"; }
  static Result<bool> save(RunManager& runs,
                           const std::string& name,
                           const Json& document = testing::small_document(),
                           bool replace = false,
                           SaveRefusal* refusal = nullptr) {
    SaveRefusal unasked = SaveRefusal::kNone;
    return runs.library().save(name, document, replace, refusal != nullptr ? *refusal : unasked);
  }
};

TEST_F(ScenarioLibraryTest, SavesListsFliesAndDeletes) {
  const auto runs = saving_manager();
  EXPECT_TRUE(runs->library().saves());
  Json document = testing::small_document();
  document["title"] = "Mine";
  EXPECT_TRUE(save(*runs, "mine", document).value());
  const auto listed = runs->library().list();
  ASSERT_EQ(listed.size(), 2U);
  EXPECT_EQ(listed[1].name, "mine");
  EXPECT_EQ(listed[1].title, "Mine");
  EXPECT_EQ(listed[1].flight, "course");
  EXPECT_TRUE(listed[1].saved);
  EXPECT_FALSE(listed[0].saved);
  EXPECT_EQ(listed[1].error, "");
  EXPECT_EQ(runs->library().document("mine")->at("name"), "mine");
  const auto started = runs->start("mine", perfect());
  ASSERT_TRUE(started.ok()) << started.error().message;
  EXPECT_EQ(started->scenario, "mine");
  EXPECT_EQ(wait_for_end(*runs, started->id).status, RunStatus::kCompleted);
  SaveRefusal refusal = SaveRefusal::kNone;
  EXPECT_TRUE(runs->library().remove("mine", refusal).ok());
  EXPECT_EQ(runs->library().remove("mine", refusal).error().code, ErrorCode::kNotFound);
  EXPECT_EQ(runs->library().list().size(), 1U);
}

TEST_F(ScenarioLibraryTest, FliesADocumentThatIsNotSaved) {
  const auto runs = saving_manager();
  Json document = testing::small_document();
  document["duration_s"] = 0.5;
  auto scenario = runs->library().read(document);
  ASSERT_TRUE(scenario.ok()) << scenario.error().message;
  const auto started = runs->start(std::move(*scenario));
  ASSERT_TRUE(started.ok()) << started.error().message;
  EXPECT_EQ(wait_for_end(*runs, started->id).status, RunStatus::kCompleted);
  EXPECT_EQ(runs->document_of(started->id)->at("duration_s"), 0.5);
}

TEST_F(ScenarioLibraryTest, ReplacesOnlyWhenItIsToldTo) {
  const auto runs = saving_manager();
  EXPECT_TRUE(save(*runs, "mine").value());
  EXPECT_EQ(save(*runs, "mine").error().code, ErrorCode::kConflict);
  Json document = testing::small_document();
  document["seed"] = 9;
  EXPECT_FALSE(save(*runs, "mine", document, true).value());
  EXPECT_EQ(runs->library().document("mine")->at("seed"), 9);
}

TEST_F(ScenarioLibraryTest, LeavesTheServersOwnScenariosAlone) {
  const auto runs = saving_manager();
  SaveRefusal refusal = SaveRefusal::kNone;
  EXPECT_FALSE(save(*runs, "small", testing::small_document(), true, &refusal).ok());
  EXPECT_EQ(refusal, SaveRefusal::kOwned);
  refusal = SaveRefusal::kNone;
  EXPECT_FALSE(runs->library().remove("small", refusal).ok());
  EXPECT_EQ(refusal, SaveRefusal::kOwned);
  EXPECT_TRUE(fs::exists(root() / "scenarios" / "small.json"));
}

TEST_F(ScenarioLibraryTest, TakesPlainNamesOnly) {
  const auto runs = saving_manager();
  for (const std::string& name : {std::string(),
                                  std::string("../small"),
                                  std::string("a/b"),
                                  std::string(".hidden"),
                                  std::string("a.b"),
                                  std::string("-a"),
                                  std::string("_a"),
                                  std::string("a b"),
                                  std::string("x.schema"),
                                  std::string(65, 'x'),
                                  std::string("a\0b", 3)}) {
    const auto kept = save(*runs, name);
    ASSERT_FALSE(kept.ok()) << name;
    EXPECT_THAT(kept.error().message, HasSubstr("must be 1 to 64 letters")) << name;
  }
  EXPECT_FALSE(fs::exists(saved()));
  EXPECT_TRUE(save(*runs, std::string(64, 'x')).ok());
}

TEST_F(ScenarioLibraryTest, KeepsALimitedNumber) {
  const auto runs = saving_manager();
  fs::create_directories(saved());
  for (std::size_t i = 0; i < kMaxSavedScenarios; ++i) {
    overfly::testing::write_text(saved() / ("s" + std::to_string(i) + ".json"), "{}");
  }
  SaveRefusal refusal = SaveRefusal::kNone;
  const auto kept = save(*runs, "one-more", testing::small_document(), false, &refusal);
  EXPECT_EQ(refusal, SaveRefusal::kFull);
  EXPECT_THAT(kept.error().message, HasSubstr("must be below 500"));
  // One of them can be replaced.
  EXPECT_TRUE(save(*runs, "s7", testing::small_document(), true).ok());
}

TEST_F(ScenarioLibraryTest, SavesNothingThatCannotBeFlown) {
  const auto runs = saving_manager();
  Json broken = testing::small_document();
  broken["camera"]["width_px"] = 3;
  EXPECT_THAT(save(*runs, "broken", broken).error().message, HasSubstr("camera.width_px = 3"));
  Json outside = testing::small_document();
  outside["world"]["manifest"] = "/etc/passwd";
  EXPECT_THAT(save(*runs, "outside", outside).error().message, HasSubstr("data folders"));
  Json long_text = testing::small_document();
  for (int i = 0; i < 200; ++i) {
    Json fault = {{"kind", "blackout"}, {"from_s", 0}, {"to_s", 1}};
    long_text["faults"].push_back(fault);
  }
  EXPECT_FALSE(save(*runs, "many", long_text).ok());
  EXPECT_FALSE(save(*runs, "list", Json::array()).ok());
  EXPECT_FALSE(fs::exists(saved() / "broken.json"));
}

/// A client must not open folders, start programs or reach addresses by saving a scenario.
TEST_F(ScenarioLibraryTest, GivesSavedScenariosNoMoreReachThanOverrides) {
  Json owned = testing::small_document();
  owned["estimators"] = {{{"name", "vo"}, {"type", "process"}, {"command", {"/bin/true"}}}};
  overfly::testing::write_text(root() / "scenarios" / "doors.json", owned.dump());
  const auto runs = saving_manager();
  EXPECT_TRUE(runs->library().read_to_fly(owned).ok()) << "as in the owner's file";
  Json evil = owned;
  evil["estimators"][0]["command"] = {"/bin/sh"};
  EXPECT_EQ(runs->library().read_to_fly(evil).error().code, ErrorCode::kForbidden);
  EXPECT_THAT(save(*runs, "evil", evil).error().message, HasSubstr("estimators.0.command"));
  Json live = testing::small_document();
  live["flight"] = {{"mavlink", {{"link", "tcp:127.0.0.1:1"}}}};
  EXPECT_THAT(runs->library().read_to_fly(live).error().message, HasSubstr("flight.mavlink"));
  EXPECT_TRUE(runs->library().read(live).ok()) << "to look at it, as at its world";
  // Also where a file got there in another way: each flight is checked.
  fs::create_directories(saved());
  overfly::testing::write_text(saved() / "planted.json", evil.dump());
  EXPECT_EQ(runs->start("planted", {}).error().code, ErrorCode::kForbidden);
  // A saved scenario opens no data folder.
  Json data = testing::small_document();
  data["data"] = "/etc";
  data["world"] = {{"manifest", "passwd"}};
  overfly::testing::write_text(saved() / "data.json", data.dump());
  EXPECT_THAT(runs->start("data", {}).error().message, HasSubstr("data folders"));
}

TEST_F(ScenarioLibraryTest, SavesNothingWithoutAFolder) {
  const auto runs = manager();
  EXPECT_FALSE(runs->library().saves());
  SaveRefusal refusal = SaveRefusal::kNone;
  EXPECT_FALSE(save(*runs, "mine", testing::small_document(), false, &refusal).ok());
  EXPECT_EQ(refusal, SaveRefusal::kOff);
}

TEST_F(ScenarioLibraryTest, CountsTheQueue) {
  const auto runs = saving_manager();
  const std::string first = runs->start("small", endless()).value().id;
  const std::string second = runs->start("small", endless()).value().id;
  const std::string third = runs->start("small", endless()).value().id;
  wait_for_first_frame(*runs->timeline(first).value());
  EXPECT_EQ(runs->run(first)->queue_position, 0);
  EXPECT_EQ(runs->run(second)->queue_position, 1);
  EXPECT_EQ(runs->run(third)->queue_position, 2);
  EXPECT_TRUE(runs->cancel(second).ok());
  EXPECT_EQ(runs->run(third)->queue_position, 1);
  EXPECT_TRUE(runs->cancel(third).ok());
  EXPECT_TRUE(runs->cancel(first).ok());
  wait_for_end(*runs, first);
  EXPECT_EQ(runs->run(third)->queue_position, 0);
}

}  // namespace
}  // namespace overfly::server
