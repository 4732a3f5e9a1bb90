#include "server/experiments/predict/prediction_words.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>

#include "core/text/percent.hpp"
#include "server/experiments/predict/risk_model.hpp"

namespace overfly::server::predict {
namespace {

/// Contributions below this do not count as a reason [log odds].
constexpr double kLeastReason = 0.2;
constexpr std::size_t kMostStretches = 5;

std::string short_number(double value) {
  constexpr double kRoundsTo100 = 99.5;  // printed as 1e+02 with two digits
  char text[40];
  std::snprintf(text, sizeof text, "%.2g", value);
  return value >= kRoundsTo100 ? std::to_string(static_cast<long>(value + 0.5)) : text;
}

std::string seconds(double t_s) {
  char text[40];
  std::snprintf(text, sizeof text, "%.1f s", t_s);
  return text;
}

/// What is wrong if the i-th input is worse than usual. Motion, overlap and blur are those of the
/// window's worst instant (the inverse of inputs_of).
std::string reason(std::size_t input, const Features& features, const Inputs& window) {
  const auto motion_px = [&](double value) { return value * features.image_width_px; };
  switch (input) {
    case 0:
      return "coarse imagery (" + short_number(features.texels_per_pixel) + " texels per pixel)";
    case 1:
      return "few corners after blur (" + short_number(features.corners_per_kpx) + " per 1000 px)";
    case 2:
      return "ground without texture (" + percent_text(features.bare_share) + " of the image)";
    case 3:
      return "places that look alike (correlation " + short_number(features.self_similarity) + ")";
    case 4:
      return "relief (" + short_number(features.relief) + " of the height)";
    case 5:
      return "fast rotation (" + short_number(motion_px(window[5])) + " px between frames)";
    case 6:
      return "fast motion over the ground (" + short_number(motion_px(window[6])) +
             " px between frames)";
    case 7:
      return "little overlap (" + percent_text(1.0 - std::sqrt(window[7])) + " after 1 s)";
    case 8:
      return "motion blur (" + short_number(std::expm1(window[8])) + " px)";
    case 9:
      return "noise (" + short_number(features.noise_grey) + " grey levels)";
    case 10:
      return "ground without imagery (" + percent_text(features.void_share) + " of the image)";
    default:
      return "a low sun (" + short_number(features.sun_elevation_deg.value_or(90.0)) + " deg)";
  }
}

/// Whether an input is worse than the mean of the fitted windows: less of texels and corners, more
/// of everything else.
bool is_worse(std::size_t input, const Inputs& window) {
  const double above = window[input] - fitted_model().mean[input];
  return input <= 1 ? above < 0.0 : above > 0.0;
}

std::string enumerated(const std::vector<std::string>& parts) {
  std::string text;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (i > 0) text += i + 1 == parts.size() ? " and " : ", ";
    text += parts[i];
  }
  return text;
}

std::string because(const std::vector<std::string>& reasons) {
  return reasons.empty() ? std::string() : ", because of " + enumerated(reasons);
}

std::string map_sentence(const RiskMap& map) {
  const auto cells = std::count_if(
      map.risk.begin(), map.risk.end(), [](const auto& risk) { return risk.has_value(); });
  if (cells == 0) return "The map has no cell with imagery.";
  return "Straight and level at " + short_number(map.height_agl_m) + " m over the ground and " +
         short_number(map.speed_m_s) + " m/s, " + percent_text(risky_share(map)) +
         " of the area (" + short_number(1e-3 * map.cell_m * static_cast<double>(map.columns)) +
         " x " + short_number(1e-3 * map.cell_m * static_cast<double>(map.rows)) +
         " km) has a risk of at least 50 % within 10 s.";
}

std::string flight_sentence(const Prediction& prediction) {
  const std::string flight = "this flight of " + seconds(prediction.duration_s);
  if (prediction.risk) {
    return "The estimator is lost in " + flight + " with a probability of " +
           percent_text(*prediction.risk) + ".";
  }
  return "Parts of " + flight + " are ranked by their risk of a loss within " +
         seconds(kRiskSpanS) + "; a probability for the whole flight is known up to " +
         seconds(kLongestJudgedS) + " only.";
}

}  // namespace

