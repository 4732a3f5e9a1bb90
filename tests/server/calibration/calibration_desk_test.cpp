#include "server/calibration/session/calibration_desk.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <thread>

#include "server/files/png_file.hpp"
#include "server/files/whole_file.hpp"
#include "tests/server/calibration/board_fixture.hpp"
#include "tests/support/support.hpp"

namespace overfly::server {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;
using ::testing::HasSubstr;
using ::testing::Not;

class CalibrationDeskTest : public ::testing::Test {
 protected:
  CalibrationDeskTest() {
    fs::create_directories(data() / "photos");
    fs::create_directories(folder_.path() / "private");
    std::vector<Image> images = testing::board_images(5);
    for (std::size_t i = 0; i < images.size(); ++i) {
      // Numbers in names are numbers: 9 is before 10.
      const std::string name = "p" + std::to_string(i + 8) + ".png";
      EXPECT_TRUE(write_png_file(data() / "photos" / name, images[i]));
    }
    EXPECT_TRUE(write_png_file(folder_.path() / "private" / "secret.png", images.front()));
    fs::create_symlink(folder_.path() / "private" / "secret.png", data() / "photos" / "link.png");
  }
  [[nodiscard]] fs::path data() const { return folder_.path() / "data"; }

  [[nodiscard]] DeskOptions options() const {
    DeskOptions options;
    options.folders = [this] {
      return ServedFolders{{}, {data()}, SourcePolicy::inside({data()})};
    };
    options.scenario_camera = [](const std::string& scenario, const std::string& camera) {
      if (scenario != "course") return Result<CameraSpec>(Error{ErrorCode::kNotFound, "none"});
      CameraSpec spec;
      spec.model = testing::session_camera();
      spec.name = camera;
      return Result<CameraSpec>(spec);
    };
    options.cameras = {*parse_live_address("rtsp://me:secret@127.0.0.1:1/live", "camera")};
    options.store = folder_.path() / "store";
    return options;
  }
  static DeskRequest request(SourceKind kind, const std::string& name) {
    DeskRequest request;
    request.kind = kind;
    request.name = name;
    request.views = 5;
    request.calibrator = {testing::kSessionBoard, {DistortionModel::kRadtan, false}, false};
    return request;
  }
  static SessionState wait_until_solved(CalibrationDesk& desk, const std::string& id) {
    for (int turns = 0; turns < 6000; ++turns) {
      const SessionState state = (*desk.session(id))->state();
      if (!state.source_open && (state.solution || !state.error.empty())) return state;
      std::this_thread::sleep_for(10ms);
    }
    ADD_FAILURE() << "no estimate";
    return {};
  }

  overfly::testing::TemporaryFolder folder_;
};

TEST_F(CalibrationDeskTest, ListsWhatCalibrationsCanUse) {
  CalibrationDesk desk(options());
  overfly::testing::write_text(data() / "flight.bag", "x");
  const auto sources = desk.sources_json();
  ASSERT_EQ(sources.at("folders").size(), 1U);
  EXPECT_EQ(sources.at("folders")[0], (nlohmann::json{{"name", "data/photos"}, {"images", 5}}));
  EXPECT_EQ(sources.at("recordings")[0].at("name"), "data/flight.bag");
  // Without the password.
  EXPECT_EQ(sources.at("cameras")[0].at("name"), "rtsp://127.0.0.1:1/live");
  EXPECT_EQ(sources.at("keeps"), true);
}

TEST_F(CalibrationDeskTest, CalibratesFromAFolderInTheOrderOfItsNumbers) {
  CalibrationDesk desk(options());
  const auto id = desk.begin(request(SourceKind::kFolder, "data/photos"));
  ASSERT_TRUE(id) << id.error().message;
  const SessionState state = wait_until_solved(desk, *id);
  ASSERT_EQ(state.views.size(), 5U);
  EXPECT_EQ(state.views[0]->name, "p8.png");
  EXPECT_EQ(state.views[2]->name, "p10.png");
}

TEST_F(CalibrationDeskTest, TakesAllImagesOfAFolderOrNone) {
  fs::create_directories(data() / "many");
  for (int i = 0; i <= 20'000; ++i) {
    std::ofstream(data() / "many" / (std::to_string(i) + ".png"));
  }
  CalibrationDesk desk(options());
  const auto refused = desk.begin(request(SourceKind::kFolder, "data/many"));
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::kInvalidArgument);
  EXPECT_THAT(refused.error().message,
              HasSubstr("data/many: contains more than 20000 images (PNG, JPEG, PGM, PPM)"));
  // Another folder does not suffer from its number of files.
  const auto id = desk.begin(request(SourceKind::kFolder, "data/photos"));
  ASSERT_TRUE(id) << id.error().message;
  EXPECT_EQ(wait_until_solved(desk, *id).images_done, 5U);
}

