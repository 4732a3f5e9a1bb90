#include "server/views/view_ribbons.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace overfly::server {
namespace {

constexpr std::size_t kEveryRow = 3;
constexpr std::size_t kRowsAtOnce = 1024;
constexpr double kFar = std::numeric_limits<double>::infinity();

constexpr double kEstimateRibbonWidth = 0.5;  ///< relative to the truth's

renderer::Ribbon ribbon_of(const std::vector<std::int64_t>& stamps_ns,
                           const std::vector<Pose>& poses,
                           std::int64_t t_ns,
                           const TrackRgb& rgb) {
  const auto count = std::upper_bound(stamps_ns.begin(), stamps_ns.end(), t_ns) - stamps_ns.begin();
  renderer::Ribbon ribbon;
  ribbon.rgb = rgb;
  ribbon.T_world_body.assign(poses.begin(), poses.begin() + count);
  return ribbon;
}

}  // namespace

ViewRibbons::ViewRibbons(std::shared_ptr<const RunTimeline> timeline, std::string alignment)
    : timeline_(std::move(timeline)),
      metrics_(timeline_->metrics()),
      alignment_(std::move(alignment)),
      box_min_(Eigen::Vector3d::Constant(kFar)),
      box_max_(Eigen::Vector3d::Constant(-kFar)),
      estimates_(timeline_->estimators().size()) {
  for (std::size_t i = 0; i < estimates_.size(); ++i) {
    if (auto found = RowAlignment::of(*timeline_, i, alignment_)) estimates_[i].alignment = *found;
  }
}

std::optional<Pose> ViewRibbons::T_world_body(std::size_t estimator, const EstimateRow& row) const {
  const std::optional<RowAlignment>& alignment = estimates_.at(estimator).alignment;
  return alignment ? alignment->T_world_body(row) : std::nullopt;
}

void ViewRibbons::refresh() {
  refresh_truth();
  for (std::size_t i = 0; i < estimates_.size(); ++i) refresh_estimate(i);
}

void ViewRibbons::refresh_truth() {
  for (;;) {
    const auto rows = timeline_->frames(rows_seen_, kRowsAtOnce);
    if (rows.empty()) return;
    for (const FrameRow& row : rows) {
      box_min_ = box_min_.cwiseMin(row.T_world_body.translation);
      box_max_ = box_max_.cwiseMax(row.T_world_body.translation);
      if (rows_seen_++ % kEveryRow != 0) continue;
      truth_.t_ns.push_back(row.t_ns);
      truth_.T_world_body.push_back(row.T_world_body);
    }
  }
}

void ViewRibbons::refresh_estimate(std::size_t estimator) {
  Estimate& estimate = estimates_[estimator];
  for (;;) {
    const auto rows = timeline_->estimates(estimator, estimate.rows_seen, kRowsAtOnce);
    if (rows.empty()) return;
    for (const EstimateRow& row : rows) {
      const std::size_t index = estimate.rows_seen++;
      const std::optional<Pose> T_world_body = this->T_world_body(estimator, row);
      if (!T_world_body) {
        estimate.open = false;
        continue;
      }
      const bool goes_on = estimate.open && estimate.pieces.back().map_id == row.sample.map_id;
      if (!goes_on) {
        estimate.pieces.emplace_back();
        estimate.pieces.back().map_id = row.sample.map_id;
        estimate.open = true;
      } else if (index % kEveryRow != 0) {
        continue;
      }
      estimate.pieces.back().t_ns.push_back(row.sample.t_ns);
      estimate.pieces.back().T_world_body.push_back(*T_world_body);
    }
  }
}

std::vector<renderer::Ribbon> ViewRibbons::until(std::int64_t t_ns,
                                                 const Pose& T_world_body_now,
                                                 const TrackLook& look) const {
  std::vector<renderer::Ribbon> ribbons;
  if (look.shows("")) {
    ribbons.push_back(ribbon_of(truth_.t_ns, truth_.T_world_body, t_ns, look.truth_rgb()));
    ribbons.back().T_world_body.push_back(T_world_body_now);
  }
  for (std::size_t i = 0; i < estimates_.size(); ++i) {
    const std::string& name = timeline_->estimators()[i];
    if (!look.shows(name)) continue;
    for (const Piece& piece : estimates_[i].pieces) {
      auto ribbon = ribbon_of(piece.t_ns, piece.T_world_body, t_ns, look.rgb_of(name, i));
      // Narrower than the truth, so that the red edges stay visible where both coincide.
      ribbon.wing_span_m *= kEstimateRibbonWidth;
      if (ribbon.T_world_body.size() > 1) ribbons.push_back(std::move(ribbon));
    }
  }
  return ribbons;
}

