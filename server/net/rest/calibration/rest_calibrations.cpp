#include <utility>

#include "server/net/http/error_response.hpp"
#include "server/net/http/json_text.hpp"
#include "server/net/rest/rest_api.hpp"

namespace overfly::net {
namespace {

using nlohmann::json;
using server::CalibrationDesk;

constexpr const char* kCalibrations = "/api/v1/calibrations";

HttpResponse save_calibration(CalibrationDesk* desk, const RouteCall& call) {
  const Result<json> object = parse_object(call.request.body, "the body");
  if (!object) return error_response(object.error());
  JsonFields fields(*object, "");
  fields.require("session");
  fields.require("name");
  const std::string id = fields.text("session").value_or("");
  const std::string name = fields.text("name").value_or("");
  if (const Status status = fields.finish(); !status) return error_response(status.error());
  const auto session = desk->session(id);
  if (!session) return error_response(session.error());
  const auto solution = (*session)->state().solution;
  if (!solution) {
    return error_response({ErrorCode::kConflict, "the camera was not estimated yet"});
  }
  const Status saved = desk->store().save(name, solution->record);
  if (!saved && saved.error().code == ErrorCode::kUnsupported) {
    return error_response(403, "forbidden", saved.error().message);
  }
  if (!saved) return error_response(saved.error());
  HttpResponse response = json_response(201, desk->store().entry(name));
  response.headers.emplace_back("Location", std::string(kCalibrations) + "/" + name);
  return response;
}

/// The file of another program, to be downloaded.
HttpResponse camera_file(CalibrationDesk* desk,
                         const std::string& name,
                         const std::string& wanted) {
  const auto format = server::camera_format_from(wanted);
  if (!format) {
    return error_response({ErrorCode::kInvalidArgument,
                           "query.format = " + wanted.substr(0, 40) +
                               ": must be overfly, orb-slam2, dso, svo, ros or kalibr"});
  }
  const Result<std::string> text = desk->store().text(name, *format);
  if (!text && text.error().code == ErrorCode::kUnsupported) {
    return error_response(422, "unsupported", text.error().message);
  }
  if (!text) return error_response(text.error());
  const bool plain = *format == server::CameraFormat::kDso;
  HttpResponse response;
  response.content_type = plain ? "text/plain; charset=utf-8" : "application/yaml";
  response.headers.emplace_back("Cache-Control", "no-store");
  response.headers.emplace_back(
      "Content-Disposition",
      "attachment; filename=\"" + name + "-" + wanted + (plain ? ".txt\"" : ".yaml\""));
  response.body = *text;
  return response;
}

HttpResponse show_calibration(CalibrationDesk* desk, const RouteCall& call) {
  const std::string& name = call.path.at("name");
  const std::string format = call.query_or("format", "overfly");
  if (format != "overfly") return camera_file(desk, name, format);
  const Result<json> content = desk->store().read(name);
  if (!content && content.error().code == ErrorCode::kUnreadable) {
    return error_response(422, "unreadable", content.error().message);
  }
  return json_or_error(content);
}

}  // namespace

void add_calibration_routes(RestRouter* router, CalibrationDesk* desk) {
  const std::string one = std::string(kCalibrations) + "/{name}";
  router->add("GET", kCalibrations, [desk](const RouteCall&, const Respond& respond) {
    respond(json_response(
        200, {{"calibrations", desk->store().list()}, {"keeps", desk->store().keeps()}}));
  });
  router->add("POST", kCalibrations, [desk](const RouteCall& call, const Respond& respond) {
    respond(save_calibration(desk, call));
  });
  router->add("GET",
              one,
              [desk](const RouteCall& call, const Respond& respond) {
                respond(show_calibration(desk, call));
              },
              {"format"});
  router->add("DELETE", one, [desk](const RouteCall& call, const Respond& respond) {
    const Status removed = desk->store().remove(call.path.at("name"));
    HttpResponse gone;
    gone.status = 204;
    respond(removed ? gone : error_response(removed.error()));
  });
}

}  // namespace overfly::net
