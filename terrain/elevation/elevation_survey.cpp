// ElevationModel: evaluates the survey of all posts and words its warnings.
#include <algorithm>
#include <cstdio>

#include "core/text/percent.hpp"
#include "terrain/elevation/elevation_model.hpp"
#include "terrain/elevation/steep_steps.hpp"

namespace overfly::terrain {
namespace {

/// With more posts than this, reading each once when a world is opened causes a warning.
constexpr double kManyPosts = 40e6;

std::string count_text(double count) { return std::to_string(static_cast<long long>(count)); }

/// The undeclared no-data values of one layer and the number of posts with each.
std::string undeclared_text(const UndeclaredVoids& voids) {
  std::string values;
  for (const float value : voids.values) {
    char text[24];
    std::snprintf(text, sizeof(text), "%s%.0f", values.empty() ? "" : ", ", value);
    values += text;
  }
  return count_text(voids.posts) + " of " + count_text(voids.of_posts) + " posts (" +
         percent_text(voids.posts / voids.of_posts) + ") have a usual value of missing data (" +
         values +
         ") that is not declared, unlike the ground around: they are treated as missing; set "
         "\"nodata\" in the manifest to override this";
}

std::string steep_text(const HeightSurvey& survey, double step_m) {
  char text[240];
  std::snprintf(
      text,
      sizeof(text),
      "%.0f neighbouring posts differ by more than %.0f m, up to %.0f m, unlike any ground; "
      "is there an undeclared value of missing data? Set \"nodata\" in the manifest",
      survey.steep,
      step_m,
      survey.steepest_m);
  return text;
}

}  // namespace

Status ElevationModel::survey_posts(const std::function<bool()>& cancelled,
                                    std::vector<std::string>& warnings) {
  for (const auto& raster : parts_->rasters) {
    Status whole = raster->check(cancelled, warnings);
    if (!whole) return whole;
  }
  const double steep_m = impossible_step_m(spacing_m_);
  auto survey = parts_->pyramid->survey(cancelled, steep_m);
  if (!survey) return survey.error();
  bool found = false;
  for (const auto& raster : parts_->rasters) {
    const auto voids = raster->find_undeclared_voids(cancelled);
    if (!voids) return voids.error();
    found = found || *voids;
  }
  if (found) {
    survey = parts_->pyramid->survey(cancelled, steep_m);
    if (!survey) return survey.error();
  }
  for (const auto& raster : parts_->rasters) {
    const VoidRuns& voids = raster->undeclared_voids();
    survey->implausible_layers.push_back(raster->implausible_seen());
    survey->undeclared.push_back({voids.posts,
                                  static_cast<double>(raster->columns()) * raster->rows(),
                                  {voids.values.begin(), voids.values.end()}});
  }
  double read = survey->posts;
  for (const auto& raster : parts_->rasters) read = std::max(read, raster->pixels_read());
  if (read > kManyPosts) {
    warnings.push_back(
        what_ + ": " + count_text(read) +
        " posts are read whenever this world is opened; `overfly world build` avoids "
        "that");
  }
  return take(*survey, warnings);
}

Status ElevationModel::take(const HeightSurvey& survey, std::vector<std::string>& warnings) {
  survey_ = survey;
  if (survey.implausible > 0) {
    warnings.push_back(what_ + ": " + count_text(survey.implausible) +
                       " heights outside -12000 to 9000 m are treated as missing");
  }
  const std::size_t layers = std::min(parts_->rasters.size(), survey.implausible_layers.size());
  for (std::size_t i = 0; survey.implausible == 0 && i < layers; ++i) {
    if (!survey.implausible_layers[i]) continue;
    warnings.push_back(parts_->rasters[i]->file() +
                       ": heights outside -12000 to 9000 m are treated as missing");
  }
  std::string undeclared;
  for (std::size_t i = 0; i < std::min(parts_->rasters.size(), survey.undeclared.size()); ++i) {
    if (survey.undeclared[i].posts == 0.0) continue;
    undeclared = ": " + undeclared_text(survey.undeclared[i]);
    warnings.push_back(parts_->rasters[i]->file() + undeclared);
  }
  if (survey.steep > 0) {
    warnings.push_back(what_ + ": " + steep_text(survey, impossible_step_m(spacing_m_)));
  }
  if (survey.voids >= survey.posts) {
    std::string why = ": has no heights near the imagery";
    if (survey.implausible > 0) {
      why +=
          ", only values outside -12000 to 9000 m; if their unit is not the metre, set "
          "\"unit_m\" in the manifest";
    } else {
      why += undeclared;
    }
    return Error{ErrorCode::kInvalidArgument, what_ + why};
  }
  if (survey.voids > 0) {
    warnings.push_back(what_ + ": " + count_text(survey.voids) + " of " + count_text(survey.posts) +
                       " posts (" + percent_text(survey.voids / survey.posts) +
                       ") have no data and are filled from those around them");
  }
  range_m_ = {survey.lowest_m, survey.highest_m};
  return {};
}

}  // namespace overfly::terrain
