#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "server/calibration/session/session_json.hpp"
#include "server/net/http/error_response.hpp"
#include "server/net/rest/calibration/rest_calibration_request.hpp"
#include "server/net/rest/rest_api.hpp"
#include "server/net/rest/rest_reading.hpp"
#include "server/runs/run_manager.hpp"
#include "server/scenario/document/scenario_faults.hpp"
#include "server/scenario/document/scenario_file.hpp"

namespace overfly::net {
namespace {

using nlohmann::json;
using server::CalibrationDesk;
using server::CalibrationSession;

constexpr std::uint64_t kMostUploadedImageBytes = std::uint64_t{32} << 20U;
constexpr const char* kSessions = "/api/v1/calibration-sessions";
constexpr const char* kOneSession = "/api/v1/calibration-sessions/{id}";

json named_session_json(const std::string& id, const CalibrationSession& session) {
  json value = server::session_json(session, session.state());
  value["id"] = id;
  return value;
}

HttpResponse begin_session(CalibrationDesk* desk, const RouteCall& call) {
  const auto request = calibration_request_from(call.request.body);
  if (!request) return error_response(request.error());
  const Result<std::string> id = desk->begin(*request);
  if (!id && id.error().code == ErrorCode::kConflict) {
    return error_response(503, "too_many_calibrations", id.error().message);
  }
  if (!id) return error_response(id.error());
  const auto session = desk->session(*id);
  if (!session) return error_response(session.error());
  HttpResponse response = json_response(201, named_session_json(*id, **session));
  response.headers.emplace_back("Location", std::string(kSessions) + "/" + *id);
  return response;
}

/// 204 if nothing has changed since the revision that the client has.
HttpResponse show_session(const RouteCall& call, CalibrationSession& session) {
  const std::string known = call.query_or("revision", "");
  const auto revision = number_from<std::int64_t>(known);
  if (!known.empty() && !revision) {
    return error_response(bad_query("revision", known, "a whole number"));
  }
  if (revision && *revision == session.state().revision) {
    HttpResponse response;
    response.status = 204;
    return response;
  }
  return json_response(200, named_session_json(call.path.at("id"), session));
}

HttpResponse list_sessions(CalibrationDesk* desk) {
  json list = json::array();
  for (const auto& [id, session] : desk->sessions())
    list.push_back(named_session_json(id, *session));
  return json_response(200, {{"sessions", std::move(list)}});
}

HttpResponse control_session(const RouteCall& call, CalibrationSession& session) {
  const auto control = session_control_from(call.request.body);
  if (!control) return error_response(control.error());
  if (control->automatic) session.set_automatic(*control->automatic);
  if (control->clear) session.clear();
  if (control->capture) {
    if (const Status status = session.capture(); !status) return error_response(status.error());
  }
  if (control->finish) session.finish();
  return json_response(202, named_session_json(call.path.at("id"), session));
}

HttpResponse solve_session(const RouteCall& call, CalibrationSession& session) {
  const auto command = solve_command_from(call.request.body);
  if (!command) return error_response(command.error());
  const Status status = session.solve(command->lens, command->left_out);
  if (!status) return error_response(status.error());
  return json_response(202, named_session_json(call.path.at("id"), session));
}

HttpResponse show_solution(const RouteCall& /*call*/, CalibrationSession& session) {
  const auto solution = session.state().solution;
  if (solution) return json_response(200, server::solution_json(*solution));
  return error_response({ErrorCode::kNotFound, "the camera was not estimated yet"});
}

HttpResponse show_view(const RouteCall& call, CalibrationSession& session) {
  const server::SessionState state = session.state();
  const auto view = number_from<std::size_t>(call.path.at("view"));
  if (view && *view < state.views.size()) {
    return json_response(200, server::view_json(state, *view, session.options().board));
  }
  return error_response({ErrorCode::kNotFound, "the session has no such view"});
}

HttpResponse show_image(const RouteCall& call, CalibrationSession& session) {
  const std::string& file = call.path.at("file");
  const std::string ending = ".jpg";
  const auto number = file.ends_with(ending)
                          ? number_from<std::int64_t>(file.substr(0, file.size() - ending.size()))
                          : std::nullopt;
  const auto image = number ? server::find_image(session.state(), *number) : nullptr;
  if (!image || !image->jpeg) {
    return error_response({ErrorCode::kNotFound, "the session has no image " + file});
  }
  HttpResponse response;
  response.content_type = "image/jpeg";
  // The numbers of a session's images are never used again.
  response.headers.emplace_back("Cache-Control", "private, max-age=3600, immutable");
  response.body.assign(image->jpeg->begin(), image->jpeg->end());
  return response;
}

/// An image of a session's client in memory.
class ImageSink final : public BodySink {
 public:
  ImageSink(std::shared_ptr<CalibrationSession> session, std::string name)
      : session_(std::move(session)), name_(std::move(name)) {}

