#include "server/calibration/session/session_json.hpp"

#include <algorithm>
#include <cmath>

#include "server/calibration/calibration_record.hpp"

namespace overfly::server {
namespace {

using Json = nlohmann::json;

double rounded(double value_px) { return std::round(value_px * 1000.0) / 1000.0; }

Json corners_json(const std::vector<calibration::BoardCorner>& corners) {
  Json values = Json::array();
  for (const calibration::BoardCorner& corner : corners) {
    values.push_back({rounded(corner.pixel.x()), rounded(corner.pixel.y())});
  }
  return values;
}

Json image_json(const SearchedImage& image) {
  return {{"number", image.number},
          {"name", image.name},
          {"width_px", image.width_px},
          {"height_px", image.height_px},
          {"verdict", image.verdict},
          {"corners", corners_json(image.corners)},
          {"picture", image.jpeg != nullptr}};
}

Json bars_json(const std::vector<calibration::CoverageBar>& bars) {
  Json values = Json::array();
  for (const calibration::CoverageBar& bar : bars) {
    values.push_back(
        {{"name", bar.name}, {"min", bar.min}, {"max", bar.max}, {"progress", bar.progress}});
  }
  return values;
}

Json session_text(const std::string& text) { return text.empty() ? Json(nullptr) : Json(text); }

Json lens_json(const calibration::LensChoice& lens) {
  return {{"model", to_string(lens.model)}, {"k3", lens.k3}};
}

}  // namespace

Json board_json(const calibration::Board& board) {
  Json value = {{"cols", board.cols}, {"rows", board.rows}, {"square_m", board.square_m}};
  if (board.markers) {
    const std::string bits = std::to_string(board.markers->bits);
    value["markers"] = bits + "x" + bits;
    value["marker_m"] = board.markers->side_m;
  }
  return value;
}

Json session_json(const CalibrationSession& session, const SessionState& state) {
  Json views = Json::array();
  for (std::size_t i = 0; i < state.views.size(); ++i) {
    views.push_back(
        {{"view", i}, {"name", state.views[i]->name}, {"left_out", state.left_out.contains(i)}});
  }
  Json without = Json::array();
  for (const LeftOutImage& image : state.left_out_images) {
    without.push_back({{"image", image.name}, {"reason", image.reason}});
  }
  return {{"revision", state.revision},
          {"source", session.source()},
          {"uploads", session.takes_uploads()},
          {"board", board_json(session.options().board)},
          {"phase", to_string(state.phase)},
          {"error", session_text(state.error)},
          {"automatic", state.automatic},
          {"source_open", state.source_open},
          {"images", state.images_done},
          {"images_total", state.images_total ? Json(*state.images_total) : Json(nullptr)},
          {"images_without_view", state.images_without_view},
          {"without_view", std::move(without)},
          {"newest", state.recent.empty() ? Json(nullptr) : image_json(*state.recent.back())},
          {"last_view", state.views.empty() ? Json(nullptr) : image_json(*state.views.back())},
          {"views", std::move(views)},
          {"most_views", kMostSessionViews},
          {"coverage", bars_json(state.coverage)},
          {"lens", lens_json(state.lens)},
          {"solution", state.solution ? Json(state.solution->number) : Json(nullptr)},
          {"solve_error", session_text(state.solve_error)}};
}

Json solution_json(const SessionSolution& solution) {
  Json value = json_from(solution.record);
  value["solution"] = solution.number;
  Json& views = value.at("views");
  for (std::size_t i = 0; i < views.size(); ++i) views[i]["view"] = solution.view_of[i];
  return value;
}

Json view_json(const SessionState& state, std::size_t view, const calibration::Board& board) {
  const SearchedImage& image = *state.views.at(view);
  Json value = image_json(image);
  value["view"] = view;
  value["residuals"] = nullptr;
  if (!state.solution) return value;
  const std::vector<std::size_t>& of = state.solution->view_of;
  const auto found = std::find(of.begin(), of.end(), view);
  if (found == of.end()) return value;
  const calibration::Calibration& result = state.solution->record.result;
  const Pose& T_camera_board =
      result.views[static_cast<std::size_t>(found - of.begin())].T_camera_board;
  Json residuals = Json::array();
  for (const calibration::BoardCorner& corner : image.corners) {
    const Eigen::Vector2d at_m = board.corner_m(corner.id);
    const auto projected =
        result.camera.project(T_camera_board * Eigen::Vector3d(at_m.x(), at_m.y(), 0.0));
    if (!projected) {
      residuals.push_back(nullptr);
      continue;
    }
    const Eigen::Vector2d residual = corner.pixel - *projected;
    residuals.push_back({rounded(residual.x()), rounded(residual.y())});
  }
  value["residuals"] = std::move(residuals);
  return value;
}

}  // namespace overfly::server
