// An HTTP request's method, path, query and headers: routes, static files, names of hosts, token.
//
// The input is the request as a browser sends it: `METHOD TARGET`, lines `name: value`, an empty
// line, the body.
#include <cstdlib>

#include "server/net/http/allowed_hosts.hpp"
#include "server/net/http/error_response.hpp"
#include "server/net/http/json_text.hpp"
#include "server/net/http/rest_router.hpp"
#include "server/net/http/static_files.hpp"
#include "server/net/http/token_gate.hpp"
#include "tests/fuzz/input_folder.hpp"

namespace overfly::net {
namespace {

HttpRequest request_from(std::string_view input) {
  HttpRequest request;
  const std::string_view first = fuzz::take_line(&input);
  const std::size_t space = first.find(' ');
  request.method = first.substr(0, space);
  if (space != std::string_view::npos) request.target = first.substr(space + 1);
  while (!input.empty()) {
    const std::string_view line = fuzz::take_line(&input);
    if (line.empty()) break;
    const std::size_t colon = line.find(": ");
    if (colon != std::string_view::npos) {
      request.headers[std::string(line.substr(0, colon))] = line.substr(colon + 2);
    }
  }
  request.body = input;
  return request;
}

RestRouter make_router() {
  RestRouter router;
  const auto echo = [](const RouteCall& call, const Respond& respond) {
    nlohmann::json answer = nlohmann::json::object();
    for (const auto& [name, value] : call.path) answer[name] = value;
    for (const auto& [name, value] : call.query) answer[name] = value;
    const auto body = parse_object(call.request.body, "the body");
    respond(body ? json_response(200, answer) : error_response(body.error()));
  };
  for (const char* pattern : {"/api/v1/health",
                              "/api/v1/runs",
                              "/api/v1/runs/{id}",
                              "/api/v1/runs/{id}/trajectories/{name}",
                              "/api/v1/scenarios/{name}"}) {
    router.add("GET", pattern, echo, {"format", "alignment", "camera"});
    router.add("POST", pattern, echo);
  }
  return router;
}

/// A dashboard with one page, below a folder with a file that no request may reach.
const std::filesystem::path& web_folder() {
  static const std::filesystem::path folder = fuzz::InputFolder::of_process().fill(
      {{"secret.txt", "SECRET"}, {"web/index.html", "<html>"}, {"web/assets/a.js", "a"}});
  return folder;
}

}  // namespace
}  // namespace overfly::net

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace overfly::net;
  static const RestRouter router = make_router();
  static const StaticFiles files(web_folder() / "web");
  const HttpRequest request = request_from(overfly::fuzz::text_of(data, size));
  int answers = 0;
  router.handle(request, [&](const HttpResponse&) { ++answers; });
  if (answers != 1) std::abort();
  const HttpResponse file = files.serve(request);
  // A refusal repeats what was asked for.
  if (file.status == 200 && file.body.find("SECRET") != std::string::npos) std::abort();
  static const AllowedHosts hosts({"range.example"});
  const auto authority = parse_authority(request.header("host"), 8480);
  if (authority) (void)hosts.allows(authority->host, "127.0.0.1");
  (void)hosts.allows_origin(request.header("origin"), request.header("host"), "127.0.0.1");
  static const TokenGate gate("0123456789abcdef");
  HttpRequest asked = request;
  (void)gate.check(&asked);
  return 0;
}