  [[nodiscard]] std::optional<HttpResponse> write(std::span<const std::uint8_t> bytes) override {
    if (bytes_.size() + bytes.size() > kMostUploadedImageBytes) return too_large();
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
    return std::nullopt;
  }
  [[nodiscard]] HttpResponse finish() override {
    const Result<bool> taken = session_->upload(name_, std::move(bytes_));
    if (!taken) return error_response(taken.error());
    if (!*taken) {
      return error_response(
          429, "too_many_images", "too many images wait to be searched: try again soon");
    }
    return json_response(202, {{"name", name_}});
  }
  static HttpResponse too_large() {
    return error_response(
        413,
        "payload_too_large",
        "the image is larger than " + std::to_string(kMostUploadedImageBytes >> 20U) + " MiB");
  }

 private:
  std::shared_ptr<CalibrationSession> session_;
  std::string name_;
  std::vector<std::uint8_t> bytes_;
};

/// Printable, and short enough to be listed.
bool is_image_title(const std::string& name) {
  constexpr std::size_t kLongestTitle = 200;
  return !name.empty() && name.size() <= kLongestTitle &&
         std::none_of(
             name.begin(), name.end(), [](unsigned char c) { return c < 0x20 || c == 0x7F; });
}

std::unique_ptr<BodySink> receive_image(CalibrationDesk* desk,
                                        const RouteCall& call,
                                        std::optional<std::uint64_t> size_bytes,
                                        std::optional<HttpResponse>* answer) {
  const auto session = desk->session(call.path.at("id"));
  const std::string name = call.query_or("name", "");
  if (!session) {
    *answer = error_response(session.error());
  } else if (!is_image_title(name)) {
    *answer = error_response(bad_query("name", name, "1 to 200 printable characters"));
  } else if (!(*session)->takes_uploads()) {
    *answer = error_response({ErrorCode::kConflict, "the images of this session are not uploaded"});
  } else if (size_bytes.value_or(0) > kMostUploadedImageBytes) {
    *answer = ImageSink::too_large();
  } else {
    return std::make_unique<ImageSink>(*session, name);
  }
  return nullptr;
}

using SessionHandler = HttpResponse (*)(const RouteCall&, CalibrationSession&);

/// A handler of a request that names a session.
RestRouter::Handler of_session(CalibrationDesk* desk, SessionHandler handler) {
  return [desk, handler](const RouteCall& call, const Respond& respond) {
    // A viewer's page must not hold a camera open that its operator has left.
    const bool keeps_it = call.request.access == Access::kOperator;
    const auto session = desk->session(call.path.at("id"), keeps_it);
    respond(session ? handler(call, **session) : error_response(session.error()));
  };
}

}  // namespace

Result<server::CameraSpec> scenario_camera(server::RunManager& runs,
                                           const std::string& scenario,
                                           const std::string& camera) {
  const Result<json> document = runs.library().document(scenario);
  if (!document) return document.error();
  const auto resolved = server::resolve_scenario(*document, {}, {}, runs.data_folders().sources);
  if (!resolved) return resolved.error();
  std::size_t index = 0;
  if (!camera.empty()) {
    const auto found = server::camera_index(*resolved, camera, "source.camera");
    if (!found) return found.error();
    index = *found;
  }
  return resolved->cameras[index];
}

void add_calibration_session_routes(RestRouter* router, CalibrationDesk* desk) {
  const std::string one = kOneSession;
  router->add(
      "GET", "/api/v1/calibration-sources", [desk](const RouteCall&, const Respond& respond) {
        respond(json_response(200, desk->sources_json()));
      });
  router->add("GET", kSessions, [desk](const RouteCall&, const Respond& respond) {
    respond(list_sessions(desk));
  });
  router->add("POST", kSessions, [desk](const RouteCall& call, const Respond& respond) {
    respond(begin_session(desk, call));
  });
  router->add("GET", one, of_session(desk, show_session), {"revision"});
  router->add("DELETE", one, [desk](const RouteCall& call, const Respond& respond) {
    const Status ended = desk->end(call.path.at("id"));
    HttpResponse gone;
    gone.status = 204;
    respond(ended ? gone : error_response(ended.error()));
  });
  router->add("POST", one + "/control", of_session(desk, control_session));
  router->add("POST", one + "/solution", of_session(desk, solve_session));
  router->add("GET", one + "/solution", of_session(desk, show_solution));
  router->add("GET", one + "/views/{view}", of_session(desk, show_view));
  router->add("GET", one + "/images/{file}", of_session(desk, show_image));
  router->add_upload(one + "/images",
                     [desk](const RouteCall& call,
                            std::optional<std::uint64_t> size_bytes,
                            std::optional<HttpResponse>* answer) {
                       return receive_image(desk, call, size_bytes, answer);
                     },
                     {"name"});
}

}  // namespace overfly::net