TEST_F(CalibrationDeskTest, CalibratesTheCameraOfAScenario) {
  CalibrationDesk desk(options());
  DeskRequest wanted = request(SourceKind::kScenario, "course");
  wanted.camera = "down";
  const auto id = desk.begin(wanted);
  ASSERT_TRUE(id) << id.error().message;
  const SessionState state = wait_until_solved(desk, *id);
  ASSERT_TRUE(state.solution);
  EXPECT_EQ(state.solution->record.truth->pinhole().fx_px, 340.0);
  EXPECT_THAT((*desk.session(*id))->source(), HasSubstr("camera down"));
}

TEST_F(CalibrationDeskTest, OpensNothingElse) {
  fs::create_directory_symlink(data() / "photos", data() / "linked");
  CalibrationDesk desk(options());
  for (const auto& [kind, name] : std::vector<std::pair<SourceKind, std::string>>{
           {SourceKind::kFolder, "data"},
           {SourceKind::kFolder, "data/../private"},
           {SourceKind::kFolder, "data/linked"},
           {SourceKind::kFolder, ""},
           {SourceKind::kFolder, (folder_.path() / "private").string()},
           {SourceKind::kRecording, "data/none.bag"},
           {SourceKind::kRecording, "data/photos/p8.png"},
           {SourceKind::kScenario, "none"},
           {SourceKind::kCamera, "rtsp://127.0.0.1:2/live"},
           {SourceKind::kCamera, "rtsp://me:secret@127.0.0.1:1/live"}}) {
    const auto id = desk.begin(request(kind, name));
    ASSERT_FALSE(id) << name;
    EXPECT_EQ(id.error().code, ErrorCode::kNotFound) << name;
  }
  EXPECT_TRUE(desk.sessions().empty());
  EXPECT_FALSE(desk.session("none"));
  EXPECT_FALSE(desk.end("none"));
}

TEST_F(CalibrationDeskTest, ReportsAFailingCameraWithoutItsPassword) {
  CalibrationDesk desk(options());
  const auto id = desk.begin(request(SourceKind::kCamera, "rtsp://127.0.0.1:1/live"));
  ASSERT_TRUE(id) << id.error().message;
  const SessionState state = wait_until_solved(desk, *id);
  EXPECT_EQ(state.phase, SessionPhase::kFailed);
  EXPECT_THAT(state.error, HasSubstr("rtsp://127.0.0.1:1/live"));
  EXPECT_THAT(state.error, Not(HasSubstr("secret")));
}

TEST_F(CalibrationDeskTest, NamesADamagedRecordingByItsNameOnly) {
  overfly::testing::write_text(data() / "broken.mp4", "no video");
  CalibrationDesk desk(options());
  const auto id = desk.begin(request(SourceKind::kRecording, "data/broken.mp4"));
  ASSERT_TRUE(id) << id.error().message;
  const SessionState state = wait_until_solved(desk, *id);
  EXPECT_THAT(state.error, HasSubstr("data/broken.mp4"));
  EXPECT_THAT(state.error, Not(HasSubstr(folder_.path().string())));
}

TEST_F(CalibrationDeskTest, NamesADamagedRecordingOfARelativeFolderOnce) {
  overfly::testing::write_text(data() / "broken.mp4", "no video");
  const fs::path before = fs::current_path();
  fs::current_path(folder_.path());
  DeskOptions relative = options();
  relative.folders = [] { return ServedFolders{{}, {"data"}, SourcePolicy::inside({"data"})}; };
  {
    CalibrationDesk desk(relative);
    const auto id = desk.begin(request(SourceKind::kRecording, "data/broken.mp4"));
    ASSERT_TRUE(id) << id.error().message;
    EXPECT_THAT(wait_until_solved(desk, *id).error, HasSubstr("data/broken.mp4"));
  }
  fs::current_path(before);
}

