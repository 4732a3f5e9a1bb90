// What HTTP itself asks of a server: bytes in, bytes out.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "tests/server/net/test_client.hpp"
#include "tests/server/net/test_server.hpp"

namespace overfly::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

int count(const std::string& text, const std::string& part) {
  int found = 0;
  for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos; at += part.size()) {
    ++found;
  }
  return found;
}

TEST(HttpSession, AnswersPipelinedRequestsInOrderOnOneConnection) {
  const TestServer server;
  std::string requests;
  for (int i = 0; i < 20; ++i) {
    requests += "GET /api/v1/none" + std::to_string(i) + " HTTP/1.1\r\nHost: localhost\r\n\r\n";
  }
  requests += "GET /api/v1/health HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n";
  const std::string answers = exchange_raw(server.port(), requests);
  EXPECT_EQ(count(answers, "HTTP/1.1 404"), 20);
  EXPECT_EQ(count(answers, "HTTP/1.1 200"), 1);
  EXPECT_LT(answers.find("none3"), answers.find("none4"));
}

TEST(HttpSession, EveryAnswerHasProtectiveHeaders) {
  const TestServer server;
  for (const char* path : {"/", "/api/v1/runs"}) {
    const Answer answer = ask(server.port(), "GET", path);
    EXPECT_EQ(answer.status, 200) << path;
    EXPECT_EQ(answer.headers.at("x-content-type-options"), "nosniff") << path;
    EXPECT_THAT(answer.headers.at("content-security-policy"),
                AllOf(StartsWith("default-src 'self';"),
                      HasSubstr("frame-ancestors 'self'"),
                      HasSubstr("base-uri 'none'")))
        << path;
  }
}

TEST(HttpSession, RefusesHeadersThatAreTooLarge) {
  const TestServer server;
  const std::string request =
      "GET / HTTP/1.1\r\nHost: localhost\r\nX-Long: " + std::string(20'000, 'x') + "\r\n\r\n";
  EXPECT_THAT(exchange_raw(server.port(), request), StartsWith("HTTP/1.1 431"));
}

TEST(HttpSession, InvitesTheBodyOfAClientThatWaitsForThat) {
  const TestServer server;
  const std::string header =
      "POST /api/v1/runs HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\n"
      "Expect: 100-continue\r\nConnection: close\r\nContent-Length: ";
  EXPECT_THAT(exchange_raw(server.port(), header + "1\r\n\r\n{"),
              AllOf(StartsWith("HTTP/1.1 100 Continue\r\n\r\n"), HasSubstr("HTTP/1.1 400")));
  EXPECT_THAT(exchange_raw(server.port(), header + "2000000\r\n\r\n"), StartsWith("HTTP/1.1 413"));
}

TEST(HttpSession, SurvivesMalformedRequests) {
  const TestServer server;
  for (const char* request : {"",
                              "\r\n\r\n",
                              "GET",
                              "GET / HTTP/9.9\r\n\r\n",
                              "GET /\x01 HTTP/1.1\r\n\r\n",
                              "POST /api/v1/runs HTTP/1.1\r\nContent-Length: -1\r\n\r\n",
                              "POST /api/v1/runs HTTP/1.1\r\nContent-Length: 99\r\n\r\n{",
                              "POST /api/v1/runs HTTP/1.1\r\nTransfer-Encoding: chunked\r\n\r\nzz",
                              "GET /api/v1/stream HTTP/1.1\r\nHost: localhost\r\n"
                              "Connection: upgrade\r\nUpgrade: websocket\r\n\r\n"}) {
    const std::string answer = exchange_raw(server.port(), request);
    EXPECT_THAT(answer, ::testing::Not(HasSubstr("HTTP/1.1 200"))) << request;
  }
  std::mt19937 random(3);
  for (int i = 0; i < 100; ++i) {
    std::string bytes(1 + random() % 300, '\0');
    for (char& byte : bytes) byte = static_cast<char>(random() % 256);
    (void)exchange_raw(server.port(), bytes);
  }
  EXPECT_EQ(ask(server.port(), "GET", "/api/v1/health").status, 200);
}

TEST(Server, SaysWhichPortIsTaken) {
  TestServer first;
  net::ServerOptions options;
  options.port = first.port();
  const auto second = net::Server::start(options, first.runs(), first.views());
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().code, ErrorCode::kIo);
  EXPECT_THAT(second.error().message, HasSubstr(std::to_string(first.port())));
  EXPECT_THAT(second.error().message, HasSubstr("127.0.0.1"));
}

TEST(Server, RefusesAnAddressThatIsNoneAndAMissingDashboard) {
  TestServer first;
  net::ServerOptions options;
  options.port = 0;
  options.address = "not an address";
  EXPECT_EQ(net::Server::start(options, first.runs(), first.views()).error().code,
            ErrorCode::kInvalidArgument);
  options.address = "127.0.0.1";
  options.web_folder = "/nowhere/at/all";
  EXPECT_EQ(net::Server::start(options, first.runs(), first.views()).error().code,
            ErrorCode::kNotFound);
}

}  // namespace
}  // namespace overfly::testing
