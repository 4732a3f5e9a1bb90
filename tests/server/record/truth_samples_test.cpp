// The truth in a run folder: every bit comes back, and damaged files are refused.
#include "server/record/truth_samples.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <fstream>

#include "core/time.hpp"
#include "tests/support/support.hpp"

namespace overfly::server {
namespace {

namespace fs = std::filesystem;
using overfly::testing::larger_error;
using overfly::testing::TemporaryFolder;
using ::testing::HasSubstr;

AircraftState truth(std::int64_t t_ns) {
  const double t_s = s_from_ns(t_ns);
  AircraftState state;
  state.t_ns = t_ns;
  state.T_world_body.translation = {30.0 * std::sin(t_s), 30.0 * std::cos(t_s), 100.0 + t_s};
  state.T_world_body.rotation = R_world_body_from({0.3 * std::sin(2.0 * t_s), 0.1, t_s});
  state.v_body_world_m_s = {30.0 * std::cos(t_s), -30.0 * std::sin(t_s), 1.0};
  state.omega_body_rad_s = {0.1, t_s, -0.3};
  state.airspeed_m_s = 30.0 + t_s;
  return state;
}

/// Ends after some time; fails a test that goes back in time.
class Spiral final : public TruthSource {
 public:
  explicit Spiral(std::int64_t end_ns) : end_ns_(end_ns) {}
  std::optional<std::int64_t> duration_ns() const override { return std::nullopt; }
  std::string description() const override { return "spiral"; }

 private:
  Result<std::optional<AircraftState>> find_state(std::int64_t t_ns,
                                                  const std::atomic<bool>* /*cancel*/) override {
    EXPECT_GE(t_ns, last_ns_) << "asked for the past";
    last_ns_ = t_ns;
    if (t_ns > end_ns_) return std::optional<AircraftState>();
    return std::optional(truth(t_ns));
  }
  std::int64_t end_ns_;
  std::int64_t last_ns_ = 0;
};

void expect_equal_bits(const AircraftState& a, const AircraftState& b) {
  EXPECT_EQ(a.t_ns, b.t_ns);
  EXPECT_EQ(a.T_world_body.translation, b.T_world_body.translation);
  EXPECT_EQ(a.T_world_body.rotation.coeffs(), b.T_world_body.rotation.coeffs());
  EXPECT_EQ(a.v_body_world_m_s, b.v_body_world_m_s);
  EXPECT_EQ(a.omega_body_rad_s, b.omega_body_rad_s);
  EXPECT_EQ(a.airspeed_m_s, b.airspeed_m_s);
}

/// Flies frames at 31 Hz and records them.
void fly(const fs::path& file, std::int64_t frames, std::int64_t end_ns = 3600 * kNsPerS) {
  auto samples = TruthSampleFile::create(file);
  ASSERT_TRUE(samples.ok()) << samples.error().message;
  const auto flight = recorded_while_flown(std::make_unique<Spiral>(end_ns), *samples);
  for (std::int64_t k = 0; k < frames; ++k) {
    const auto state = flight->state_at(frame_time_ns(k, {31, 1}));
    ASSERT_TRUE(state.ok()) << state.error().message;
    if (!*state) break;
    ASSERT_TRUE(samples->flush().ok());
  }
  ASSERT_TRUE(samples->flush().ok());
}

std::unique_ptr<TruthSource> opened(const fs::path& file) {
  auto flight = open_recorded_flight(file, "spiral");
  if (!flight) throw std::runtime_error(flight.error().message);
  return std::move(*flight);
}

/// Writes one eight-byte value of a sample.
template <typename Value>
void put(const fs::path& file, std::size_t sample, std::size_t field, Value value) {
  static_assert(sizeof(Value) == 8);
  std::fstream stream(file, std::ios::in | std::ios::out | std::ios::binary);
  stream.seekp(static_cast<std::streamoff>(sample * kTruthSampleBytes + 8 * field));
  stream.write(reinterpret_cast<const char*>(&value), 8);
}

TEST(TruthSamples, StatesOfFramesComeBackBitByBitInAnyOrder) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "truth_samples.bin";
  fly(file, 400);  // more than two blocks of samples
  const auto flight = opened(file);
  EXPECT_EQ(flight->description(), "spiral");
  EXPECT_EQ(flight->duration_ns(), frame_time_ns(399, {31, 1}));
  for (const std::int64_t k : {399, 0, 200, 201, 1, 398, 31}) {
    const std::int64_t t_ns = frame_time_ns(k, {31, 1});
    const auto state = flight->state_at(t_ns);
    ASSERT_TRUE(state.ok() && state->has_value()) << k;
    expect_equal_bits(**state, truth(t_ns));
  }
  EXPECT_FALSE(flight->state_at(frame_time_ns(400, {31, 1})).value().has_value());
}

TEST(TruthSamples, AreInterpolatedFromTwoHundredEachSecond) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "truth_samples.bin";
  fly(file, 63);
  // Frames 0 to 62 span 2 s; 3 of the 401 samples of the grid are frames (0, 1 and 2 s).
  EXPECT_EQ(fs::file_size(file), kTruthSampleBytes * (401 + 63 - 3));
  const auto flight = opened(file);
  double worst_m = 0.0, worst_rad = 0.0, worst_m_s = 0.0;
  for (std::int64_t t_ns = 0; t_ns < 2 * kNsPerS; t_ns += 777'777) {
    const AircraftState state = flight->state_at(t_ns).value().value();
    const AircraftState exact = truth(t_ns);
    worst_m = larger_error(
        worst_m, (state.T_world_body.translation - exact.T_world_body.translation).norm());
    worst_m_s = larger_error(worst_m_s, (state.v_body_world_m_s - exact.v_body_world_m_s).norm());
    worst_rad = larger_error(
        worst_rad, rotation_angle_rad(state.T_world_body.rotation, exact.T_world_body.rotation));
  }
  // Hermite: h^4 / 384 of the fourth derivative (30 m/s4), h = 5 ms; SLERP: h^2 / 8 of 1.2 rad/s2.
  EXPECT_LT(worst_m, 1e-10);
  EXPECT_LT(worst_m_s, 1e-7);
  EXPECT_LT(worst_rad, 1e-5);
}

