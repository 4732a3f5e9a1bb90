#include "server/net/http/token_gate.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>

#include "server/net/http/access_token.hpp"

namespace overfly::net {
namespace {

using ::testing::HasSubstr;
using ::testing::MatchesRegex;
using ::testing::Not;

constexpr const char* kGateToken = "0123456789abcdefABCDEF-_";

HttpRequest get_from_host(const std::string& target,
                          const std::map<std::string, std::string>& headers = {}) {
  HttpRequest request{"GET", target, headers, ""};
  request.headers.emplace("host", "127.0.0.1:8480");
  return request;
}

/// 0 = the request is served.
int status_of(HttpRequest request) {
  const auto response = TokenGate(kGateToken).check(&request);
  return response ? response->status : 0;
}

std::string header(const HttpResponse& response, const std::string& name) {
  for (const auto& [key, value] : response.headers) {
    if (key == name) return value;
  }
  return "";
}

TEST(AccessToken, IsMadeAnewOfRandomCharactersThatFitIntoAUrl) {
  const auto first = make_token();
  const auto second = make_token();
  ASSERT_TRUE(first && second);
  EXPECT_NE(*first, *second);
  EXPECT_THAT(*first, MatchesRegex("[A-Za-z0-9_-]{32}"));
  EXPECT_TRUE(check_token(*first));
}

TEST(AccessToken, MustBeLongAndPlain) {
  EXPECT_TRUE(check_token(std::string(22, 'x')));
  for (const std::string& token : {std::string(21, 'x'),
                                   std::string(257, 'x'),
                                   std::string(22, 'x') + ";",
                                   std::string(22, 'x') + "\n",
                                   std::string(22, 'x') + "\xC3\xA4"}) {
    const Status status = check_token(token);
    ASSERT_FALSE(status) << token;
    EXPECT_EQ(status.error().code, ErrorCode::kInvalidArgument);
    EXPECT_THAT(status.error().message, Not(HasSubstr("xxx")));
  }
}

TEST(AccessToken, IsComparedWhole) {
  EXPECT_TRUE(same_token(kGateToken, kGateToken));
  EXPECT_FALSE(same_token("0123456789abcdefABCDEF-", kGateToken));
  EXPECT_FALSE(same_token("0123456789abcdefABCDEF-~", kGateToken));
  EXPECT_FALSE(same_token("", kGateToken));
}

TEST(TokenGate, TakesTheTokenFromQueryHeaderOrCookie) {
  const std::string token = kGateToken;
  EXPECT_EQ(status_of(get_from_host("/api/v1/runs?token=" + token)), 0);
  EXPECT_EQ(status_of(get_from_host("/api/v1/runs", {{"authorization", "Bearer " + token}})), 0);
  EXPECT_EQ(status_of(get_from_host("/api/v1/runs", {{"authorization", "bearer " + token}})), 0);
  EXPECT_EQ(status_of(get_from_host("/", {{"cookie", "a=b; overfly_8480=" + token + "; c=d"}})), 0);
  // One of several is enough: a path's cookie of an older server may come first.
  EXPECT_EQ(status_of(get_from_host("/", {{"cookie", "overfly_8480=old; overfly_8480=" + token}})),
            0);
}

TEST(TokenGate, RefusesEverythingElse) {
  const std::string token = kGateToken;
  for (const HttpRequest& request :
       {get_from_host("/api/v1/runs"),
        get_from_host("/api/v1/health"),
        get_from_host("/"),
        get_from_host("/assets/main.js"),
        get_from_host("/api/v1/runs?token="),
        get_from_host("/api/v1/runs?token=" + token + "x"),
        get_from_host("/api/v1/runs?token=" + token.substr(1)),
        get_from_host("/api/v1/runs?Token=" + token),
        get_from_host("/api/v1/runs?token=%zz"),
        get_from_host("/api/v1/runs", {{"authorization", "Basic " + token}}),
        get_from_host("/api/v1/runs", {{"authorization", token}}),
        get_from_host("/api/v1/runs", {{"authorization", "Bearer"}}),
        get_from_host("/", {{"cookie", "overfly_8481=" + token}}),
        get_from_host("/", {{"cookie", "xoverfly_8480=" + token}}),
        get_from_host("/", {{"cookie", "overfly_8480"}}),
        get_from_host("/", {{"cookie", token}})}) {
    EXPECT_EQ(status_of(request), 401) << request.target;
  }
}

TEST(TokenGate, TakesTheTokenOutOfTheTarget) {
  const std::string token = kGateToken;
  const auto left = [](const std::string& target) {
    HttpRequest request = get_from_host(target);
    (void)TokenGate(kGateToken).check(&request);
    return request.target;
  };
  EXPECT_EQ(left("/api/v1/runs?token=" + token), "/api/v1/runs");
  EXPECT_EQ(left("/api/v1/runs?a=1&token=" + token + "&b=2"), "/api/v1/runs?a=1&b=2");
  EXPECT_EQ(left("/api/v1/runs?%74oken=" + token), "/api/v1/runs");
  EXPECT_EQ(left("/api/v1/runs?a=1"), "/api/v1/runs?a=1");
  HttpRequest open = get_from_host("/api/v1/runs?token=anything");
  EXPECT_FALSE(TokenGate("").check(&open));
  EXPECT_EQ(open.target, "/api/v1/runs");
}

TEST(TokenGate, SendsABrowserOnToTheAddressWithoutTheToken) {
  HttpRequest request = get_from_host(std::string("/map?a=1&token=") + kGateToken);
  const auto response = TokenGate(kGateToken).check(&request);
  ASSERT_TRUE(response);
  EXPECT_EQ(response->status, 303);
  EXPECT_EQ(header(*response, "Location"), "./map?a=1");
  EXPECT_EQ(header(*response, "Set-Cookie"),
            std::string("overfly_8480=") + kGateToken + "; HttpOnly; SameSite=Strict");
  EXPECT_EQ(header(*response, "Cache-Control"), "no-store");
}

TEST(TokenGate, KnowsAPastedAddressAndForgetsAnOldToken) {
  const std::string pasted = std::string("/?token=http%3A%2F%2Flocalhost%3A8480%2F%3Ftoken%3D");
  EXPECT_EQ(status_of(get_from_host(pasted + kGateToken)), 303);
  // Let in by its cookie: the stale token of a bookmark leaves the address bar, nothing else.
  HttpRequest request =
      get_from_host("/?token=old", {{"cookie", std::string("overfly_8480=") + kGateToken}});
  const auto response = TokenGate(kGateToken).check(&request);
  ASSERT_TRUE(response);
  EXPECT_EQ(response->status, 303);
  EXPECT_EQ(header(*response, "Set-Cookie"), "");
}

TEST(TokenGate, NeverRedirectsToAnotherHost) {
  for (const char* path : {"//evil.example/", "/\\evil.example/", "http://evil.example/", "/"}) {
    HttpRequest request = get_from_host(std::string(path) + "?token=" + kGateToken);
    const auto response = TokenGate(kGateToken).check(&request);
    ASSERT_TRUE(response) << path;
    EXPECT_EQ(header(*response, "Location"), "./") << path;
  }
  for (const char* path : {"//evil.example", "/\\evil.example", "/a/evil.example"}) {
    HttpRequest request =
        get_from_host(std::string(path) + "?to=//evil.example/b&token=" + kGateToken);
    const auto response = TokenGate(kGateToken).check(&request);
    ASSERT_TRUE(response) << path;
    EXPECT_EQ(header(*response, "Location"), "./evil.example?to=//evil.example/b") << path;
  }
}

TEST(TokenGate, AnswersBrowsersWithAPageAndProgramsWithJson) {
  HttpRequest page = get_from_host("/runs/abc");
  const auto html = TokenGate(kGateToken).check(&page);
  ASSERT_TRUE(html);
  EXPECT_EQ(html->content_type, "text/html; charset=utf-8");
  EXPECT_THAT(html->body, HasSubstr("<form"));
  EXPECT_THAT(html->body, Not(HasSubstr("token is wrong")));
  HttpRequest wrong = get_from_host("/?token=<script>");
  EXPECT_THAT(TokenGate(kGateToken).check(&wrong)->body, HasSubstr("token is wrong"));
  HttpRequest api = get_from_host("/api/v1/runs?token=0123456789abcdefABCDEF__");
  const auto json = TokenGate(kGateToken).check(&api);
  ASSERT_TRUE(json);
  EXPECT_EQ(json->content_type, "application/json");
  EXPECT_THAT(json->body, HasSubstr("\"unauthorized\""));
  EXPECT_THAT(header(*json, "WWW-Authenticate"), HasSubstr("Bearer"));
  for (const auto& answer : {*html, *json}) {
    EXPECT_THAT(answer.body, Not(HasSubstr(kGateToken)));
    EXPECT_THAT(answer.body, Not(HasSubstr("ABCDEF__")));
  }
}

constexpr const char* kViewerToken = "viewer-0123456789abcdef";

/// What a request may do at a server with both tokens; empty if it is not served.
std::optional<Access> access_of(HttpRequest request) {
  const TokenGate gate(kGateToken, kViewerToken);
  return gate.check(&request) ? std::nullopt : std::optional(request.access);
}

TEST(TokenGate, KnowsWhoMayOnlyLook) {
  const std::string ours = kGateToken;
  const std::string theirs = kViewerToken;
  const std::string api = "/api/v1/runs";
  EXPECT_EQ(access_of(get_from_host(api + "?token=" + theirs)), Access::kViewer);
  EXPECT_EQ(access_of(get_from_host(api, {{"authorization", "Bearer " + theirs}})),
            Access::kViewer);
  EXPECT_EQ(access_of(get_from_host("/", {{"cookie", "overfly_8480=" + theirs}})), Access::kViewer);
  EXPECT_EQ(access_of(get_from_host(api + "?token=" + ours)), Access::kOperator);
  EXPECT_EQ(access_of(get_from_host(api + "?token=" + theirs + "x")), std::nullopt);
  EXPECT_EQ(access_of(get_from_host(api)), std::nullopt);
  // Of both, the one in the address counts, otherwise the operator's.
  const std::map<std::string, std::string> operators_cookie = {{"cookie", "overfly_8480=" + ours}};
  EXPECT_EQ(access_of(get_from_host(api + "?token=" + theirs, operators_cookie)), Access::kViewer);
  EXPECT_EQ(
      access_of(get_from_host(api,
                              {{"cookie", "overfly_8480=" + theirs + "; overfly_8480=" + ours},
                               {"authorization", "Bearer " + theirs}})),
      Access::kOperator);
  // Without a viewers' token an empty one is none.
  HttpRequest request = get_from_host("/?token=");
  EXPECT_EQ(TokenGate(kGateToken).check(&request)->status, 401);
}

TEST(TokenGate, GivesAViewersBrowserTheViewersCookie) {
  HttpRequest request = get_from_host(std::string("/?token=") + kViewerToken);
  const auto response = TokenGate(kGateToken, kViewerToken).check(&request);
  ASSERT_TRUE(response);
  EXPECT_EQ(response->status, 303);
  EXPECT_THAT(header(*response, "Set-Cookie"),
              HasSubstr(std::string("overfly_8480=") + kViewerToken + ";"));
}

TEST(TokenGate, NamesItsCookieByThePort) {
  EXPECT_EQ(token_cookie_name("127.0.0.1:8480"), "overfly_8480");
  EXPECT_EQ(token_cookie_name("[::1]:9000"), "overfly_9000");
  EXPECT_EQ(token_cookie_name("[::1]"), "overfly_80");
  EXPECT_EQ(token_cookie_name("fly.example.org"), "overfly_80");
}

}  // namespace
}  // namespace overfly::net
