// The true and estimated trajectories as ribbons that grow with the run and can be cut at an
// instant.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "renderer/renderer.hpp"
#include "server/timeline/row_alignment.hpp"
#include "server/timeline/run_timeline.hpp"
#include "server/views/track_look.hpp"

namespace overfly::server {

class ViewRibbons {
 public:
  /// @param alignment  of the estimates; an estimate without this alignment has no ribbon
  explicit ViewRibbons(std::shared_ptr<const RunTimeline> timeline,
                       std::string alignment = kRecordedAlignment);

  /// Adds the rows since the last call: every third one, which is less than a wing span apart.
  void refresh();
  /// The truth up to t (ending at `T_world_body_now`) and each estimate's tracked pieces up to t,
  /// as far as they are shown.
  [[nodiscard]] std::vector<renderer::Ribbon> until(std::int64_t t_ns,
                                                    const Pose& T_world_body_now,
                                                    const TrackLook& look) const;
  /// Dashes of each shown estimate's tracked pieces up to t, without the truth.
  [[nodiscard]] std::vector<renderer::Ribbon> dashes_until(std::int64_t t_ns,
                                                           const TrackLook& look) const;
  /// Lines from the truth to each estimate along the path up to t, at most `most` of each estimate
  /// at equal intervals of time.
  [[nodiscard]] std::vector<renderer::SceneContent::Line> errors_until(std::int64_t t_ns,
                                                                       const TrackLook& look,
                                                                       std::size_t most) const;
  /// Centre of the box around the flown trajectory; zero before the first frame [m].
  [[nodiscard]] Eigen::Vector3d centre() const;
  [[nodiscard]] const std::shared_ptr<const RunTimeline>& timeline() const { return timeline_; }
  [[nodiscard]] const std::string& alignment() const { return alignment_; }
  /// The run has been scored, or scored again, since these ribbons were made: their alignments are
  /// of the earlier score.
  [[nodiscard]] bool is_outdated() const { return timeline_->metrics() != metrics_; }
  /// Empty if the estimate has no such alignment.
  [[nodiscard]] const std::optional<RowAlignment>& alignment_of(std::size_t estimator) const {
    return estimates_.at(estimator).alignment;
  }

 private:
  /// Poses without a gap.
  struct Piece {
    int map_id = 0;
    std::vector<std::int64_t> t_ns;
    std::vector<Pose> T_world_body;
  };
  struct Estimate {
    std::size_t rows_seen = 0;
    bool open = false;  ///< the last piece may still grow
    std::optional<RowAlignment> alignment;
    std::vector<Piece> pieces;
  };
  /// Position of the truth between the recorded poses; empty outside of them.
  [[nodiscard]] std::optional<Eigen::Vector3d> truth_at(std::int64_t t_ns) const;
  /// Pose of an estimate's row under the alignment; empty while not tracking.
  [[nodiscard]] std::optional<Pose> T_world_body(std::size_t estimator,
                                                 const EstimateRow& row) const;
  void refresh_truth();
  void refresh_estimate(std::size_t estimator);

  std::shared_ptr<const RunTimeline> timeline_;
  std::shared_ptr<const RunMetrics> metrics_;  ///< that the alignments are of
  std::string alignment_;
  std::size_t rows_seen_ = 0;
  Piece truth_;
  Eigen::Vector3d box_min_;
  Eigen::Vector3d box_max_;
  std::vector<Estimate> estimates_;
};

}  // namespace overfly::server