TEST(TruthSamples, EndWithTheFlightAndOmitNothingBeforeItsEnd) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "truth_samples.bin";
  fly(file, 100, kNsPerS);
  const auto flight = opened(file);
  EXPECT_EQ(flight->duration_ns(), kNsPerS);
  EXPECT_FALSE(flight->state_at(kNsPerS + 1).value().has_value());
}

TEST(TruthSamples, AFileIsReadOnWhileItGrows) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "truth_samples.bin";
  auto samples = TruthSampleFile::create(file);
  ASSERT_TRUE(samples.ok());
  const auto flight = opened(file);
  EXPECT_FALSE(flight->state_at(0).value().has_value());
  for (std::int64_t k = 0; k < 3000; ++k) {
    samples->add(truth(k * 1'000'000));
    if (k % 500 != 7) continue;
    ASSERT_TRUE(samples->flush().ok());
    expect_equal_bits(flight->state_at(k * 1'000'000).value().value(), truth(k * 1'000'000));
    expect_equal_bits(flight->state_at(k / 2 * 1'000'000).value().value(),
                      truth(k / 2 * 1'000'000));
  }
}

TEST(TruthSamples, TheRestOfAKilledWriteIsIgnored) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "truth_samples.bin";
  fly(file, 10);
  fs::resize_file(file, fs::file_size(file) - 1);
  const auto flight = opened(file);
  const std::int64_t last_ns = *flight->duration_ns();
  EXPECT_LT(last_ns, frame_time_ns(9, {31, 1}));
  EXPECT_TRUE(flight->state_at(last_ns).value().has_value());
}

TEST(TruthSamples, DamagedSamplesAreNamed) {
  const TemporaryFolder folder;
  const auto refused_at = [&](std::size_t sample,
                              std::size_t field,
                              auto value,
                              std::int64_t asked_frame) {
    const fs::path file = folder.path() / "damaged.bin";
    fs::remove(file);
    fly(file, 400);
    put(file, sample, field, value);
    const auto flight = open_recorded_flight(file, "");
    const Error error =
        flight ? (*flight)->state_at(frame_time_ns(asked_frame, {31, 1})).error() : flight.error();
    EXPECT_EQ(error.code, ErrorCode::kUnreadable) << error.message;
    EXPECT_THAT(error.message, HasSubstr("damaged.bin: sample " + std::to_string(sample) + ": "));
  };
  refused_at(3, 1, std::nan(""), 2);
  refused_at(3, 4, 7.0, 2);                  // no unit quaternion
  refused_at(3, 0, std::int64_t{0}, 2);      // time does not increase
  refused_at(1024, 0, std::int64_t{-5}, 2);  // nor from block to block
  refused_at(1030, 8, HUGE_VAL, 140);        // found when its block is read
  refused_at(3, 2, -1e9, 2);                 // a position beyond any flight
  refused_at(3, 11, 1e7, 2);                 // a speed beyond any flight
  refused_at(0, 0, std::int64_t{-1}, 2);     // flights begin at 0
  refused_at(3, 0, INT64_MAX, 2);            // sums of such times would overflow
}

TEST(TruthSamples, ADamagedBlockThatIsAddedLeavesWhatWasKnown) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "truth_samples.bin";
  auto samples = TruthSampleFile::create(file);
  ASSERT_TRUE(samples.ok());
  const auto add = [&](std::int64_t from, std::int64_t to) {
    for (std::int64_t k = from; k < to; ++k) samples->add(truth(k * 1'000'000));
    ASSERT_TRUE(samples->flush().ok());
  };
  add(0, 1500);
  const auto flight = opened(file);
  add(1500, 5000);
  put(file, 3072, 0, std::int64_t{5});  // the first sample of the fourth block
  for (int attempt = 0; attempt < 3; ++attempt) {
    const auto beyond = flight->state_at(4'500'000'000);
    ASSERT_FALSE(beyond.ok());
    EXPECT_THAT(beyond.error().message, HasSubstr("sample 3072: "));
    expect_equal_bits(flight->state_at(1'499'000'000).value().value(), truth(1'499'000'000));
    expect_equal_bits(flight->state_at(7'000'000).value().value(), truth(7'000'000));
  }
}

TEST(TruthSamples, RefuseWhatIsNoFile) {
  const TemporaryFolder folder;
  EXPECT_EQ(open_recorded_flight(folder.path() / "none", "").error().code, ErrorCode::kNotFound);
  EXPECT_EQ(open_recorded_flight(folder.path(), "").error().code, ErrorCode::kUnreadable);
  EXPECT_EQ(open_recorded_flight("/dev/zero", "").error().code, ErrorCode::kUnreadable);
  EXPECT_EQ(TruthSampleFile::create(folder.path() / "a" / "b").error().code, ErrorCode::kIo);
}

}  // namespace
}  // namespace overfly::server
