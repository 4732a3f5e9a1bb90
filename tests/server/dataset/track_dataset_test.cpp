// Estimators over data sets: what is booked, how it ends, what is written.
#include "server/dataset/track_dataset.hpp"
#include "core/measure/crc32.hpp"
#include "server/dataset/open_dataset.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <opencv2/imgcodecs.hpp>
#include <stdexcept>

#include "core/motion/trajectory_io.hpp"
#include "server/dataset/track_report.hpp"
#include "server/files/whole_file.hpp"
#include "tests/server/dataset/dataset_fixture.hpp"

namespace overfly::server {
namespace {

namespace fs = std::filesystem;
using overfly::testing::read_text;
using overfly::testing::TemporaryFolder;
using overfly::testing::write_text;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// Answers as the test says.
class ScriptedPort final : public VoPort {
 public:
  using Script = std::function<Result<VoEstimate>(const VoFrame&, VoEstimate)>;
  explicit ScriptedPort(Script script) : script_(std::move(script)) {}

  [[nodiscard]] std::string type() const override { return "scripted"; }
  [[nodiscard]] std::map<std::string, std::string> effective_parameters() const override {
    return {{"features", "7"}};
  }
  Result<VoEstimate> track(const VoFrame& frame) override {
    VoEstimate estimate;
    estimate.sample.frame = frame.index;
    estimate.sample.t_ns = frame.t_ns;
    estimate.sample.state = TrackingState::kTracking;
    estimate.sample.scene_depth = 2.0;
    estimate.sample.T_vo_camera.translation.x() = static_cast<double>(frame.index);
    estimate.timing_ms["detect"] = 3.0;
    if (debug_) estimate.debug_image = Image(4, 3, 3, 200);
    return script_(frame, std::move(estimate));
  }
  void set_debug(bool wanted) override { debug_ = wanted; }
  [[nodiscard]] std::vector<std::string> take_log() override { return {"a line"}; }

 private:
  Script script_;
  bool debug_ = false;
};

Result<VoEstimate> well(const VoFrame&, VoEstimate estimate) { return estimate; }

class TrackDataset : public ::testing::Test {
 protected:
  void SetUp() override {
    testing::write_images(path() / "images", 6);
    write_text(path() / "times.txt", "10\n10.5\n11\n11.5\n12\n12.5\n");
    Result<Dataset> opened = open_dataset(testing::plain_options(path()));
    ASSERT_TRUE(opened.ok()) << opened.error().message;
    dataset_ = std::move(*opened);
  }
  [[nodiscard]] const fs::path& path() const { return folder_.path(); }
  TrackedDataset tracked(const ScriptedPort::Script& script, const TrackOptions& options = {}) {
    ScriptedPort port(script);
    Result<TrackedDataset> result = track_dataset(dataset_, port, options);
    if (!result) throw std::runtime_error(result.error().message);
    return std::move(*result);
  }