std::vector<RiskyStretch> risky_stretches(const Prediction& prediction) {
  constexpr double kJoinS = 1.0;
  std::vector<RiskyStretch> stretches;
  const std::vector<PredictedInstant>& instants = prediction.instants;
  for (std::size_t k = 0; k < instants.size(); ++k) {
    if (instants[k].risk < kRisky) continue;
    if (stretches.empty() ||
        instants[k].t_s - instants[stretches.back().last].t_s > kJoinS + prediction.step_s) {
      stretches.push_back({k, k, k});
      continue;
    }
    RiskyStretch& stretch = stretches.back();
    stretch.last = k;
    if (instants[k].risk > instants[stretch.worst].risk) stretch.worst = k;
  }
  return stretches;
}

std::vector<std::string> reasons_of(const PredictedInstant& instant, std::size_t most) {
  std::vector<std::size_t> order(kInputs);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return instant.contributions[a] > instant.contributions[b];
  });
  std::vector<std::string> reasons;
  for (const std::size_t input : order) {
    if (reasons.size() == most || instant.contributions[input] < kLeastReason) break;
    if (is_worse(input, instant.window))
      reasons.push_back(reason(input, instant.features, instant.window));
  }
  return reasons;
}

std::string words_of(const Prediction& prediction, const RiskyStretch& stretch) {
  const PredictedInstant& worst = prediction.instants[stretch.worst];
  const double from_s = prediction.instants[stretch.first].t_s;
  const double to_s = prediction.instants[stretch.last].t_s;
  const std::string when =
      from_s == to_s ? seconds(from_s) : seconds(from_s) + " to " + seconds(to_s);
  return when + ": up to " + percent_text(worst.risk) + " within 10 s" + because(reasons_of(worst));
}

double risky_share(const RiskMap& map) {
  std::size_t cells = 0;
  std::size_t risky = 0;
  for (const auto& risk : map.risk) {
    cells += risk ? 1 : 0;
    risky += risk && *risk >= kRisky ? 1 : 0;
  }
  return cells == 0 ? 0.0 : static_cast<double>(risky) / static_cast<double>(cells);
}

std::vector<std::string> sentences_of(const Prediction& prediction) {
  std::vector<std::string> sentences;
  if (prediction.instants.empty()) return sentences;
  sentences.push_back(flight_sentence(prediction));
  std::vector<RiskyStretch> stretches = risky_stretches(prediction);
  const std::vector<PredictedInstant>& instants = prediction.instants;
  if (stretches.empty()) {
    const auto worst = static_cast<std::size_t>(
        std::max_element(instants.begin(),
                         instants.end(),
                         [](const auto& a, const auto& b) { return a.risk < b.risk; }) -
        instants.begin());
    sentences.push_back("No part of it is risky; the highest risk is at " +
                        words_of(prediction, {worst, worst, worst}) + ".");
  } else {
    const std::size_t all = stretches.size();
    std::sort(stretches.begin(), stretches.end(), [&](const auto& a, const auto& b) {
      return instants[a.worst].risk > instants[b.worst].risk;
    });
    stretches.resize(std::min(stretches.size(), kMostStretches));
    for (const RiskyStretch& stretch : stretches) {
      sentences.push_back("Risky at " + words_of(prediction, stretch) + ".");
    }
    if (all > kMostStretches) {
      sentences.push_back(std::to_string(all - kMostStretches) + " other parts are risky.");
    }
  }
  if (prediction.map) sentences.push_back(map_sentence(*prediction.map));
  return sentences;
}

}  // namespace overfly::server::predict
