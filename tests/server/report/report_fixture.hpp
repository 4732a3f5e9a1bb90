// Runs made by hand, for what a report says about them.
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <string>

#include "core/time.hpp"
#include "server/record/run_records.hpp"
#include "server/report/run/report_run.hpp"
#include "server/scoring/metrics.hpp"

namespace overfly::server::report::testing {

/// 20 m/s at 10 Hz along a bent path, at 47 N, 8 E.
inline ReportRun bent_run(int frames) {
  ReportRun run;
  run.manifest.world.emplace();
  run.manifest.world->origin = geodetic_from_deg(47.0, 8.0, 500.0);
  run.cameras.emplace_back();
  run.frames.emplace_back();
  for (int i = 0; i < frames; ++i) {
    FrameRow row;
    row.frame = i;
    row.t_ns = i * (kNsPerS / 10);
    const double t_s = s_from_ns(row.t_ns);
    row.T_world_body = {R_world_body_from({0.2, 0.0, 0.1 * t_s}),
                        Eigen::Vector3d(20.0 * t_s, 0.5 * t_s * t_s, 100.0)};
    row.T_world_camera = row.T_world_body * run.cameras[0].T_body_camera;
    row.texels_per_pixel_median = 2.0;
    row.texels_per_pixel_min = 1.0;
    row.axis_depth_m = 100.0;
    run.frames[0].push_back(row);
  }
  return run;
}

/// Adds an estimator that answers each frame with the state that `state_of` gives it, 1 m above the
/// truth, and scores it by `none`.
inline void add_estimator(ReportRun& run,
                          const std::string& name,
                          const std::function<TrackingState(std::int64_t)>& state_of) {
  RunRecords records;
  records.cameras[0].frames = run.frames[0];
  EstimatorRecords recorded{name, "feature", {}};
  ReportEstimate estimate;
  estimate.name = name;
  for (const FrameRow& frame : run.frames[0]) {
    EstimateSample sample;
    sample.frame = frame.frame;
    sample.t_ns = frame.t_ns;
    sample.state = state_of(frame.frame);
    sample.T_vo_camera = frame.T_world_camera;
    sample.T_vo_camera.translation.z() += 1.0;
    EstimateRecord record;
    record.sample = sample;
    recorded.records.push_back(record);
    const bool tracks = sample.state == TrackingState::kTracking;
    estimate.answers.push_back({sample.t_ns,
                                sample.state,
                                tracks,
                                5.0,
                                tracks ? std::optional<Pose>(frame.T_world_body) : std::nullopt});
  }
  records.estimators.push_back(recorded);
  run.metrics.estimators[name] = metrics_from(records).estimators.at(name);
  run.metrics.flight = metrics_from(records).flight;
  run.estimates.push_back(estimate);
}

}  // namespace overfly::server::report::testing
