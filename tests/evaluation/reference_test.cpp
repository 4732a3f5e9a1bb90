// Scores of 50 random flights against tests/reference/evaluation/make_scores.py.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <sstream>

#include "evaluation/evaluation.hpp"
#include "tests/support/support.hpp"

namespace overfly::evaluation {
namespace {

constexpr std::int64_t kDtNs = 32258065;

/// The generator of the reference script.
class Generator {
 public:
  explicit Generator(std::uint64_t seed) : state_(seed) {}
  double uniform() {
    state_ = state_ * 6364136223846793005U + 1442695040888963407U;
    return static_cast<double>(state_ >> 11) * 0x1p-53;
  }
  double centred() { return uniform() - 0.5; }
  Eigen::Vector3d vector(double x, double y, double z) {
    // One after the other: the order of a call's arguments is not defined.
    const double a = x * centred();
    const double b = y * centred();
    const double c = z * centred();
    return {a, b, c};
  }
  Eigen::Quaterniond quaternion(double size) {
    const double w = size * centred();
    const Eigen::Vector3d v = vector(size, size, size);
    return {w, v.x(), v.y(), v.z()};
  }

 private:
  std::uint64_t state_;
};

struct Flight {
  Trajectory truth;
  EstimateTrack track;
  double true_depth_m = 0.0;
};

Trajectory make_truth(Generator& g, int count) {
  Eigen::Vector3d p(0.0, 0.0, 300.0);
  Eigen::Vector3d v(1.0, 0.5, 0.0);
  Eigen::Quaterniond q = Eigen::Quaterniond::Identity();
  Trajectory truth;
  for (int i = 0; i < count; ++i) {
    EXPECT_TRUE(truth.append({i * kDtNs, {q, p}}).ok());
    v += g.vector(1.0, 1.0, 0.5);
    p += v;
    q.coeffs() += g.quaternion(0.3).coeffs();
    q.normalize();
  }
  return truth;
}

Flight make_flight(int index) {
  Generator g(static_cast<std::uint64_t>(1000 + index));
  const int count = 80 + static_cast<int>(g.uniform() * 60);
  Flight flight;
  flight.truth = make_truth(g, count);
  const double scale = 0.1 + 3.0 * g.uniform();
  const Eigen::Quaterniond rotation = g.quaternion(1.0).normalized();
  const Eigen::Vector3d shift = g.vector(100.0, 100.0, 100.0);
  const auto late_ns = static_cast<std::int64_t>(g.uniform() * 8e6);
  const int begin = static_cast<int>(g.uniform() * 5);
  const int gap = 20 + static_cast<int>(g.uniform() * 20);
  const int end = count - static_cast<int>(g.uniform() * 20);
  const double depth = 1.0 + g.uniform();
  flight.true_depth_m = 250.0 + 100.0 * g.uniform();
  for (int i = 0; i < count; ++i) {
    const StampedPose& stamped = flight.truth.poses()[static_cast<std::size_t>(i)];
    const Eigen::Vector3d noise = g.vector(1.0, 1.0, 1.0);
    const Eigen::Vector3d turn = g.vector(0.05, 0.05, 0.05);
    EstimateSample sample;
    sample.frame = i;
    sample.t_ns = stamped.t_ns + late_ns;
    const bool tracked = begin <= i && i < end && !(gap <= i && i < gap + 3);
    sample.state = tracked ? TrackingState::kTracking : TrackingState::kLost;
    sample.T_vo_camera.translation =
        (rotation.conjugate() * (stamped.pose.translation - shift) + noise) / scale;
    sample.T_vo_camera.rotation =
        rotation.conjugate() * stamped.pose.rotation *
        Eigen::Quaterniond(1.0, turn.x(), turn.y(), turn.z()).normalized();
    sample.scene_depth = depth;
    flight.track.samples.push_back(sample);
  }
  return flight;
}

std::vector<double> numbers_of(const AlignmentScore& score) {
  std::vector<double> numbers{score.S_world_vo.scale,
                              score.position_m.rmse,
                              score.position_m.mean,
                              score.position_m.median,
                              score.position_m.max,
                              score.position_rmse_hold_m,
                              score.rotation_deg.value().rmse,
                              score.rotation_euler_norm_deg.value().rmse};
  for (const double length_m : {10.0, 40.0}) {
    RelativeError relative;
    for (const RelativeError& candidate : score.relative) {
      if (candidate.length_m == length_m) relative = candidate;
    }
    numbers.push_back(relative.pairs);
    numbers.push_back(relative.translation_percent);
    numbers.push_back(relative.translation_mean_percent);
    numbers.push_back(relative.rotation_deg_per_100m);
    numbers.push_back(relative.rotation_mean_deg_per_100m);
  }
  return numbers;
}

TEST(Reference, FiftyRandomFlightsScoreAsTheIndependentScriptSays) {
  std::istringstream lines(
      testing::read_text(testing::source_file("tests/reference/evaluation/scores.txt")));
  std::string line;
  int checked = 0;
  int flight_index = -1;
  Score scored;
  while (std::getline(lines, line)) {
    std::istringstream fields(line);
    int index = 0;
    std::string association;
    std::string mode_name;
    fields >> index >> association >> mode_name;
    if (index != flight_index) {
      const Flight flight = make_flight(index);
      Options options;
      options.association =
          association == "nearest" ? Association::kNearest : Association::kInterpolate;
      options.init_true_depth_m = flight.true_depth_m;
      options.rpe_lengths_m = {10.0, 40.0};
      options.first_s = 2.0;
      scored = score(flight.truth, flight.track, options);
      flight_index = index;
    }
    const auto mode = alignment_mode_from(mode_name);
    ASSERT_TRUE(mode.has_value()) << mode_name;
    ASSERT_EQ(scored.alignments.count(*mode), 1U) << line;
    for (const double number : numbers_of(scored.alignments.at(*mode))) {
      double expected = NAN;
      ASSERT_TRUE(fields >> expected) << line;
      // The file has 12 digits.
      ASSERT_NEAR(number, expected, 1e-9 * std::max(1.0, std::abs(expected))) << line;
      ++checked;
    }
  }
  EXPECT_EQ(checked, 50 * 8 * 18);
}

}  // namespace
}  // namespace overfly::evaluation
