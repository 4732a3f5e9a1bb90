#include <cmath>
#include <memory>
#include <string>
#include <utility>

#include "core/cancel.hpp"
#include "server/maps/world_list.hpp"
#include "server/missions/mission_plan.hpp"
#include "server/missions/mission_report.hpp"
#include "server/missions/mission_report_json.hpp"
#include "server/net/http/error_response.hpp"
#include "server/net/http/json_text.hpp"
#include "server/net/rest/rest_api.hpp"

namespace overfly::net {
namespace {

using nlohmann::json;
using server::MissionLimits;
using server::MissionRequest;

struct ReportBody {
  json document;
  MissionRequest request;
};

Status read_limits(const json& object, MissionLimits& limits) {
  JsonFields fields(object, "limits");
  const auto read = [&](const char* name, double& value, double low, double high) {
    if (const auto number = fields.number(name, low, high)) value = *number;
  };
  read("min_clearance_m", limits.min_clearance_m, 0.0, 10000.0);
  read("max_bank_deg", limits.max_bank_deg, 1.0, 90.0);
  read("min_overlap", limits.min_overlap, 0.0, 1.0);
  read("min_texels_px", limits.min_texels_px, 0.0, 1000.0);
  read("max_motion_px", limits.max_motion_px, 0.0, 1e6);
  read("min_imagery", limits.min_imagery, 0.0, 1.0);
  read("min_start_s", limits.min_start_s, 0.0, 3600.0);
  read("min_start_baseline", limits.min_start_baseline, 0.0, 1000.0);
  return fields.finish();
}

Result<ReportBody> report_body_from(const std::string& text) {
  const Result<json> body = parse_object(text, "the body");
  if (!body) return body.error();
  JsonFields fields(*body, "");
  ReportBody read;
  fields.require("document");
  if (const json* document = fields.object("document")) read.document = *document;
  read.request.camera = fields.text("camera").value_or("");
  read.request.overlap_interval_s = fields.number("overlap_interval_s", 0.001, 600.0).value_or(1.0);
  read.request.samples =
      static_cast<std::size_t>(fields
                                   .integer("samples",
                                            static_cast<std::int64_t>(server::kMinMissionSamples),
                                            static_cast<std::int64_t>(server::kMaxMissionSamples))
                                   .value_or(static_cast<std::int64_t>(read.request.samples)));
  const json* const limits = fields.object("limits");
  if (const Status status = fields.finish(); !status) return status.error();
  if (limits != nullptr) {
    if (const Status status = read_limits(*limits, read.request.limits); !status) {
      return status.error();
    }
  }
  return read;
}

Result<json> report(const MissionRoutes& routes,
                    const ReportBody& body,
                    const std::atomic<bool>* cancel) {
  const auto scenario = routes.runs->library().read(body.document);
  if (!scenario) return scenario.error();
  const auto over = server::world_of(*routes.runs, *scenario);
  if (!over) return over.error();
  const auto world = routes.maps->open(*over, [cancel] { return is_cancelled(cancel); });
  if (!world) return world.error();
  const auto report = server::report_mission(*scenario, (*world)->world(), body.request, cancel);
  if (!report) return report.error();
  return server::json_from(*report);
}

}  // namespace

void add_mission_routes(RestRouter* router, const MissionRoutes& routes) {
  router->add("GET",
              "/api/v1/scenarios/{name}/plan",
              [routes](const RouteCall& call, const Respond& respond) {
                read_and_answer(routes.readers,
                                "a mission",
                                call,
                                respond,
                                [runs = routes.runs, name = call.path.at("name")](
                                    const std::atomic<bool>*) -> Result<json> {
                                  const auto scenario = runs->library().load(name);
                                  if (!scenario) return scenario.error();
                                  return server::mission_plan(*scenario);
                                });
              });
  router->add_calculation(
      "/api/v1/missions/report", [routes](const RouteCall& call, const Respond& respond) {
        if (auto refused = not_json(call.request)) {
          respond(std::move(*refused));
          return;
        }
        auto body = report_body_from(call.request.body);
        if (!body) {
          respond(error_response(body.error()));
          return;
        }
        read_and_answer(
            routes.readers,
            "a mission",
            call,
            respond,
            [routes, wanted = std::move(*body)](const std::atomic<bool>* cancel) -> Result<json> {
              return report(routes, wanted, cancel);
            });
      });
}

}  // namespace overfly::net
