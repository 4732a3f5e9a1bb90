#include "server/calibration/session/calibration_session.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <thread>

#include "server/calibration/calibrate_images.hpp"
#include "server/calibration/session/session_json.hpp"
#include "server/files/jpeg.hpp"
#include "tests/server/calibration/board_fixture.hpp"

namespace overfly::server {
namespace {

using namespace std::chrono_literals;
using calibration::CalibratorOptions;
using calibration::LensChoice;
using testing::board_images;
using ::testing::HasSubstr;
using testing::kSessionBoard;
using testing::ListedImages;
using testing::session_camera;

SessionRequest request_for(OpenBoardImages open) {
  SessionRequest request;
  request.source = "test";
  request.calibrator = {kSessionBoard, {DistortionModel::kRadtan, false}, false};
  request.open = std::move(open);
  return request;
}

OpenBoardImages listed(std::vector<Image> images, ListedImages::Behaviour behaviour = {}) {
  return [images = std::move(images), behaviour](const std::atomic<bool>*) {
    return Result<std::unique_ptr<BoardImages>>(std::make_unique<ListedImages>(images, behaviour));
  };
}

/// Waits for a state; the last one if it does not come.
SessionState wait_for(const CalibrationSession& session,
                      const std::function<bool(const SessionState&)>& condition) {
  const auto end = std::chrono::steady_clock::now() + 60s;
  SessionState state = session.state();
  while (!condition(state) && std::chrono::steady_clock::now() < end) {
    std::this_thread::sleep_for(5ms);
    state = session.state();
  }
  EXPECT_TRUE(condition(state)) << session_json(session, state).dump(2);
  return state;
}

bool is_solved(const SessionState& state) {
  return state.solution != nullptr && state.phase == SessionPhase::kWaiting;
}

TEST(CalibrationSession, EstimatesTheCameraWhenTheSourceEnds) {
  const auto session = CalibrationSession::begin(request_for(listed(board_images(8)))).value();
  const SessionState state = wait_for(*session, is_solved);
  EXPECT_EQ(state.images_done, 8U);
  EXPECT_EQ(state.images_total, 8U);
  ASSERT_EQ(state.views.size(), 8U);
  EXPECT_FALSE(state.source_open);
  // As from the command line.
  VirtualCalibration request;
  request.camera = {session_camera(), {}, 8, 1};
  const auto same = calibrate_virtual(request, session->options()).value();
  EXPECT_EQ(state.solution->record.result.camera.pinhole().fx_px,
            same.result.camera.pinhole().fx_px);
  for (std::size_t i = 0; i < 8; ++i) {
    const SearchedImage& view = *state.views[i];
    EXPECT_EQ(view.verdict, "taken");
    EXPECT_EQ(view.corners.size(), 54U);
    ASSERT_TRUE(view.jpeg);
    EXPECT_EQ(decode_jpeg(*view.jpeg)->width_px, view.width_px);
    EXPECT_EQ(find_image(state, view.number), state.views[i]);
  }
  EXPECT_EQ(find_image(state, 99), nullptr);
}

TEST(CalibrationSession, LeavesViewsOutAndEstimatesOtherModels) {
  const auto session = CalibrationSession::begin(request_for(listed(board_images(8)))).value();
  const double fx_px = wait_for(*session, is_solved).solution->record.result.camera.pinhole().fx_px;
  ASSERT_TRUE(session->solve({DistortionModel::kRadtan, false}, {2, 5}));
  const SessionState fewer = wait_for(*session, [](const SessionState& state) {
    return is_solved(state) && state.solution->number == 2;
  });
  EXPECT_EQ(fewer.left_out, (std::set<std::size_t>{2, 5}));
  EXPECT_EQ(fewer.solution->view_of, (std::vector<std::size_t>{0, 1, 3, 4, 6, 7}));
  EXPECT_NE(fewer.solution->record.result.camera.pinhole().fx_px, fx_px);
  EXPECT_EQ(fewer.solution->record.left_out.front().reason, "left out by the user");
  // Residuals are those of the estimate: of views without a part there are none.
  EXPECT_TRUE(view_json(fewer, 2, kSessionBoard).at("residuals").is_null());
  const auto view = view_json(fewer, 3, kSessionBoard);
  double sum = 0.0;
  for (const auto& residual : view.at("residuals")) {
    sum += std::pow(residual[0].get<double>(), 2) + std::pow(residual[1].get<double>(), 2);
  }
  EXPECT_NEAR(std::sqrt(sum / 54.0), fewer.solution->record.result.views[2].rms_px, 1e-3);

  ASSERT_TRUE(session->solve({DistortionModel::kEquidistant, false}, {}));
  const SessionState other = wait_for(*session, [](const SessionState& state) {
    return is_solved(state) && state.solution->number == 3;
  });
  EXPECT_EQ(other.solution->record.result.camera.distortion().model, DistortionModel::kEquidistant);
  EXPECT_EQ(other.solution->view_of.size(), 8U);
  EXPECT_FALSE(session->solve({}, {8}));
  EXPECT_FALSE(session->solve({}, {0, 1, 2, 3, 4}));
}

TEST(CalibrationSession, SaysWhyThereIsNoEstimate) {
  std::vector<Image> images = board_images(5);
  images.resize(3);
  images.push_back(Image(480, 360, 1, 90));
  images.push_back(Image(100, 100, 1, 90));
  const auto session = CalibrationSession::begin(request_for(listed(images))).value();
  const SessionState state =
      wait_for(*session, [](const SessionState& now) { return !now.source_open; });
  EXPECT_EQ(state.views.size(), 3U);
  EXPECT_EQ(state.images_without_view, 2U);
  EXPECT_EQ(state.left_out_images.at(0).reason, "no board");
  EXPECT_THAT(state.left_out_images.at(1).reason, HasSubstr("must be 480 x 360 px"));
  EXPECT_EQ(state.solution, nullptr);
  EXPECT_THAT(session->solve({}, {}).error().message, HasSubstr("at least 4 are needed"));
  EXPECT_FALSE(session->capture());
}

TEST(CalibrationSession, EstimatesFromWhatCameBeforeTheSourceFailed) {
  ListedImages::Behaviour failing;
  failing.fails_after = 6;
  const auto session =
      CalibrationSession::begin(request_for(listed(board_images(8), failing))).value();
  const SessionState state =
      wait_for(*session, [](const SessionState& now) { return now.solution != nullptr; });
  EXPECT_EQ(state.phase, SessionPhase::kFailed);
  EXPECT_EQ(state.error, "the cable was pulled");
  EXPECT_EQ(state.views.size(), 6U);
}

TEST(CalibrationSession, ReportsASourceThatCannotBeOpened) {
  const auto session =
      CalibrationSession::begin(request_for([](const std::atomic<bool>*) {
        return Result<std::unique_ptr<BoardImages>>(Error{ErrorCode::kIo, "no camera there"});
      })).value();
  const SessionState state = wait_for(
      *session, [](const SessionState& now) { return now.phase == SessionPhase::kFailed; });
  EXPECT_EQ(state.error, "no camera there");
}

TEST(CalibrationSession, ContainsExceptionsOfItsThread) {
  const auto session =
      CalibrationSession::begin(request_for([](const std::atomic<bool>*)
                                                -> Result<std::unique_ptr<BoardImages>> {
        throw std::bad_alloc();
      })).value();
  const SessionState state = wait_for(
      *session, [](const SessionState& now) { return now.phase == SessionPhase::kFailed; });
  EXPECT_THAT(state.error, HasSubstr("internal error"));
  EXPECT_TRUE(session->over());
}

TEST(CalibrationSession, RefusesAnAmbiguousBoardWithTheReason) {
  SessionRequest request = request_for(listed({}));
  request.calibrator.board.rows = 7;
  const auto refused = CalibrationSession::begin(std::move(request));
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("half a turn"));
}

TEST(CalibrationSession, TakesOfALiveCameraWhatIsUsefulOrAskedFor) {
  ListedImages::Behaviour live;
  live.moving = true;
  live.repeat = true;
  const auto session =
      CalibrationSession::begin(request_for(listed({board_images(1).front()}, live))).value();
  // Still from the second image on; then nothing new.
  SessionState state =
      wait_for(*session, [](const SessionState& now) { return now.images_done >= 5; });
  EXPECT_EQ(state.views.size(), 1U);
  EXPECT_TRUE(state.left_out_images.empty());
  EXPECT_LE(state.recent.size(), kMostRecent);
  session->clear();
  session->set_automatic(false);
  state = wait_for(*session, [&](const SessionState& now) {
    return now.views.empty() && !now.recent.empty() &&
           now.recent.back()->verdict == "not asked for";
  });
  ASSERT_TRUE(session->capture());
  state = wait_for(*session, [](const SessionState& now) { return now.views.size() == 1; });
  session->finish();
  wait_for(*session, [](const SessionState& now) { return !now.source_open; });
}

TEST(CalibrationSession, LetsACameraGoThatNobodyLooksAt) {
  ListedImages::Behaviour live;
  live.moving = true;
  live.repeat = true;
  SessionRequest request = request_for(listed({board_images(1).front()}, live));
  request.patience = 300ms;
  const auto session = CalibrationSession::begin(std::move(request)).value();
  wait_for(*session, [&](const SessionState& now) {
    session->touch();  // somebody looks until there is a view
    return !now.views.empty();
  });
  const SessionState state =
      wait_for(*session, [](const SessionState& now) { return !now.source_open; });
  EXPECT_EQ(state.phase, SessionPhase::kWaiting);
  EXPECT_FALSE(state.views.empty());
}

TEST(CalibrationSession, TakesUploadsAsFastAsItSearchesThem) {
  const auto session = CalibrationSession::begin(request_for({})).value();
  ASSERT_TRUE(session->takes_uploads());
  std::vector<std::uint8_t> text = {'n', 'o'};
  ASSERT_TRUE(session->upload("text.png", text).value());
  int refused = 0;
  for (const Image& image : board_images(6)) {
    const auto jpeg = encode_jpeg(image, 95).value();
    while (!session->upload("photo.jpg", jpeg).value()) {
      ++refused;
      std::this_thread::sleep_for(5ms);
    }
  }
  EXPECT_GT(refused, 0);
  session->finish();
  const SessionState state = wait_for(*session, is_solved);
  EXPECT_EQ(state.views.size(), 6U);
  EXPECT_EQ(state.left_out_images.at(0).name, "text.png");
  EXPECT_THAT(state.left_out_images.at(0).reason, HasSubstr("cannot be read"));
  EXPECT_EQ(session->upload("late.jpg", text).error().code, ErrorCode::kConflict);
}

/// Uploads as soon as there is room.
void upload_all(CalibrationSession& session, const std::vector<Image>& images) {
  for (const Image& image : images) {
    const auto jpeg = encode_jpeg(image, 95).value();
    while (!session.upload("photo.jpg", jpeg).value()) std::this_thread::sleep_for(5ms);
  }
}

TEST(CalibrationSession, WaitsForUploadsHoweverLongTheyTake) {
  SessionRequest request = request_for({});
  request.patience = 1ms;
  const auto session = CalibrationSession::begin(std::move(request)).value();
  wait_for(*session, [](const SessionState& now) { return now.phase == SessionPhase::kTaking; });
  std::this_thread::sleep_for(300ms);
  EXPECT_TRUE(session->state().source_open);
  upload_all(*session, board_images(1));
  wait_for(*session, [](const SessionState& now) { return now.views.size() == 1; });
}

TEST(CalibrationSession, TakesNoUploadsWithoutAThreadThatSearchesThem) {
  SessionRequest request = request_for({});
  request.begin_thread = [] { throw std::bad_alloc(); };
  const auto session = CalibrationSession::begin(std::move(request)).value();
  wait_for(*session, [](const SessionState& now) { return now.phase == SessionPhase::kFailed; });
  const auto refused = session->upload("late.jpg", {'n', 'o'});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::kConflict);
}

