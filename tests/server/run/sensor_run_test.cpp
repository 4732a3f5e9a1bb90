// Runs with sensors in addition to the cameras: what estimators and the folder get, and when.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>

#include "server/record/rows/sensor_files.hpp"
#include "server/run/run.hpp"
#include "tests/server/support/server_fixture.hpp"

namespace overfly::server {
namespace {

namespace fs = std::filesystem;
using overfly::testing::TemporaryFolder;
using testing::contents_without_timings;
using ::testing::HasSubstr;
using testing::options_for;
using testing::small_scenario;

constexpr const char* kAllSensors =
    R"(sensors={"imu":{},"barometer":{},"gps":{},"airspeed":{},"magnetometer":{},"range":{"max_m":1000}})";

/// Keeps the samples of each frame.
class SampleKeeper final : public VoPort {
 public:
  using Kept = std::vector<VoFrame>;
  explicit SampleKeeper(Kept& kept) : kept_(kept) {}
  std::string type() const override { return "keeper"; }
  std::map<std::string, std::string> effective_parameters() const override { return {}; }
  Result<VoEstimate> track(const VoFrame& frame) override {
    kept_.push_back(frame);
    VoEstimate estimate;
    estimate.sample.frame = frame.index;
    estimate.sample.t_ns = frame.t_ns;
    return estimate;
  }
  void set_debug(bool /*wanted*/) override {}

