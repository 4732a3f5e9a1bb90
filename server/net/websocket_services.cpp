#include "server/net/websocket_services.hpp"

#include <boost/beast/http/rfc7230.hpp>
#include <utility>

#include "server/net/foxglove/foxglove_viewer.hpp"
#include "server/net/http/access_token.hpp"
#include "server/net/http/url.hpp"
#include "server/net/stream/viewer.hpp"

namespace overfly::net {
namespace {

namespace http = boost::beast::http;
using foxglove::FoxgloveViewer;

constexpr const char* kStreamPath = "/api/v1/stream";
constexpr const char* kFoxglovePath = "/api/v1/foxglove";
/// The newer protocol, which has playback control, and the one before.
constexpr const char* kFoxgloveSdk = "foxglove.sdk.v1";
constexpr const char* kFoxgloveWebSocket = "foxglove.websocket.v1";

std::string path_of(const std::string& target) { return target.substr(0, target.find('?')); }

/// The protocol that the client prefers: the first one in its list that is spoken here (RFC 6455,
/// section 4.1). Lichtblick lists both, the older one first, and does not know the newer one's
/// playback states. Empty if there is none.
std::string foxglove_protocol(const http::request<http::string_body>& upgrade) {
  const auto fields = upgrade.equal_range(http::field::sec_websocket_protocol);
  for (auto field = fields.first; field != fields.second; ++field) {
    for (const auto& offered : http::token_list(field->value())) {
      if (offered == kFoxgloveSdk || offered == kFoxgloveWebSocket) return std::string(offered);
    }
  }
  return "";
}

Result<WebSocketService> foxglove_service(const http::request<http::string_body>& upgrade,
                                          const std::string& target,
                                          const std::shared_ptr<ServerContext>& context) {
  const auto url = parse_target(target);
  if (!url) return Error{ErrorCode::kInvalidArgument, "the target is not a valid URL"};
  WebSocketService service;
  service.protocol = foxglove_protocol(upgrade);
  if (service.protocol.empty()) {
    return Error{ErrorCode::kInvalidArgument,
                 std::string("Sec-WebSocket-Protocol: must offer ") + kFoxgloveWebSocket + " or " +
                     kFoxgloveSdk};
  }
  FoxgloveViewer::Options options;
  if (const auto run = url->query.find("run"); run != url->query.end()) {
    options.run_id = run->second;
  }
  const Result<std::string> session = make_token();
  if (!session) return session.error();
  options.session = *session;
  options.playback_control = service.protocol == kFoxgloveSdk;
  options.folder_of = [context](const std::string& run_id) { return context->runs.folder(run_id); };
  service.make_client = [options = std::move(options)](ViewerPort& port) {
    return std::make_unique<FoxgloveViewer>(port, options);
  };
  return service;
}

}  // namespace

bool is_websocket_target(const std::string& target) {
  return path_of(target) == kStreamPath || is_foxglove_target(target);
}

bool is_foxglove_target(const std::string& target) { return path_of(target) == kFoxglovePath; }

ConnectionPhase web_socket_phase(const HttpRequest& request) {
  return request.access == Access::kViewer ? ConnectionPhase::kOnlooker : ConnectionPhase::kViewer;
}

Result<WebSocketService> websocket_service(const http::request<http::string_body>& upgrade,
                                           const HttpRequest& request,
                                           const std::shared_ptr<ServerContext>& context) {
  if (is_foxglove_target(request.target)) return foxglove_service(upgrade, request.target, context);
  return WebSocketService{"", [access = request.access](ViewerPort& port) {
                            return std::make_unique<Viewer>(port, access);
                          }};
}

}  // namespace overfly::net
