// A server with a token: who does not show it gets nothing.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "tests/server/net/test_client.hpp"
#include "tests/server/net/test_server.hpp"

namespace overfly::testing {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

constexpr const char* kToken = "0123456789abcdefABCDEF-_";
const Headers kShown = {{"Authorization", std::string("Bearer ") + kToken}};

json openapi() { return json::parse(read_text(source_file("server/net/rest/openapi.json"))); }

std::string upgrade(const std::string& target) {
  return "GET " + target +
         " HTTP/1.1\r\nHost: localhost\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n"
         "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n";
}

TEST(Access, EveryRouteAsksForTheToken) {
  TestServer server({}, kToken);
  const json api = openapi();
  for (const auto& [path, operations] : api.at("paths").items()) {
    for (std::string method : {"get", "post", "delete", "head", "put", "options"}) {
      std::transform(method.begin(), method.end(), method.begin(), ::toupper);
      const Answer refused = ask(server.port(), method, path, "", {{"Cookie", "overfly_80=x"}});
      EXPECT_EQ(refused.status, 401) << method << " " << path;
      EXPECT_EQ(refused.headers.at("content-type"), "application/json") << path;
    }
    if (!operations.contains("get")) continue;
    const Answer served = ask(server.port(), "GET", path, "", kShown);
    EXPECT_NE(served.status, 401) << path;
    EXPECT_EQ(operations.at("get").at("responses").contains("401"), true) << path;
  }
  EXPECT_EQ(ask(server.port(), "GET", "/api/v1/health", "", kShown).status, 200);
  EXPECT_EQ(ask(server.port(), "GET", "/api/v1/none").status, 401);
  EXPECT_EQ(ask(server.port(), "GET", "/api/v1/runs?token=wrong").status, 401);
  EXPECT_EQ(ask(server.port(), "GET", std::string("/api/v1/runs?token=") + kToken).status, 200);
  EXPECT_TRUE(server.runs().runs().empty());
}

TEST(Access, FilesAndTheStreamAskForTheToken) {
  TestServer server({}, kToken);
  for (const char* path : {"/", "/index.html", "/none", "/runs/abc", "/../scenarios/tiny.json"}) {
    const Answer refused = ask(server.port(), "GET", path);
    EXPECT_EQ(refused.status, 401) << path;
    EXPECT_THAT(refused.body, Not(HasSubstr("<title>Overfly</title>"))) << path;
    EXPECT_EQ(refused.headers.at("cache-control"), "no-store");
    EXPECT_EQ(refused.headers.at("referrer-policy"), "no-referrer");
    EXPECT_THAT(refused.headers.at("content-security-policy"), HasSubstr("form-action 'self'"));
  }
  EXPECT_THAT(ask(server.port(), "GET", "/", "", kShown).body, HasSubstr("<title>Overfly</title>"));
  EXPECT_FALSE(WebSocketClient(server.port()).is_open());
  EXPECT_THAT(exchange_raw(server.port(), upgrade("/api/v1/stream")), StartsWith("HTTP/1.1 401"));
  EXPECT_THAT(exchange_raw(server.port(), upgrade("/api/v1/stream?token=x")),
              StartsWith("HTTP/1.1 401"));
  WebSocketClient client(server.port(), {kShown, 0});
  EXPECT_TRUE(client.is_open());
  client.wait_for("hello");
  EXPECT_THAT(exchange_raw(server.port(), upgrade(std::string("/api/v1/stream?token=") + kToken)),
              StartsWith("HTTP/1.1 101"));
}

TEST(Access, ABrowserGetsACookieForTheUrlThatTheServerPrints) {
  TestServer server({}, kToken);
  const std::string port = std::to_string(server.port());
  EXPECT_EQ(server.url(), "http://127.0.0.1:" + port + "/?token=" + kToken);
  const Answer first = ask(server.port(), "GET", std::string("/?token=") + kToken);
  ASSERT_EQ(first.status, 303);
  EXPECT_EQ(first.headers.at("location"), "./");
  const std::string set = first.headers.at("set-cookie");
  EXPECT_THAT(set, HasSubstr("HttpOnly; SameSite=Strict"));
  const Headers cookie = {{"Cookie", set.substr(0, set.find(';'))}};
  EXPECT_THAT(cookie.at("Cookie"), StartsWith("overfly_" + port + "="));
  EXPECT_EQ(ask(server.port(), "GET", "/", "", cookie).status, 200);
  EXPECT_TRUE(WebSocketClient(server.port(), {cookie, 0}).is_open());
}

TEST(Access, NoBodyIsTakenFromAClientWithoutTheToken) {
  TestServer server({}, kToken);
  // The body never comes: an answer shows that nothing waited for it.
  const std::string post =
      "POST /api/v1/runs HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\n"
      "Content-Length: 500000\r\n\r\n";
  EXPECT_THAT(exchange_raw(server.port(), post), StartsWith("HTTP/1.1 401"));
  // The answer reaches a client that sends its body first, whatever its size.
  const Answer answer = ask(server.port(), "POST", "/api/v1/runs", std::string(1 << 20, ' '), {});
  EXPECT_EQ(answer.status, 401);
}

TEST(Access, TheTokenIsNeitherLoggedNorRepeated) {
  TestServer server({}, kToken);
  const std::string query = std::string("?token=") + kToken;
  for (const char* path : {"/api/v1/none", "/none.txt", "/api/v1/health", "/api/%zz", "/"}) {
    EXPECT_THAT(ask(server.port(), "GET", path + query).body, Not(HasSubstr(kToken))) << path;
  }
  EXPECT_THAT(server.log(), Not(HasSubstr(kToken)));
}

/// POST requests that only calculate.
constexpr std::array<const char*, 6> kCalculations = {"/api/v1/scenario-check",
                                                      "/api/v1/sweep-check",
                                                      "/api/v1/missions/report",
                                                      "/api/v1/worlds/{name}/heights",
                                                      "/api/v1/evaluations",
                                                      "/api/v1/sweeps/{name}/comparison"};

TEST(Access, AViewerReadsEverythingAndChangesNothing) {
  net::ServerOptions options;
  options.token = kToken;
  options.viewer_token = "viewer-0123456789abcdef";
  TestServer server(options);
  const Headers viewer = {{"Authorization", "Bearer " + options.viewer_token}};
  const std::string run = server.fly("tiny");
  const json api = openapi();
  int refused = 0;
  for (const auto& [pattern, operations] : api.at("paths").items()) {
    std::string path = pattern;
    if (const std::size_t id = path.find("{id}"); id != std::string::npos) path.replace(id, 4, run);
    for (const auto& [name, operation] : operations.items()) {
      if (name == "parameters") continue;
      std::string method = name;
      std::transform(method.begin(), method.end(), method.begin(), ::toupper);
      const bool reads =
          method == "GET" ||
          std::find(kCalculations.begin(), kCalculations.end(), pattern) != kCalculations.end();
      const Answer answer = ask(server.port(), method, path, "{}", viewer);
      EXPECT_NE(answer.status, 401) << method << " " << path;
      EXPECT_EQ(answer.status == 403, !reads) << method << " " << path << answer.body;
      if (reads) continue;
      ++refused;
      EXPECT_EQ(json::parse(answer.body).at("error").at("code"), "read_only") << path;
      EXPECT_TRUE(operation.at("responses").contains("403")) << path;
    }
  }
  EXPECT_GE(refused, 20);
  EXPECT_EQ(ask(server.port(), "GET", "/api/v1/runs/" + run, "", viewer).status, 200);
  EXPECT_EQ(server.runs().runs().size(), 1U);
  // The body that never comes is not waited for.
  EXPECT_THAT(exchange_raw(server.port(),
                           "POST /api/v1/logs?name=a.bin HTTP/1.1\r\nHost: localhost\r\n"
                           "Authorization: Bearer viewer-0123456789abcdef\r\n"
                           "Content-Length: 500000\r\n\r\n"),
              StartsWith("HTTP/1.1 403"));
}

TEST(Access, TheStreamStatesWhatItsClientMayDo) {
  net::ServerOptions options;
  options.token = kToken;
  options.viewer_token = "viewer-0123456789abcdef";
  TestServer server(options);
  const Headers viewer = {{"Authorization", "Bearer " + options.viewer_token}};
  EXPECT_EQ(WebSocketClient(server.port(), {kShown, 0}).wait_for("hello").at("access"), "operator");
  EXPECT_EQ(WebSocketClient(server.port(), {viewer, 0}).wait_for("hello").at("access"), "viewer");
}

TEST(Access, TheInterfaceDescribesIt) {
  const json api = openapi();
  const json schemes = api.at("components").at("securitySchemes");
  for (const json& alternative : api.at("security")) {
    EXPECT_TRUE(schemes.contains(alternative.begin().key()));
  }
  EXPECT_EQ(schemes.size(), 3U);
}

TEST(Access, AServerThatOthersReachNeedsAToken) {
  TestServer first;
  net::ServerOptions options;
  options.port = 0;
  for (const char* address : {"0.0.0.0", "::", "192.0.2.1"}) {
    options.address = address;
    const auto open = net::Server::start(options, first.runs(), first.views());
    ASSERT_FALSE(open);
    EXPECT_EQ(open.error().code, ErrorCode::kInvalidArgument);
    EXPECT_THAT(open.error().message, HasSubstr("token"));
  }
  options.address = "127.0.0.1";
  options.token = "short";
  EXPECT_FALSE(net::Server::start(options, first.runs(), first.views()));
  for (const char* viewer_token : {"short", kToken}) {
    options.token = kToken;
    options.viewer_token = viewer_token;
    EXPECT_FALSE(net::Server::start(options, first.runs(), first.views())) << viewer_token;
  }
  options.token.clear();
  options.viewer_token = kToken;
  EXPECT_FALSE(net::Server::start(options, first.runs(), first.views()));
}

}  // namespace
}  // namespace overfly::testing
