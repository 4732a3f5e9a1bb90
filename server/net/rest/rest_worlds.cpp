#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/cancel.hpp"
#include "core/motion/pose.hpp"
#include "server/net/http/error_response.hpp"
#include "server/net/http/json_text.hpp"
#include "server/net/http/rest_slots.hpp"
#include "server/net/rest/rest_api.hpp"

namespace overfly::net {
namespace {

using nlohmann::json;
using server::MapService;
using server::MapTileId;

/// Browsers may keep a tile of a world's version.
constexpr const char* kKeepForADay = "private, max-age=86400, immutable";

MapService::Cancelled cancelled_by(const std::atomic<bool>* cancel) {
  return [cancel] { return is_cancelled(cancel); };
}

Result<MapTileId> tile_id_of(const RouteCall& call) {
  MapTileId id;
  for (const auto& [name, value] : {std::pair{"z", &id.zoom}, {"x", &id.x}, {"y", &id.y}}) {
    const std::string& text = call.path.at(name);
    const auto number = number_from<int>(text);
    if (!number) {
      return Error{
          ErrorCode::kInvalidArgument,
          std::string("tile.") + name + " = " + text.substr(0, 20) + ": must be a whole number"};
    }
    *value = *number;
  }
  return id;
}

HttpResponse tile_response(server::MapTile tile, const std::string& wanted_version) {
  HttpResponse response;
  response.content_type = tile.content_type;
  response.headers.emplace_back("Cache-Control",
                                tile.version == wanted_version ? kKeepForADay : "no-cache");
  response.body = std::move(tile.bytes);
  return response;
}

void answer_tile(const WorldRoutes& routes, const RouteCall& call, const Respond& respond) {
  const Result<MapTileId> id = tile_id_of(call);
  if (!id) {
    respond(error_response(id.error()));
    return;
  }
  respond_from_reader(routes.readers,
                      "a map",
                      call,
                      respond,
                      [maps = routes.maps,
                       name = call.path.at("name"),
                       version = call.query_or("version", "none"),
                       id = *id](const std::atomic<bool>* cancel) -> Result<HttpResponse> {
                        Result<server::MapTile> tile = maps->tile(name, id, cancelled_by(cancel));
                        if (!tile) return tile.error();
                        return tile_response(std::move(*tile), version);
                      });
}

/// The field `points`: arrays of latitude and longitude [deg].
Result<std::vector<Geodetic>> points_from(const std::string& body) {
  const Result<json> object = parse_object(body, "heights");
  if (!object) return object.error();
  JsonFields fields(*object, "");
  fields.require("points");
  std::vector<Geodetic> points;
  const json* const array = fields.array("points");
  const std::string limit = ": must be 1 to " + std::to_string(server::kMaxHeightPoints) +
                            " arrays of latitude and longitude in degrees";
  if (array != nullptr && (array->empty() || array->size() > server::kMaxHeightPoints)) {
    fields.reject("points", limit);
  } else if (array != nullptr) {
    points.reserve(array->size());
    for (const json& entry : *array) {
      const bool pair = entry.is_array() && entry.size() == 2 && entry[0].is_number() &&
                        entry[1].is_number() && std::abs(entry[0].get<double>()) <= 90.0 &&
                        std::abs(entry[1].get<double>()) <= 180.0;
      if (!pair) {
        fields.reject("points", limit);
        break;
      }
      points.push_back(geodetic_from_deg(entry[0].get<double>(), entry[1].get<double>(), 0.0));
    }
  }
  if (const Status status = fields.finish(); !status) return status.error();
  return points;
}

json heights_json(const std::vector<server::GroundHeight>& heights) {
  json alt = json::array();
  json imagery = json::array();
  for (const server::GroundHeight& height : heights) {
    alt.push_back(std::round(height.alt_ellipsoid_m * 1e3) / 1e3);
    imagery.push_back(height.imagery);
  }
  return {{"alt_ellipsoid_m", std::move(alt)}, {"imagery", std::move(imagery)}};
}

void answer_heights(const WorldRoutes& routes, const RouteCall& call, const Respond& respond) {
  auto points = points_from(call.request.body);
  if (!points) {
    respond(error_response(points.error()));
    return;
  }
  read_and_answer(routes.readers,
                  "heights",
                  call,
                  respond,
                  [maps = routes.maps, name = call.path.at("name"), points = std::move(*points)](
                      const std::atomic<bool>* cancel) -> Result<json> {
                    const auto heights = maps->heights(name, points, cancelled_by(cancel));
                    if (!heights) return heights.error();
                    return heights_json(*heights);
                  });
}

/// Makes a built-in world. It goes on if the client leaves, or waits no longer.
/// @param taken  the place of this request, held until the world is made
void answer_make(const WorldRoutes& routes,
                 const RouteCall& call,
                 const Respond& respond,
                 const std::shared_ptr<Slot>& taken) {
  std::shared_ptr<ProgressBoard::Entry> entry;
  if (const std::string id = call.query_or("progress", ""); !id.empty()) {
    if (!is_progress_id(id)) {
      taken->release();
      respond(error_response(
          bad_query("progress", id, "8 to 64 letters, digits and '-', of the client's choice")));
      return;
    }
    entry = ProgressBoard::begin(routes.progress, id);
  }
  HttpRequest stays = call.request;
  stays.abandoned = std::make_shared<std::atomic<bool>>(false);
  read_and_answer(routes.readers,
                  "a world",
                  RouteCall{stays, call.path, call.query},
                  respond,
                  [maps = routes.maps, name = call.path.at("name"), entry, taken](
                      const std::atomic<bool>* cancel) -> Result<json> {
                    Result<json> made =
                        maps->describe(name, cancelled_by(cancel), [&](double share) {
                          if (entry) entry->set("making", share);
                        });
                    if (entry) entry->end();
                    taken->release();
                    return made;
                  });
}

}  // namespace

void add_world_routes(RestRouter* router, const WorldRoutes& routes) {
  router->add("GET", "/api/v1/worlds", [routes](const RouteCall& call, const Respond& respond) {
    read_and_answer(
        routes.readers,
        "the worlds",
        call,
        respond,
        [maps = routes.maps](const std::atomic<bool>*) -> Result<json> { return maps->list(); });
  });
  router->add(
      "GET", "/api/v1/worlds/{name}", [routes](const RouteCall& call, const Respond& respond) {
        read_and_answer(
            routes.readers,
            "a world",
            call,
            respond,
            [maps = routes.maps, name = call.path.at("name")](const std::atomic<bool>* cancel) {
              return maps->describe(name, cancelled_by(cancel));
            });
      });
  // A second one would hold the other reading thread, also while it waits for the same world.
  const auto making = std::make_shared<std::atomic<int>>(0);
  router->add("POST",
              "/api/v1/worlds/{name}/make",
              [routes, making](const RouteCall& call, const Respond& respond) {
                auto taken = take_slot(making, 1);
                if (!taken) {
                  return respond(error_response(
                      503, "too_many_makes", "another world is being made: try again soon"));
                }
                answer_make(routes, call, respond, taken);
              },
              {"progress"});
  router->add("GET",
              "/api/v1/worlds/{name}/tiles/{z}/{x}/{y}",
              [routes](const RouteCall& call, const Respond& respond) {
                answer_tile(routes, call, respond);
              },
              {"version"});
  router->add_calculation("/api/v1/worlds/{name}/heights",
                          [routes](const RouteCall& call, const Respond& respond) {
                            answer_heights(routes, call, respond);
                          });
}

}  // namespace overfly::net
