// A prediction in sentences.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "server/experiments/predict/prediction.hpp"

namespace overfly::server::predict {

/// An instant or cell with at least this risk is called risky.
inline constexpr double kRisky = 0.5;

/// A part of the flight in which each instant is risky.
struct RiskyStretch {
  std::size_t first = 0;  ///< instants
  std::size_t last = 0;
  std::size_t worst = 0;
};

/// In the order of time; stretches less than 1 s apart are one.
[[nodiscard]] std::vector<RiskyStretch> risky_stretches(const Prediction& prediction);

/// What raises the risk of an instant most, at most `most` reasons: "motion blur (7.2 px)".
[[nodiscard]] std::vector<std::string> reasons_of(const PredictedInstant& instant,
                                                  std::size_t most = 3);

/// "12.5 s to 14 s: up to 83 % within 10 s, because of motion blur (7.2 px)"
[[nodiscard]] std::string words_of(const Prediction& prediction, const RiskyStretch& stretch);

/// Share of the map's cells with imagery that are risky; 0 without cells.
[[nodiscard]] double risky_share(const RiskMap& map);

/// The whole answer.
[[nodiscard]] std::vector<std::string> sentences_of(const Prediction& prediction);

}  // namespace overfly::server::predict