TEST_F(CalibrationDeskTest, HasALimitedNumberOfSessions) {
  CalibrationDesk desk(options());
  std::vector<std::string> ids;
  for (std::size_t i = 0; i < kMostSessions; ++i) {
    ids.push_back(desk.begin(request(SourceKind::kUpload, "")).value());
  }
  const auto refused = desk.begin(request(SourceKind::kUpload, ""));
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::kConflict);
  EXPECT_THAT(refused.error().message, HasSubstr("2 calibrations are in progress"));
  ASSERT_TRUE(desk.end(ids.front()));
  EXPECT_FALSE(desk.session(ids.front()));
  // The one that ends still counts until its thread has ended.
  Result<std::string> again = Error{ErrorCode::kInternal, ""};
  for (int turns = 0; turns < 500 && !again; ++turns) {
    again = desk.begin(request(SourceKind::kUpload, ""));
    if (!again) std::this_thread::sleep_for(10ms);
  }
  EXPECT_TRUE(again);
  EXPECT_EQ(desk.sessions().size(), kMostSessions);
}

TEST_F(CalibrationDeskTest, ASessionThatWasLeftAloneGivesWay) {
  DeskOptions impatient = options();
  impatient.patience = 50ms;
  CalibrationDesk desk(impatient);
  const std::string first = desk.begin(request(SourceKind::kUpload, "")).value();
  const std::string second = desk.begin(request(SourceKind::kUpload, "")).value();
  std::this_thread::sleep_for(100ms);
  ASSERT_TRUE(desk.session(second));        // somebody looks at it
  ASSERT_TRUE(desk.session(first, false));  // and a viewer at this one
  const auto third = desk.begin(request(SourceKind::kUpload, ""));
  ASSERT_TRUE(third) << third.error().message;
  EXPECT_FALSE(desk.session(first));
  EXPECT_TRUE(desk.session(second));
  EXPECT_EQ(desk.sessions().size(), kMostSessions);
}

TEST_F(CalibrationDeskTest, KeepsCalibrationsByName) {
  CalibrationDesk desk(options());
  const CalibrationStore& store = desk.store();
  EXPECT_TRUE(store.list().empty());
  const auto id = desk.begin(request(SourceKind::kScenario, "course"));
  const SessionState state = wait_until_solved(desk, *id);
  const CalibrationRecord& record = state.solution->record;
  ASSERT_TRUE(store.save("front", record));
  EXPECT_EQ(store.save("front", record).error().code, ErrorCode::kConflict);
  for (const char* name : {"", ".hidden", "../up", "a/b", "a b", "ä"}) {
    EXPECT_EQ(store.save(name, record).error().code, ErrorCode::kInvalidArgument) << name;
  }
  EXPECT_FALSE(store.save(std::string(61, 'a'), record));
  const auto entry = store.list().at(0);
  EXPECT_EQ(entry.at("name"), "front");
  EXPECT_EQ(entry.at("fx_px"), record.result.camera.pinhole().fx_px);
  EXPECT_EQ(store.read("front").value().at("fx_px"), entry.at("fx_px"));
  EXPECT_THAT(store.text("front", CameraFormat::kKalibr).value(), HasSubstr("radtan"));
  for (const char* name : {"none", "../data/photos/p8", "front.json"}) {
    EXPECT_EQ(store.read(name).error().code, ErrorCode::kNotFound) << name;
  }
  // What is no calibration is listed as such, and harms nothing.
  overfly::testing::write_text(folder_.path() / "store" / "odd.json", "[1]");
  EXPECT_THAT(store.list().at(1).at("error").get<std::string>(), HasSubstr("no calibration"));
  ASSERT_TRUE(store.remove("front"));
  EXPECT_FALSE(store.remove("front"));
}

TEST_F(CalibrationDeskTest, KeepsALimitedNumberOfCalibrations) {
  const CalibrationStore store(folder_.path() / "full");
  fs::create_directories(folder_.path() / "full");
  for (std::size_t i = 0; i < kMostStoredCalibrations; ++i) {
    overfly::testing::write_text(folder_.path() / "full" / ("c" + std::to_string(i) + ".json"), "");
  }
  EXPECT_THAT(store.save("one_more", {}).error().message, HasSubstr("delete some"));
  const CalibrationStore none{fs::path()};
  EXPECT_EQ(none.save("a", {}).error().code, ErrorCode::kUnsupported);
}

}  // namespace
}  // namespace overfly::server