std::vector<renderer::Ribbon> ViewRibbons::dashes_until(std::int64_t t_ns,
                                                        const TrackLook& look) const {
  // Of recorded poses, about 25 and 12 m at 25 m/s and 31 Hz.
  constexpr std::size_t kDash = 11;
  constexpr std::size_t kPeriod = 15;
  std::vector<renderer::Ribbon> dashes;
  for (std::size_t i = 0; i < estimates_.size(); ++i) {
    const std::string& name = timeline_->estimators()[i];
    if (!look.shows(name)) continue;
    for (const Piece& piece : estimates_[i].pieces) {
      const auto until = std::upper_bound(piece.t_ns.begin(), piece.t_ns.end(), t_ns);
      const auto count = static_cast<std::size_t>(until - piece.t_ns.begin());
      for (std::size_t begin = 0; begin + 1 < count; begin += kPeriod) {
        const auto first = piece.T_world_body.begin() + static_cast<std::ptrdiff_t>(begin);
        const std::size_t length = std::min(kDash, count - begin);
        renderer::Ribbon dash;
        dash.rgb = look.rgb_of(name, i);
        dash.wing_span_m *= kEstimateRibbonWidth;
        dash.T_world_body.assign(first, first + static_cast<std::ptrdiff_t>(length));
        dashes.push_back(std::move(dash));
      }
    }
  }
  return dashes;
}

std::optional<Eigen::Vector3d> ViewRibbons::truth_at(std::int64_t t_ns) const {
  const auto& stamps = truth_.t_ns;
  const auto after = std::lower_bound(stamps.begin(), stamps.end(), t_ns);
  if (after == stamps.end()) return std::nullopt;
  const auto index = static_cast<std::size_t>(after - stamps.begin());
  const Eigen::Vector3d& place = truth_.T_world_body[index].translation;
  if (*after == t_ns) return place;
  if (index == 0) return std::nullopt;
  const auto span = static_cast<double>(*after - stamps[index - 1]);
  const double share = static_cast<double>(t_ns - stamps[index - 1]) / span;
  return (1.0 - share) * truth_.T_world_body[index - 1].translation + share * place;
}

std::vector<renderer::SceneContent::Line> ViewRibbons::errors_until(std::int64_t t_ns,
                                                                    const TrackLook& look,
                                                                    std::size_t most) const {
  constexpr double kWidthPx = 1.2;
  std::vector<renderer::SceneContent::Line> lines;
  if (truth_.t_ns.empty() || most == 0) return lines;
  const std::int64_t span_ns = std::max<std::int64_t>(t_ns - truth_.t_ns.front(), 1);
  const std::int64_t gap_ns = span_ns / static_cast<std::int64_t>(most) + 1;
  for (std::size_t i = 0; i < estimates_.size(); ++i) {
    const std::string& name = timeline_->estimators()[i];
    if (!look.shows(name)) continue;
    const TrackRgb rgb = look.rgb_of(name, i);
    std::int64_t next_ns = truth_.t_ns.front();
    for (const Piece& piece : estimates_[i].pieces) {
      for (std::size_t k = 0; k < piece.t_ns.size() && piece.t_ns[k] <= t_ns; ++k) {
        if (piece.t_ns[k] < next_ns) continue;
        const auto truth = truth_at(piece.t_ns[k]);
        if (!truth) continue;
        lines.push_back({*truth, piece.T_world_body[k].translation, rgb, kWidthPx});
        next_ns = piece.t_ns[k] + gap_ns;
      }
    }
  }
  return lines;
}

Eigen::Vector3d ViewRibbons::centre() const {
  if (rows_seen_ == 0) return Eigen::Vector3d::Zero();
  return 0.5 * (box_min_ + box_max_);
}

}  // namespace overfly::server
