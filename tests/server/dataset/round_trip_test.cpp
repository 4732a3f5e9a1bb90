// A flight over the built-in landscape, exported in each layout and tracked there, gives the poses
// that the flight's own estimator gave.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/dataset/open_dataset.hpp"
#include "server/dataset/track_dataset.hpp"
#include "server/estimators/estimator_factory.hpp"
#include "server/export/dataset_export.hpp"
#include "server/record/run_records.hpp"
#include "server/run/run.hpp"
#include "server/scenario/document/scenario_file.hpp"
#include "terrain/synthesize.hpp"
#include "tests/server/support/server_fixture.hpp"

namespace overfly::server {
namespace {

namespace fs = std::filesystem;
using overfly::testing::TemporaryFolder;

constexpr double kSpeedM_s = 25.0;

/// 3 s at 20 Hz over half a metre a texel, the flight and its estimates made once for all layouts.
class RoundTrip : public ::testing::TestWithParam<DatasetFormat> {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TemporaryFolder;
    terrain::SynthesisOptions world;
    world.size_m = 700.0;
    world.texel_m = 0.5;
    ASSERT_TRUE(terrain::synthesize_world(folder_->path() / "world", world).ok());
    const nlohmann::json document = {
        {"format_version", 1},
        {"name", "round"},
        {"seed", 3},
        {"epoch_utc_s", 1'700'000'000},
        {"world", {{"manifest", (folder_->path() / "world" / "world.json").string()}}},
        {"flight",
         {{"course",
           {{"airspeed_m_s", kSpeedM_s},
            {"height_agl_m", 100},
            {"length_m", 800},
            {"leg_length_m", 300}}}}},
        {"duration_s", 3},
        {"camera", {{"width_px", 320}, {"height_px", 240}, {"rate_hz", 20}}},
        {"renderer", {{"camera", "raycast"}, {"threads", 1}}},
        {"estimators",
         {{{"name", "f"}, {"type", "feature"}, {"parameters", {{"features", 500}}}}}}};
    auto scenario = resolve_scenario(document, {}, "/");
    ASSERT_TRUE(scenario.ok()) << scenario.error().message;
    RunOptions options;
    options.folder = run_folder();
    const auto run = run_scenario(*scenario, options);
    ASSERT_TRUE(run.ok()) << run.error().message;
  }
  static void TearDownTestSuite() {
    delete folder_;
    folder_ = nullptr;
  }
  static fs::path run_folder() { return folder_->path() / "run"; }

  static TemporaryFolder* folder_;
};

TemporaryFolder* RoundTrip::folder_ = nullptr;

TEST_P(RoundTrip, GivesThePosesOfTheFlight) {
  const fs::path folder = folder_->path() / to_string(GetParam());
  const auto source = open_export_source(run_folder());
  ASSERT_TRUE(source.ok()) << source.error().message;
  ExportOptions options;
  options.folder = folder;
  options.format = GetParam();
  const auto exported = export_dataset(*source, options);
  ASSERT_TRUE(exported.ok()) << exported.error().message;

  DatasetOptions where;
  where.folder = folder;
  const auto dataset = open_dataset(where);
  ASSERT_TRUE(dataset.ok()) << dataset.error().message;
  EXPECT_STREQ(to_string(dataset->layout), to_string(GetParam()));
  EstimatorSetting setting;
  setting.seed = source->scenario.seed;
  const auto port = create_estimator(source->scenario.estimators.front(), setting);
  ASSERT_TRUE(port.ok()) << port.error().message;
  const auto tracked = track_dataset(*dataset, **port, {});
  ASSERT_TRUE(tracked.ok()) << tracked.error().message;

  const auto records = read_run_records(run_folder());
  ASSERT_TRUE(records.ok()) << records.error().message;
  const std::vector<EstimateRecord>& flown = records->estimators.front().records;
  ASSERT_EQ(tracked->records.size(), flown.size());
  // Numbers of the calibration go through text and, in TUM's, through a division by the image's
  // size: a last bit of them may differ, and nothing more may.
  constexpr double kRounding = 1e-7;
  const std::int64_t offset_ns = tracked->records.front().sample.t_ns - flown.front().sample.t_ns;
  int poses = 0;
  for (std::size_t i = 0; i < flown.size(); ++i) {
    const EstimateSample& there = flown[i].sample;
    const EstimateSample& here = tracked->records[i].sample;
    ASSERT_EQ(here.state, there.state) << "frame " << i;
    ASSERT_EQ(here.t_ns - there.t_ns, offset_ns);
    ASSERT_EQ(here.map_id, there.map_id);
    if (here.state != TrackingState::kTracking) continue;
    ++poses;
    ASSERT_LT((here.T_vo_camera.translation - there.T_vo_camera.translation).norm(), kRounding)
        << "frame " << i;
    ASSERT_LT(rotation_angle_rad(here.T_vo_camera.rotation, there.T_vo_camera.rotation), kRounding)
        << "frame " << i;
  }
  EXPECT_GT(poses, 20);
}

INSTANTIATE_TEST_SUITE_P(Layouts,
                         RoundTrip,
                         ::testing::Values(DatasetFormat::kTumMono,
                                           DatasetFormat::kEuroc,
                                           DatasetFormat::kKitti,
                                           DatasetFormat::kPng),
                         [](const auto& test) {
                           std::string name = to_string(test.param);
                           std::erase(name, '-');
                           return name;
                         });

}  // namespace
}  // namespace overfly::server