TEST(CalibrationSession, EstimatesAgainAtTheEndWithTheViewsThatCameSince) {
  const auto session = CalibrationSession::begin(request_for({})).value();
  const std::vector<Image> images = board_images(8);
  upload_all(*session, {images.begin(), images.begin() + 5});
  wait_for(*session, [](const SessionState& now) { return now.views.size() == 5; });
  ASSERT_TRUE(session->solve({DistortionModel::kRadtan, false}, {1}));
  SessionState state = wait_for(*session, [](const SessionState& now) {
    return now.solution != nullptr && now.phase == SessionPhase::kTaking;
  });
  EXPECT_EQ(state.solution->view_of.size(), 4U);
  upload_all(*session, {images.begin() + 5, images.end()});
  session->finish();
  state = wait_for(*session, [](const SessionState& now) {
    return is_solved(now) && now.solution->number == 2;
  });
  // What the user left out stays so.
  EXPECT_EQ(state.left_out, (std::set<std::size_t>{1}));
  EXPECT_EQ(state.solution->view_of, (std::vector<std::size_t>{0, 2, 3, 4, 5, 6, 7}));
}

TEST(CalibrationSession, RefusesImagesThatAreTooLarge) {
  const auto session =
      CalibrationSession::begin(request_for(listed({Image(8000, 6000, 1, 90)}))).value();
  const SessionState state =
      wait_for(*session, [](const SessionState& now) { return !now.source_open; });
  EXPECT_THAT(state.left_out_images.at(0).reason, HasSubstr("at most 40000000 pixels"));
}

