// Predicts, before any flight, where an estimator is likely to lose track: from imagery, elevation
// and mission.
#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <string>

#include "core/camera/image.hpp"
#include "core/result.hpp"
#include "server/experiments/predict/prediction.hpp"
#include "server/scenario/scenario.hpp"

namespace overfly::server::predict {

struct PredictOptions {
  std::string camera;    ///< by name; empty = the first
  double rate_hz = 2.0;  ///< instants per second of the flight, in [0.1, 10]
  struct Map {
    double side_m = 10'000.0;
    double cell_m = 100.0;
    bool picture = false;  ///< also of the ground
  };
  std::optional<Map> map = Map{};
  unsigned jobs = 1;  ///< threads
  const std::atomic<bool>* cancel = nullptr;
  /// Called with the share done and what is being done, by one thread at a time; may be empty.
  std::function<void(double, const std::string&)> progress;
};

struct Predicted {
  Prediction prediction;
  Image ground;  ///< RGB, of the map; empty unless asked for
};

/// Flies nothing and starts no estimator.
/// Errors: kInvalidArgument for a live flight and an unknown camera; kCancelled; as the world's,
/// the flight's, flight_risk and risk_map.
[[nodiscard]] Result<Predicted> predict(const Scenario& scenario, const PredictOptions& options);

}  // namespace overfly::server::predict
