#include <array>
#include <charconv>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "core/time.hpp"
#include "server/net/http/error_response.hpp"
#include "server/net/rest/rest_api.hpp"
#include "server/record/rows/sensor_series.hpp"
#include "server/record/run_manifest.hpp"
#include "server/timeline/gps_errors.hpp"

namespace overfly::net {
namespace {

using nlohmann::json;
using server::RunManager;

constexpr std::size_t kUsualPoints = 1000;
constexpr std::size_t kMinPoints = 100;
constexpr std::size_t kMaxPoints = 10'000;

/// With 9 significant digits: a longitude within 0.1 m.
double shortened(double value) {
  std::array<char, 32> text{};
  const auto [end, error] =
      std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::general, 9);
  double short_value = value;
  if (error == std::errc()) (void)std::from_chars(text.data(), end, short_value);
  return short_value;
}

json curve_json(const server::SensorCurve& curve) {
  json times = json::array();
  json values = json::array();
  for (const SeriesPoint& point : curve.points) {
    times.push_back(s_from_ns(point.t_ns));
    values.push_back(shortened(point.values[0]));
  }
  return {{"name", curve.name}, {"t_s", std::move(times)}, {"values", std::move(values)}};
}

Result<json> sensors_json(RunManager* runs,
                          const std::string& id,
                          server::SensorSeriesRequest request,
                          server::SensorIndexShelf& indexes,
                          const std::atomic<bool>* cancel) {
  const auto timeline = runs->timeline(id);
  if (!timeline) return timeline.error();
  const auto folder = runs->folder(id);
  if (!folder) return folder.error();
  const auto manifest = server::read_run_manifest(*folder);
  if (manifest && manifest->values.world && manifest->values.world->origin) {
    const auto errors =
        std::make_shared<server::GpsErrors>(**timeline, *manifest->values.world->origin);
    request.gps_error = [errors](const GpsSample& fix) { return errors->of(fix); };
  }
  const auto index = indexes.of(*folder);
  const auto series = server::read_sensor_series(*folder, request, *index, cancel);
  if (!series) return series.error();
  json list = json::array();
  for (const server::SensorCurves& sensor : series->sensors) {
    json curves = json::array();
    for (const server::SensorCurve& curve : sensor.curves) curves.push_back(curve_json(curve));
    list.push_back(
        {{"sensor", sensor.sensor}, {"samples", sensor.samples}, {"curves", std::move(curves)}});
  }
  return json{{"sensors", std::move(list)}};
}

Result<server::SensorSeriesRequest> request_of(const RouteCall& call) {
  server::SensorSeriesRequest request;
  const Result<TimeQuery> times = time_query_of(call);
  if (!times) return times.error();
  request.from_ns = times->from_ns.value_or(request.from_ns);
  request.to_ns = times->to_ns.value_or(request.to_ns);
  const Result<std::size_t> points = points_query_of(call, kUsualPoints, kMinPoints, kMaxPoints);
  if (!points) return points.error();
  // An interval keeps two points, and the first and the last are kept as well.
  request.max_intervals = (*points - 2) / 2;
  return request;
}

}  // namespace

void add_sensor_routes(RestRouter* router, RunManager* runs, const ReadingRoutes& readers) {
  const auto indexes = std::make_shared<server::SensorIndexShelf>();
  router->add("GET",
              "/api/v1/runs/{id}/sensors",
              [runs, readers, indexes](const RouteCall& call, const Respond& respond) {
                const auto request = request_of(call);
                if (!request) {
                  respond(error_response(request.error()));
                  return;
                }
                read_and_answer(readers,
                                "a run's sensors",
                                call,
                                respond,
                                [runs, indexes, id = call.path.at("id"), request = *request](
                                    const std::atomic<bool>* cancel) {
                                  return sensors_json(runs, id, request, *indexes, cancel);
                                });
              },
              {"from_s", "to_s", "points"});
}

}  // namespace overfly::net
