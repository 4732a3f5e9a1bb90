// ElevationModel: the coarser grid beyond the fine one.
#include <algorithm>
#include <cmath>

#include "terrain/elevation/elevation_model.hpp"

namespace overfly::terrain {

Status ElevationModel::extend(const std::vector<ElevationLayer>& layers,
                              const MapPlane& plane,
                              const MapRect& imagery,
                              const MapRect& area,
                              double max_posts) {
  constexpr double kCoarsestM = 1e5;
  Status laid;
  for (double spacing_m = 2.0 * spacing_m_; spacing_m < kCoarsestM; spacing_m *= 2.0) {
    std::vector<int> steps;
    for (const auto& raster : parts_->rasters) {
      // Rounding must not make a mesh finer than wanted.
      constexpr double kRounding = 1.0 + 1e-6;
      steps.push_back(std::max(1, static_cast<int>(kRounding * spacing_m / raster->spacing_m())));
    }
    auto far = std::make_shared<ElevationModel>();
    std::vector<std::string> known;  // the fine grid has given the same warnings
    Status opened = far->open_layers(layers, plane, area, steps, known);
    if (!opened) return opened;
    laid = far->lay_grid(area, spacing_m, max_posts, known);
    if (!laid && laid.error().code == ErrorCode::kUnsupported) continue;
    if (!laid) return laid;
    far->what_ += " far from the imagery";
    far_ = std::move(far);
    far_has_data_ = true;
    near_reach_m_ = imagery.x_min - area_.x_min;
    return {};
  }
  return laid;
}

/// The weight of the fine grid: 1 over the imagery and half of the margin around it, 0 outside of
/// the fine grid, linear in between.
double ElevationModel::near_share(double x_map_m, double y_map_m) const {
  if (!far_has_data_) return 1.0;
  const double inside_m = std::min(
      {x_map_m - area_.x_min, area_.x_max - x_map_m, y_map_m - area_.y_min, area_.y_max - y_map_m});
  return std::clamp(inside_m / (0.5 * near_reach_m_), 0.0, 1.0);
}

/// Takes over what is known of the coarser grid after it was surveyed or given a store.
Status ElevationModel::take_far(const Status& known,
                                const std::vector<std::string>& doubts,
                                std::vector<std::string>& warnings) {
  if (!known) {
    // Not used if none of its posts has data: there are voids around the fine grid.
    far_has_data_ = false;
    return known.error().code == ErrorCode::kInvalidArgument ? Status{} : known;
  }
  for (const std::string& doubt : doubts) {
    if (std::find(warnings.begin(), warnings.end(), doubt) == warnings.end()) {
      warnings.push_back(doubt);
    }
  }
  range_m_ = {std::min(range_m_.x(), far_->range_m_.x()),
              std::max(range_m_.y(), far_->range_m_.y())};
  return {};
}

Status ElevationModel::survey(const std::function<bool()>& cancelled,
                              std::vector<std::string>& warnings) {
  Status near = survey_posts(cancelled, warnings);
  if (!near || !far_) return near;
  std::vector<std::string> doubts;
  return take_far(far_->survey_posts(cancelled, doubts), doubts, warnings);
}

Status ElevationModel::use(std::shared_ptr<const HeightStore> store,
                           std::vector<std::string>& warnings) {
  Status near = use(store, HeightReach::kNear, warnings);
  if (!near || !far_) return near;
  if (store->survey(HeightReach::kFar) == nullptr) {
    far_has_data_ = false;
    return {};
  }
  std::vector<std::string> doubts;
  return take_far(far_->use(std::move(store), HeightReach::kFar, doubts), doubts, warnings);
}

}  // namespace overfly::terrain
