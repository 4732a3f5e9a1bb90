// Tracks to score.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <vector>

#include "core/time.hpp"
#include "evaluation/evaluation.hpp"

namespace overfly::evaluation {

inline constexpr std::int64_t kFrameNs = 100'000'000;  // 10 Hz

/// A nadir camera on a wavy path, `count` poses at 10 Hz.
inline Trajectory wavy_truth(int count) {
  Trajectory truth;
  for (int i = 0; i < count; ++i) {
    const double t_s = 0.1 * i;
    const Eigen::Vector3d p(
        60.0 * std::sin(0.2 * t_s), 25.0 * t_s, 300.0 + 10.0 * std::cos(0.3 * t_s));
    const RollPitchYaw attitude{0.5 * std::sin(0.4 * t_s), 0.05 * std::sin(t_s), 0.3 * t_s};
    const Pose T_world_camera =
        Pose{R_world_body_from(attitude), p} * Pose{R_body_camera_nadir(), Eigen::Vector3d::Zero()};
    static_cast<void>(truth.append({i * kFrameNs, T_world_camera}));
  }
  return truth;
}

/// The truth as an estimator sees it whose frame stands so in the world.
inline EstimateTrack seen_from(const Trajectory& truth, const Similarity& S_world_vo) {
  EstimateTrack track;
  const Similarity S_vo_world = S_world_vo.inverse();
  for (const StampedPose& stamped : truth.poses()) {
    EstimateSample sample;
    sample.frame = static_cast<std::int64_t>(track.samples.size());
    sample.t_ns = stamped.t_ns;
    sample.state = TrackingState::kTracking;
    sample.T_vo_camera = S_vo_world * stamped.pose;
    track.samples.push_back(sample);
  }
  return track;
}

inline Similarity some_similarity() {
  return {273.0, Eigen::Quaterniond(0.3, -0.7, 0.2, 0.6).normalized(), {1200.0, -350.0, 80.0}};
}

/// The pairs of a track with the truth, by the default options.
inline std::vector<MatchedPose> matches_of(const Trajectory& truth, const EstimateTrack& track) {
  const auto matches = associate(truth, track, {});
  EXPECT_TRUE(matches.ok()) << (matches.ok() ? "" : matches.error().message);
  return matches.ok() ? *matches : std::vector<MatchedPose>{};
}

}  // namespace overfly::evaluation