TEST(CalibrationSession, RefusesUploadsThatAreTooLargeBeforeTheyAreDecoded) {
  const auto session = CalibrationSession::begin(request_for({})).value();
  std::vector<std::uint8_t> jpeg = encode_jpeg(Image(160, 120, 1, 90), 75).value();
  // The size in the header of the frame (marker FFC0): 16000 x 16000 px, of which nothing follows.
  const std::array<std::uint8_t, 2> marker{0xFF, 0xC0};
  const auto header = std::search(jpeg.begin(), jpeg.end(), marker.begin(), marker.end());
  ASSERT_LT(header + 8, jpeg.end());
  for (const int i : {5, 7}) {
    header[i] = 16000 / 256;
    header[i + 1] = 16000 % 256;
  }
  ASSERT_TRUE(session->upload("photo.jpg", jpeg).value());
  session->finish();
  const SessionState state =
      wait_for(*session, [](const SessionState& now) { return !now.source_open; });
  EXPECT_EQ(state.left_out_images.at(0).reason, "must have at most 40000000 pixels");
}

TEST(CalibrationSession, EndsSoonWhenItIsCancelled) {
  ListedImages::Behaviour live;
  live.repeat = true;
  auto session = CalibrationSession::begin(request_for(listed(board_images(2), live))).value();
  wait_for(*session, [](const SessionState& now) { return now.images_done >= 1; });
  session->cancel();
  const auto begin = std::chrono::steady_clock::now();
  session.reset();
  EXPECT_LT(std::chrono::steady_clock::now() - begin, 20s);
}

}  // namespace
}  // namespace overfly::server
