#include "server/experiments/predict/prediction_json.hpp"

#include "server/experiments/predict/prediction_words.hpp"

namespace overfly::server::predict {
namespace {

using Json = nlohmann::json;

Json json_of(const Features& features) {
  return {{"texels_per_pixel", features.texels_per_pixel},
          {"corners_per_kpx", features.corners_per_kpx},
          {"bare_share", features.bare_share},
          {"self_similarity", features.self_similarity},
          {"relief_over_height", features.relief},
          {"rotation_px", features.rotation_px},
          {"translation_px", features.translation_px},
          {"overlap", features.overlap},
          {"blur_px", features.blur_px},
          {"noise_grey", features.noise_grey},
          {"void_share", features.void_share},
          {"sun_elevation_deg",
           features.sun_elevation_deg ? Json(*features.sun_elevation_deg) : Json(nullptr)}};
}

Json json_of(const Inputs& inputs) {
  Json values = Json::object();
  for (std::size_t i = 0; i < kInputs; ++i) values[kInputNames[i]] = inputs[i];
  return values;
}

Json json_of(const PredictedInstant& instant) {
  return {{"t_s", instant.t_s},
          {"east_m", instant.east_m},
          {"north_m", instant.north_m},
          {"height_agl_m", instant.height_agl_m},
          {"features", json_of(instant.features)},
          {"inputs", json_of(instant.window)},
          {"contributions", json_of(instant.contributions)},
          {"risk_10_s", instant.risk}};
}

Json json_of(const RiskMap& map) {
  Json risk = Json::array();
  for (const auto& value : map.risk) risk.push_back(value ? Json(*value) : Json(nullptr));
  const auto column_of = [&](double Features::*field) {
    Json values = Json::array();
    for (std::size_t i = 0; i < map.features.size(); ++i) {
      values.push_back(map.risk[i] ? Json(map.features[i].*field) : Json(nullptr));
    }
    return values;
  };
  return {{"west_m", map.west_m},
          {"south_m", map.south_m},
          {"cell_m", map.cell_m},
          {"columns", map.columns},
          {"rows", map.rows},
          {"height_agl_m", map.height_agl_m},
          {"speed_m_s", map.speed_m_s},
          {"heading_deg", map.heading_deg},
          {"risk_10_s", risk},
          {"texels_per_pixel", column_of(&Features::texels_per_pixel)},
          {"corners_per_kpx", column_of(&Features::corners_per_kpx)},
          {"self_similarity", column_of(&Features::self_similarity)},
          {"relief_over_height", column_of(&Features::relief)}};
}

Json json_of(const Prediction& prediction, const RiskyStretch& stretch) {
  const PredictedInstant& worst = prediction.instants[stretch.worst];
  return {{"from_s", prediction.instants[stretch.first].t_s},
          {"to_s", prediction.instants[stretch.last].t_s},
          {"worst_s", worst.t_s},
          {"risk_10_s", worst.risk},
          {"reasons", reasons_of(worst)}};
}

}  // namespace

Json json_from(const Prediction& prediction) {
  Json instants = Json::array();
  for (const PredictedInstant& instant : prediction.instants) {
    instants.push_back(json_of(instant));
    if (prediction.risk) instants.back()["risk_so_far"] = instant.risk_so_far;
  }
  Json stretches = Json::array();
  for (const RiskyStretch& stretch : risky_stretches(prediction)) {
    stretches.push_back(json_of(prediction, stretch));
  }
  return {{"scenario", prediction.scenario},
          {"title", prediction.title},
          {"camera", prediction.camera},
          {"flight", prediction.flight},
          {"duration_s", prediction.duration_s},
          {"length_m", prediction.length_m},
          {"step_s", prediction.step_s},
          {"risk", prediction.risk ? Json(*prediction.risk) : Json(nullptr)},
          {"sentences", sentences_of(prediction)},
          {"stretches", stretches},
          {"instants", instants},
          {"map", prediction.map ? json_of(*prediction.map) : Json(nullptr)},
          {"warnings", prediction.warnings}};
}

}  // namespace overfly::server::predict