 private:
  Kept& kept_;
};

Scenario kept_scenario(std::vector<std::string> overrides = {}) {
  overrides.emplace_back(R"(estimators=[{"name":"k","type":"feature"}])");
  return small_scenario(overrides);
}

RunOptions keeping(const fs::path& folder, SampleKeeper::Kept& kept) {
  RunOptions options = options_for(folder);
  options.estimator_factory = [&kept](const EstimatorSpec&) {
    return Result<std::unique_ptr<VoPort>>(std::make_unique<SampleKeeper>(kept));
  };
  return options;
}

/// All samples of the frames, in order.
SensorSamples all_of(const SampleKeeper::Kept& frames) {
  SensorSamples all;
  for (const VoFrame& frame : frames) append(all, SensorSamples(frame.sensors));
  return all;
}

TEST(SensorRun, EachFrameBringsTheSamplesSinceThePreviousOneAndTheFolderHasAll) {
  const TemporaryFolder folder;
  SampleKeeper::Kept frames;
  const auto run = run_scenario(kept_scenario({kAllSensors}), keeping(folder.path() / "r", frames));
  ASSERT_TRUE(run.ok()) << run.error().message;
  ASSERT_EQ(frames.size(), 21U);

  std::int64_t before_ns = -1;
  for (const VoFrame& frame : frames) {
    for (const ImuSample& sample : frame.sensors.imu) {
      // Half an interval later it is complete.
      EXPECT_GT(sample.t_ns + 2'500'000, before_ns);
      EXPECT_LE(sample.t_ns + 2'500'000, frame.t_ns);
    }
    for (const GpsSample& sample : frame.sensors.gps) {
      EXPECT_GT(sample.delivered_ns, before_ns);
      EXPECT_LE(sample.delivered_ns, frame.t_ns);
    }
    before_ns = frame.t_ns;
  }
  const SensorSamples sent = all_of(frames);
  const double flight_s = s_from_ns(before_ns);
  EXPECT_NEAR(static_cast<double>(sent.imu.size()), 200.0 * flight_s, 1.0);
  EXPECT_FALSE(sent.barometer.empty() || sent.gps.empty() || sent.airspeed.empty() ||
               sent.magnetometer.empty() || sent.range.empty());

  // The folder has what was sent, and one frame period more.
  const SensorSamples recorded = SensorFilesReader::open(folder.path() / "r")
                                     .value()
                                     .until(std::numeric_limits<std::int64_t>::max())
                                     .value();
  ASSERT_GT(recorded.imu.size(), sent.imu.size());
  for (std::size_t i = 0; i < sent.imu.size(); ++i) {
    ASSERT_EQ(recorded.imu[i].t_ns, sent.imu[i].t_ns);
    ASSERT_EQ(recorded.imu[i].acceleration_m_s2, sent.imu[i].acceleration_m_s2);
    ASSERT_EQ(recorded.imu[i].angular_rate_rad_s, sent.imu[i].angular_rate_rad_s);
  }
  ASSERT_GE(recorded.range.size(), sent.range.size());
  EXPECT_EQ(recorded.range[0].range_m, sent.range[0].range_m);
}

TEST(SensorRun, EqualRunsHaveEqualSamples) {
  const TemporaryFolder folder;
  const Scenario scenario = kept_scenario({kAllSensors});
  SampleKeeper::Kept ignored;
  for (const char* name : {"a", "b"}) {
    ASSERT_TRUE(run_scenario(scenario, keeping(folder.path() / name, ignored)).ok());
  }
  EXPECT_TRUE(fs::exists(folder.path() / "a" / "sensors" / "imu.csv"));
  EXPECT_EQ(contents_without_timings(folder.path() / "a"),
            contents_without_timings(folder.path() / "b"));
}

TEST(SensorRun, SensorsDoNotChangeTheFlight) {
  const TemporaryFolder folder;
  SampleKeeper::Kept ignored;
  ASSERT_TRUE(run_scenario(kept_scenario(), keeping(folder.path() / "bare", ignored)).ok());
  ASSERT_TRUE(
      run_scenario(kept_scenario({kAllSensors}), keeping(folder.path() / "fitted", ignored)).ok());
  EXPECT_FALSE(fs::exists(folder.path() / "bare" / "sensors"));
  for (const char* file : {"truth_samples.bin", "frames.jsonl"}) {
    EXPECT_EQ(overfly::testing::read_text(folder.path() / "bare" / file),
              overfly::testing::read_text(folder.path() / "fitted" / file))
        << file;
  }
}

TEST(SensorRun, SamplesOfLostFramesComeWithTheNextOne) {
  const TemporaryFolder folder;
  SampleKeeper::Kept frames, all;
  ASSERT_TRUE(run_scenario(kept_scenario({kAllSensors}), keeping(folder.path() / "a", all)).ok());
  ASSERT_TRUE(
      run_scenario(
          kept_scenario({kAllSensors, R"(faults=[{"kind":"dropped_frames","at_s":0,"every":2}])"}),
          keeping(folder.path() / "b", frames))
          .ok());
  ASSERT_EQ(frames.size(), 10U);
  const SensorSamples few = all_of(frames);
  const SensorSamples many = all_of({all.begin(), all.end() - 1});
  ASSERT_EQ(few.imu.size(), many.imu.size());
  for (std::size_t i = 0; i < few.imu.size(); ++i) EXPECT_EQ(few.imu[i].t_ns, many.imu[i].t_ns);
}

TEST(SensorRun, AnOutageOfTheGpsIsATimedEvent) {
  const TemporaryFolder folder;
  SampleKeeper::Kept frames;
  ASSERT_TRUE(
      run_scenario(kept_scenario({R"(sensors={"gps":{"rate_hz":10,"delay_s":0}})",
                                  R"(faults=[{"kind":"gps_outage","at_s":0.5,"duration_s":0.7}])"}),
                   keeping(folder.path() / "r", frames))
          .ok());
  int lost = 0;
  for (const GpsSample& sample : all_of(frames).gps) {
    const bool out = sample.t_ns >= 500'000'000 && sample.t_ns < 1'200'000'000;
    EXPECT_EQ(sample.fix == GpsFixType::kNone, out) << sample.t_ns;
    if (out) ++lost;
  }
  EXPECT_EQ(lost, 7);
  const std::string log = overfly::testing::read_text(folder.path() / "r" / "log.jsonl");
  EXPECT_THAT(log, HasSubstr("gps_outage begins, for 0.7 s"));
  EXPECT_THAT(log, HasSubstr("gps_outage ends"));
  EXPECT_EQ(overfly::testing::read_text(folder.path() / "r" / "frames.jsonl").find("gps_outage"),
            std::string::npos);
}

}  // namespace
}  // namespace overfly::server
