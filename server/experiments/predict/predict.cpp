#include "server/experiments/predict/predict.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "core/cancel.hpp"
#include "core/earth/sun_position.hpp"
#include "server/camera/truth.hpp"
#include "server/camera/watched_tiles.hpp"
#include "server/experiments/predict/flight_risk.hpp"
#include "server/experiments/predict/risk_map.hpp"
#include "server/experiments/predict/walked_flight.hpp"
#include "server/report/figures/ground_picture.hpp"
#include "server/scenario/document/scenario_faults.hpp"
#include "server/worlds/scenario_world.hpp"

namespace overfly::server::predict {
namespace {

/// Shares of the work, about as their times.
constexpr double kFlightBegins = 0.1;
constexpr double kMapBegins = 0.4;
constexpr double kPictureSidePx = 1000.0;
/// Longer than any flight that is predicted.
constexpr double kWholeFlightS = 1e6;

std::optional<double> sun_elevation_deg(const Scenario& scenario, const Geodetic& origin) {
  if (!scenario.light) return std::nullopt;
  const LightSpec& light = *scenario.light;
  return deg_from_rad(light.time_unix_ns
                          ? sun_position(*light.time_unix_ns, origin).apparent_elevation_rad
                          : light.options.sun_elevation_rad);
}

Result<Image> ground_of_map(const RiskMap& map,
                            const terrain::TileSource& tiles,
                            const std::atomic<bool>* cancel) {
  const double width_m = map.cell_m * static_cast<double>(map.columns);
  const double height_m = map.cell_m * static_cast<double>(map.rows);
  const double px_per_m = kPictureSidePx / std::max(width_m, height_m);
  const auto side_px = [&](double length_m) {
    return std::max(1, static_cast<int>(std::lround(length_m * px_per_m)));
  };
  return report::ground_picture(
      tiles,
      {map.west_m, map.west_m + width_m, map.south_m, map.south_m + height_m},
      side_px(width_m),
      side_px(height_m),
      [cancel] { return is_cancelled(cancel); });
}

class Predictor {
 public:
  Predictor(const Scenario& scenario, const PredictOptions& options)
      : scenario_(scenario), options_(options) {}

  Result<Predicted> run() {
    if (scenario_.is_live()) {
      return Error{ErrorCode::kInvalidArgument,
                   "flight = a live vehicle: must be known before it is flown"};
    }
    std::size_t index = 0;
    if (!options_.camera.empty()) {
      const auto found = camera_index(scenario_, options_.camera, "--camera");
      if (!found) return found.error();
      index = *found;
    }
    show(0.0, "opening the world");
    Result<OpenedWorld> opened =
        open_scenario_world(scenario_, [this](double) { return !is_cancelled(options_.cancel); });
    if (!opened) return opened.error();
    threads_.tiles = std::make_shared<const WatchedTiles>(opened->world.tiles, options_.cancel);
    opened->world.tiles = threads_.tiles;
    const terrain::World& world = opened->world;
    const auto truth = create_truth(scenario_, world, options_.cancel);
    if (!truth) return truth.error();
    const auto flight = WalkedFlight::walk(**truth,
                                           1.0 / options_.rate_hz,
                                           scenario_.duration_s.value_or(kWholeFlightS),
                                           options_.cancel);
    if (!flight) return flight.error();
    const FlyingCamera camera{scenario_.cameras[index],
                              index,
                              scenario_.seed,
                              scenario_.rate,
                              sun_elevation_deg(scenario_, world.tiles->frame().origin())};
    Prediction& prediction = predicted_.prediction;
    prediction.scenario = scenario_.name;
    prediction.title = scenario_.title;
    prediction.camera = camera.spec.name;
    prediction.flight = (*truth)->description();
    prediction.duration_s = flight->duration_s();
    prediction.length_m = flight->length_m();
    prediction.step_s = flight->step_s();
    prediction.image_width_px = camera.spec.model.pinhole().width_px;
    prediction.warnings = world.warnings;
    for (const std::string& warning : (*truth)->warnings()) {
      prediction.warnings.push_back(warning);
    }
    threads_.jobs = options_.jobs;
    threads_.cancel = options_.cancel;
    if (Status status = add_flight(camera, *flight); !status) return status.error();
    if (Status status = add_map(camera, *flight); !status) return status.error();
    return std::move(predicted_);
  }

 private:
  void show(double share, const std::string& text) const {
    if (options_.progress) options_.progress(share, text);
  }
  /// Progress of a part of the work.
  void show_part(double from, double to, const std::string& text) {
    threads_.progress = [this, from, to, text](double share) {
      show(from + (to - from) * share, text);
    };
  }

  Status add_flight(const FlyingCamera& camera, const WalkedFlight& flight) {
    show_part(kFlightBegins, options_.map ? kMapBegins : 1.0, "the flight");
    auto instants = flight_risk(camera, flight, threads_);
    if (!instants) return instants.error();
    predicted_.prediction.instants = std::move(*instants);
    if (predicted_.prediction.duration_s <= kLongestJudgedS) {
      predicted_.prediction.risk = predicted_.prediction.instants.back().risk_so_far;
    }
    return {};
  }

  Status add_map(const FlyingCamera& camera, const WalkedFlight& flight) {
    if (!options_.map) return {};
    const auto plan = plan_map(flight, *threads_.tiles, options_.map->side_m, options_.map->cell_m);
    if (!plan) {
      predicted_.prediction.warnings.emplace_back(
          "no map: there is no imagery within " +
          std::to_string(std::lround(0.5e-3 * options_.map->side_m)) + " km of the flight");
      return {};
    }
    show_part(kMapBegins, 1.0, "the map");
    auto map = risk_map(camera, *plan, threads_);
    if (!map) return map.error();
    if (options_.map->picture) {
      auto picture = ground_of_map(*map, *threads_.tiles, options_.cancel);
      if (!picture) return picture.error();
      predicted_.ground = std::move(*picture);
    }
    predicted_.prediction.map = std::move(*map);
    return {};
  }

  const Scenario& scenario_;
  const PredictOptions& options_;
  DrawingThreads threads_;
  Predicted predicted_;
};

}  // namespace

Result<Predicted> predict(const Scenario& scenario, const PredictOptions& options) {
  return Predictor(scenario, options).run();
}

}  // namespace overfly::server::predict