  TemporaryFolder folder_;
  Dataset dataset_;
};

TEST_F(TrackDataset, BooksEveryFrameAndTellsHowFarItIs) {
  std::vector<std::size_t> progress;
  std::size_t lines = 0;
  TrackOptions options;
  options.progress = [&](std::size_t done, std::size_t total, TrackingState state) {
    progress.push_back(done);
    EXPECT_EQ(total, 6U);
    EXPECT_EQ(state, TrackingState::kTracking);
  };
  options.log = [&](const std::string& line) { lines += line == "a line" ? 1 : 0; };
  const TrackedDataset result = tracked(well, options);
  EXPECT_THAT(progress, ElementsAre(1, 2, 3, 4, 5, 6));
  EXPECT_EQ(lines, 7U);  // one before the first
  EXPECT_EQ(result.reading.ms.size(), 6U);
  EXPECT_EQ(result.tracking.ms.size(), 6U);
  EXPECT_EQ(result.stages.at("detect").ms.size(), 6U);
  EXPECT_EQ(result.parameters.at("features"), "7");
  EXPECT_GT(result.resources.peak_memory_mb, 1.0);
  const nlohmann::json report = report_json(dataset_, result, std::nullopt);
  EXPECT_EQ(report.at("complete"), true);
  EXPECT_EQ(report.at("states").at("TRACKING"), 6);
  EXPECT_EQ(report.at("initialised_after_s"), 0.0);
  EXPECT_EQ(report.at("dataset").at("duration_s"), 2.5);
  EXPECT_EQ(report.at("timing").at("stages").at("detect").at("median_ms"), 3.0);
  EXPECT_EQ(report.at("crash"), nullptr);
  EXPECT_FALSE(report.contains("score"));
}

TEST_F(TrackDataset, StopsAfterTheFrameAtHandWhenCancelled) {
  std::atomic<bool> cancel = false;
  TrackOptions options;
  options.cancel = &cancel;
  options.progress = [&](std::size_t done, std::size_t, TrackingState) { cancel = done == 2; };
  const TrackedDataset result = tracked(well, options);
  EXPECT_TRUE(result.cancelled);
  EXPECT_EQ(result.records.size(), 2U);
  EXPECT_EQ(report_json(dataset_, result, std::nullopt).at("complete"), false);
}

TEST_F(TrackDataset, KeepsWhatItHasWhenTheEstimatorIsStoppedInAFrame) {
  const TrackedDataset result =
      tracked([](const VoFrame& frame, VoEstimate estimate) -> Result<VoEstimate> {
        if (frame.index == 3) return Error{ErrorCode::kCancelled, "stopped"};
        return estimate;
      });
  EXPECT_TRUE(result.cancelled);
  EXPECT_EQ(result.records.size(), 3U);
  EXPECT_EQ(report_json(dataset_, result, std::nullopt).at("crash"), nullptr);
}

TEST_F(TrackDataset, TakesACrashForAResultAndARefusalForAnError) {
  const auto crash = [](const VoFrame& frame, VoEstimate estimate) -> Result<VoEstimate> {
    if (frame.index == 3) return Error{ErrorCode::kInternal, "signal 11"};
    return estimate;
  };
  const TrackedDataset result = tracked(crash);
  ASSERT_EQ(result.records.size(), 4U);
  EXPECT_EQ(result.records.back().crash, "signal 11");
  const evaluation::Score score = score_of(dataset_, result, {}, true, std::nullopt);
  EXPECT_EQ(score.outcome, evaluation::Outcome::kCrashed);
  EXPECT_EQ(score.outcome_time_s, 11.5);
  EXPECT_EQ(score.frames, 6) << "of the data set, not those until the crash";
  EXPECT_EQ(score.coverage, 0.5);
  EXPECT_EQ(report_json(dataset_, result, score).at("crash"), "signal 11");
  const TrackedDataset thrown =
      tracked([](const VoFrame&, const VoEstimate&) -> Result<VoEstimate> {
        throw std::runtime_error("out of corners");
      });
  EXPECT_EQ(thrown.records.back().crash, "out of corners");

  ScriptedPort refusing([](const VoFrame&, const VoEstimate&) -> Result<VoEstimate> {
    return Error{ErrorCode::kInvalidArgument, "no colour"};
  });
  const auto refused = track_dataset(dataset_, refusing, {});
  ASSERT_FALSE(refused.ok());
  EXPECT_THAT(refused.error().message, HasSubstr("times.txt:1: no colour"));
}

TEST_F(TrackDataset, TellsAnEstimatorThatNoLongerAnswersFromOneThatEnded) {
  const auto hangs = [](const VoFrame& frame, VoEstimate estimate) -> Result<VoEstimate> {
    if (frame.index == 3) return Error{ErrorCode::kTimeout, "no answer for 60 s"};
    return estimate;
  };
  const TrackedDataset result = tracked(hangs);
  ASSERT_EQ(result.records.size(), 4U);
  EXPECT_TRUE(result.records.back().hung);
  const TrackFigures figures = figures_of(result);
  EXPECT_EQ(figures.crash, "no answer for 60 s");
  EXPECT_TRUE(figures.hung);
  const evaluation::Score score = score_of(dataset_, result, {}, true, std::nullopt);
  EXPECT_EQ(score.outcome, evaluation::Outcome::kTimeout);
  EXPECT_EQ(score.outcome_time_s, 11.5);
}

TEST_F(TrackDataset, TakesAPoseThatIsNoneForALostFrame) {
  std::vector<std::string> warnings;
  TrackOptions options;
  options.log = [&](const std::string& line) {
    if (line.starts_with("warning")) warnings.push_back(line);
  };
  const TrackedDataset result = tracked(
      [](const VoFrame& frame, VoEstimate estimate) {
        if (frame.index == 3) estimate.sample.T_vo_camera.translation.y() = std::nan("");
        return estimate;
      },
      options);
  ASSERT_EQ(result.records.size(), 6U);
  EXPECT_EQ(result.records[3].sample.state, TrackingState::kLost);
  EXPECT_EQ(result.records[4].sample.state, TrackingState::kTracking);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_THAT(warnings[0], HasSubstr("warning: frame 3: the position is not finite"));
  ASSERT_TRUE(write_track(path() / "t.tum", result).ok());
  EXPECT_EQ(read_trajectory(path() / "t.tum")->trajectory.size(), 5U);
}

TEST_F(TrackDataset, NamesTheBrokenImageInTheMiddle) {
  write_text(path() / "images" / "00004.png", "no image any more");
  ScriptedPort port(well);
  const auto result = track_dataset(dataset_, port, {});
  ASSERT_FALSE(result.ok());
  EXPECT_THAT(result.error().message, HasSubstr("times.txt:5: "));
  EXPECT_THAT(result.error().message, HasSubstr("00004.png: not an image"));
}

TEST_F(TrackDataset, CountsUnansweredFramesAndImagesThatArrivedChanged) {
  const TrackedDataset result = tracked([](const VoFrame& frame, VoEstimate estimate) {
    estimate.image_crc32 = crc32_of(*frame.image) + (frame.index == 1 ? 1U : 0U);
    if (frame.index > 3) {
      estimate.sample.state = TrackingState::kLost;
      estimate.counters["unanswered"] = 1;
    }
    return estimate;
  });
  EXPECT_EQ(result.hash_mismatches, 1);
  EXPECT_EQ(result.unanswered, 2);
}

TEST_F(TrackDataset, WritesTheLongestMapAndTheStateOfEveryFrame) {
  const TrackedDataset result = tracked([](const VoFrame& frame, VoEstimate estimate) {
    estimate.sample.map_id = frame.index < 2 ? 0 : 1;
    if (frame.index == 2) estimate.sample.state = TrackingState::kInitialising;
    return estimate;
  });
  ASSERT_TRUE(write_track(path() / "t.tum", result).ok());
  const auto file = read_trajectory(path() / "t.tum");
  ASSERT_TRUE(file.ok()) << file.error().message;
  ASSERT_EQ(file->trajectory.size(), 3U);
  EXPECT_EQ(file->trajectory.begin_ns(), 11'500'000'000);
  EXPECT_EQ(file->trajectory.poses().front().pose.translation.x(), 3.0);
  EXPECT_EQ(file->comments.at("init_scene_depth"), "2");
  ASSERT_TRUE(write_statuses(path() / "s.jsonl", result).ok());
  const auto rows = read_lines(path() / "s.jsonl");
  ASSERT_TRUE(rows.ok());
  ASSERT_EQ(rows->size(), 6U);
  EXPECT_EQ((*rows)[2].at("state"), "INITIALISING");
  EXPECT_EQ((*rows)[5].at("map_id"), 1);
}

TEST_F(TrackDataset, WritesAnEmptyTrajectoryWhereNothingWasTracked) {
  const TrackedDataset result = tracked([](const VoFrame&, VoEstimate estimate) {
    estimate.sample.state = TrackingState::kInitialising;
    return estimate;
  });
  EXPECT_EQ(scored_map(result), std::nullopt);
  EXPECT_TRUE(write_track(path() / "t.tum", result).ok());
  EXPECT_EQ(score_of(dataset_, result, {}, true, std::nullopt).outcome,
            evaluation::Outcome::kNotInitialised);
}

TEST_F(TrackDataset, WritesDebugImagesAndThePointsOfTheLongestMap) {
  TrackOptions options;
  options.map_points = true;
  options.debug_folder = path() / "debug";
  fs::create_directories(options.debug_folder);
  const TrackedDataset result = tracked(
      [](const VoFrame& frame, VoEstimate estimate) {
        const auto x = static_cast<float>(frame.index);
        // The second comes to lie within 0.5 % of the depth of where it was.
        estimate.map_points_vo = {{x, 0.0F, 1.0F}, {50.0F, x / 1024.0F, 2.0F}};
        return estimate;
      },
      options);
  const cv::Mat debug = cv::imread((path() / "debug" / "000005.jpg").string());
  EXPECT_EQ(debug.cols, 4);
  const std::vector<Eigen::Vector3f> points = result.map.points(0);
  EXPECT_EQ(points.size(), 7U);
  ASSERT_TRUE(write_ply(path() / "p.ply", points, "map").ok());
  const std::string text = read_text(path() / "p.ply");
  EXPECT_THAT(text, HasSubstr("ply\nformat ascii 1.0\ncomment map\nelement vertex 7\n"));
  EXPECT_THAT(text, HasSubstr("\n50 0.0048828125 2\n"));
}

TEST_F(TrackDataset, ScoresATruthOfTheBodyThroughTheMount) {
  TrajectoryFile truth;
  truth.format = TrajectoryFormat::kEuroc;
  dataset_.T_body_camera = Pose{R_body_camera_nadir(), {0.5, 0, 0}};
  for (int i = 0; i < 6; ++i) {
    ASSERT_TRUE(truth.trajectory
                    .append({dataset_.images[i].t_ns,
                             Pose{Eigen::Quaterniond::Identity(), {static_cast<double>(i), 0, 0}}})
                    .ok());
  }
  std::vector<std::string> notes;
  const Result<Trajectory> camera = camera_truth(dataset_, truth, notes);
  ASSERT_TRUE(camera.ok());
  EXPECT_EQ(camera->poses()[2].pose.translation.x(), 2.5);
  EXPECT_LT(rotation_angle_rad(camera->poses()[2].pose.rotation, R_body_camera_nadir()), 1e-9);
  EXPECT_EQ(notes.size(), 1U);
  const evaluation::Score score = score_of(dataset_, tracked(well), *camera, true, std::nullopt);
  EXPECT_EQ(score.outcome, evaluation::Outcome::kCompleted);
  EXPECT_LT(score.alignments.at(evaluation::AlignmentMode::kSe3).position_m.rmse, 1e-9);
}

TEST_F(TrackDataset, ComputesEulerAnglesOfTheBodyFromTheMount) {
  // The body pitches by 5 deg, only in the truth; its camera looks forward.
  Pose& mount = dataset_.T_body_camera.emplace();
  mount.rotation = R_body_camera_nadir() * Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitX());
  TrajectoryFile truth;
  for (int i = 0; i < 6; ++i) {
    const double pitch_rad = i < 3 ? 0.0 : rad_from_deg(5.0);
    const Eigen::Quaterniond R_world_body(Eigen::AngleAxisd(pitch_rad, Eigen::Vector3d::UnitY()));
    ASSERT_TRUE(
        truth.trajectory
            .append({dataset_.images[i].t_ns, Pose{R_world_body * mount.rotation, {1.0 * i, 0, 0}}})
            .ok());
  }
  std::vector<std::string> notes;
  const auto euler_of = [&] {
    const Result<Trajectory> camera = camera_truth(dataset_, truth, notes);
    const evaluation::Score score = score_of(dataset_, tracked(well), *camera, true, std::nullopt);
    return score.alignments.at(evaluation::AlignmentMode::kOrigin).rotation_euler_norm_deg->max;
  };
  EXPECT_NEAR(euler_of(), 5.0, 1e-6);
  EXPECT_TRUE(notes.empty());
  dataset_.T_body_camera.reset();
  EXPECT_GT(std::abs(euler_of() - 5.0), 1e-3);
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_THAT(notes[0], HasSubstr("mount is not known"));
}

TEST_F(TrackDataset, PutsKittisTruthIntoTheCameraThatIsTracked) {
  TrajectoryFile truth;
  truth.format = TrajectoryFormat::kKitti;
  dataset_.camera_name = "image_2";
  dataset_.T_first_camera = Pose{Eigen::Quaterniond::Identity(), {-0.06, 0, 0}};
  const Pose turned{Eigen::Quaterniond(Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitZ())),
                    {7, 0, 0}};
  ASSERT_TRUE(truth.trajectory.append({0, turned}).ok());
  std::vector<std::string> notes;
  const Result<Trajectory> camera = camera_truth(dataset_, truth, notes);
  ASSERT_TRUE(camera.ok());
  EXPECT_NEAR(camera->poses()[0].pose.translation.y(), -0.06, 1e-12);
  EXPECT_THAT(notes.back(), HasSubstr("those of image_2 are computed with calib.txt"));
}

TEST_F(TrackDataset, ScoresNoFrameWhereTheTruthDoesNotKnow) {
  TrajectoryFile truth;
  truth.unknown_poses = 3;
  for (int i = 0; i < 6; ++i) {
    if (i == 2) truth.trajectory.append_gap();
    if (i >= 2 && i < 5) continue;
    ASSERT_TRUE(truth.trajectory
                    .append({dataset_.images[i].t_ns,
                             Pose{Eigen::Quaterniond::Identity(), {1.0 * i, 0, 0}}})
                    .ok());
  }
  std::vector<std::string> notes;
  const Result<Trajectory> camera = camera_truth(dataset_, truth, notes);
  EXPECT_THAT(notes.back(), HasSubstr("unknown poses in the truth: 3;"));
  const evaluation::Score score = score_of(dataset_, tracked(well), *camera, true, std::nullopt);
  EXPECT_EQ(score.alignments.at(evaluation::AlignmentMode::kSe3).matched, 3);
}

TEST_F(TrackDataset, ScoresNoFrameInALongStepOfTheTruth) {
  constexpr std::int64_t kStepNs = 10'000'000;
  TrajectoryFile truth;
  const std::int64_t begin_ns = dataset_.images[0].t_ns;
  const std::int64_t hole_ns = dataset_.images[5].t_ns;
  // Up to the last image but one; after that only long after the last one.
  for (std::int64_t t_ns = begin_ns; t_ns < hole_ns; t_ns += kStepNs) {
    ASSERT_TRUE(
        truth.trajectory.append({t_ns, Pose{Eigen::Quaterniond::Identity(), {1e-9 * t_ns, 0, 0}}})
            .ok());
  }
  ASSERT_TRUE(truth.trajectory.append({hole_ns + 3 * kNsPerS, Pose{}}).ok());
  std::vector<std::string> notes;
  const Result<Trajectory> camera = camera_truth(dataset_, truth, notes);
  ASSERT_TRUE(camera.ok());
  EXPECT_THAT(notes.back(),
              HasSubstr("of the truth, its steps of more than 1.000 s are gaps (1, "));
  const evaluation::Score score = score_of(dataset_, tracked(well), *camera, true, std::nullopt);
  EXPECT_EQ(score.alignments.at(evaluation::AlignmentMode::kSe3).matched, 5);
}

TEST_F(TrackDataset, MatchesATruthWithoutTimesByItsLines) {
  Trajectory truth;
  for (int i = 0; i < 6; ++i) {
    ASSERT_TRUE(
        truth.append({i * 1'000'000'000LL, Pose{Eigen::Quaterniond::Identity(), {2.0 * i, 0, 0}}})
            .ok());
  }
  const evaluation::Score score = score_of(dataset_, tracked(well), truth, false, std::nullopt);
  const auto& aligned = score.alignments.at(evaluation::AlignmentMode::kSim3);
  EXPECT_EQ(aligned.matched, 6);
  EXPECT_NEAR(aligned.S_world_vo.scale, 2.0, 1e-9);
  // At the times of the images: divergence and the first 5 s are judged by them.
  ASSERT_EQ(score.matched_t_ns.size(), 6U);
  for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(score.matched_t_ns[i], dataset_.images[i].t_ns);
}

}  // namespace
}  // namespace overfly::server
