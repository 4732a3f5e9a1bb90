#include "server/net/http/rest_router.hpp"

#include <gtest/gtest.h>

#include "server/net/http/error_response.hpp"
#include "server/net/http/rest_slots.hpp"

namespace overfly::net {
namespace {

HttpResponse ask(const RestRouter& router, const std::string& method, const std::string& target) {
  HttpResponse answer;
  router.handle({method, target, {}, ""}, [&](HttpResponse response) { answer = response; });
  return answer;
}

RestRouter example() {
  RestRouter router;
  const auto echo = [](const RouteCall& call, const Respond& respond) {
    HttpResponse response;
    response.body = call.path.at("id");
    respond(response);
  };
  router.add("GET", "/runs/{id}", echo);
  router.add("DELETE", "/runs/{id}", echo);
  router.add("POST", "/runs/{id}/cancel", echo);
  return router;
}

TEST(RestSlots, AreFreeAgainWithTheLastCopy) {
  const auto taken = std::make_shared<std::atomic<int>>(0);
  auto first = take_slot(taken, 2);
  const auto second = take_slot(taken, 2);
  ASSERT_TRUE(first && second);
  EXPECT_EQ(take_slot(taken, 2), nullptr);
  auto copy = first;
  first.reset();
  EXPECT_EQ(take_slot(taken, 2), nullptr) << "a copy holds it";
  copy.reset();
  auto third = take_slot(taken, 2);
  ASSERT_NE(third, nullptr);
  const auto copy_of_third = third;
  third->release();
  third->release();
  EXPECT_EQ(taken->load(), 1) << "once, although there are copies";
}

TEST(RestRouter, MatchesPathsAndDecodesWhatTheyHold) {
  const RestRouter router = example();
  EXPECT_EQ(ask(router, "GET", "/runs/a%20b").body, "a b");
  EXPECT_EQ(ask(router, "HEAD", "/runs/a").status, 200);
  EXPECT_EQ(ask(router, "POST", "/runs/a/cancel").body, "a");
}

TEST(RestRouter, KnowsWhichRequestsChangeSomething) {
  RestRouter router = example();
  router.add_calculation("/check/{id}", [](const RouteCall&, const Respond&) {});
  router.add_upload("/logs", {});
  const auto changes = [&](const std::string& method, const std::string& target) {
    return router.changes({method, target, {}, ""});
  };
  EXPECT_TRUE(changes("DELETE", "/runs/a"));
  EXPECT_TRUE(changes("POST", "/runs/a%20b/cancel?x=y"));
  EXPECT_TRUE(changes("POST", "/logs"));
  EXPECT_FALSE(changes("GET", "/runs/a"));
  EXPECT_FALSE(changes("HEAD", "/runs/a"));
  EXPECT_FALSE(changes("POST", "/check/a"));
  EXPECT_FALSE(changes("POST", "/runs/a")) << "there is none";
}

TEST(RestRouter, AnswersOneLongCalculationOfViewersAtATime) {
  RestRouter router;
  std::vector<Respond> waiting;
  router.add_long_calculation(
      "/score", [&](const RouteCall&, const Respond& respond) { waiting.push_back(respond); });
  const auto status_of = [&](Access access) {
    int status = 0;
    HttpRequest request{"POST", "/score", {}, ""};
    request.access = access;
    router.handle(request, [&](const HttpResponse& response) { status = response.status; });
    return status;
  };
  EXPECT_EQ(status_of(Access::kViewer), 0);
  EXPECT_EQ(status_of(Access::kViewer), 503);
  EXPECT_EQ(status_of(Access::kOperator), 0);
  EXPECT_EQ(status_of(Access::kOperator), 0);
  EXPECT_EQ(waiting.size(), 3U);
}

TEST(RestRouter, TellsUnknownPathsFromWrongMethods) {
  const RestRouter router = example();
  EXPECT_EQ(ask(router, "GET", "/runs").status, 404);
  EXPECT_EQ(ask(router, "GET", "/runs/").status, 404);
  EXPECT_EQ(ask(router, "GET", "/runs/a/b").status, 404);
  EXPECT_EQ(ask(router, "GET", "/runs/%zz").status, 400);
  const HttpResponse wrong = ask(router, "PUT", "/runs/a");
  EXPECT_EQ(wrong.status, 405);
  bool allow_seen = false;
  for (const auto& [name, value] : wrong.headers) {
    if (name == "Allow") allow_seen = value == "DELETE, GET, HEAD";
  }
  EXPECT_TRUE(allow_seen);
}

TEST(RestRouter, RefusesParametersThatTheRouteDoesNotKnow) {
  RestRouter router = example();
  router.add("GET",
             "/pictures",
             [](const RouteCall& call, const Respond& respond) {
               HttpResponse response;
               response.body = call.query_or("size", "small");
               respond(response);
             },
             {"size", "camera"});
  EXPECT_EQ(ask(router, "GET", "/pictures?size=big").body, "big");
  EXPECT_EQ(ask(router, "GET", "/pictures").body, "small");
  const HttpResponse wrong = ask(router, "GET", "/pictures?size=big&seize=1");
  EXPECT_EQ(wrong.status, 400);
  EXPECT_NE(wrong.body.find("query.seize"), std::string::npos);
  EXPECT_NE(wrong.body.find("size, camera"), std::string::npos);
  const HttpResponse twice = ask(router, "GET", "/pictures?size=big&size=small");
  EXPECT_EQ(twice.status, 400);
  EXPECT_NE(twice.body.find("query.size: must be given at most once"), std::string::npos);
  EXPECT_EQ(ask(router, "GET", "/runs/a?x=1").status, 400);
  EXPECT_EQ(ask(router, "DELETE", "/runs/a?x=1").status, 400);
}

TEST(RestRouter, KnowsUploadsByTheirDecodedPath) {
  RestRouter router = example();
  router.add_upload(
      "/logs",
      [](const RouteCall&, std::optional<std::uint64_t>, std::optional<HttpResponse>* answer) {
        answer->emplace().status = 299;
        return std::unique_ptr<BodySink>();
      },
      {"name"});
  for (const char* target : {"/logs", "/%6Cogs?name=a.bin", "/l%6fgs#x"}) {
    const HttpRequest request{"POST", target, {}, ""};
    ASSERT_TRUE(router.is_upload(request)) << target;
    std::unique_ptr<BodySink> sink;
    std::optional<HttpResponse> answer;
    router.receive(request, std::nullopt, &sink, &answer);
    EXPECT_EQ(answer.value().status, 299) << target;
  }
  EXPECT_FALSE(router.is_upload({"POST", "/logs%2F", {}, ""}));
  EXPECT_FALSE(router.is_upload({"GET", "/logs", {}, ""}));
  // A route without a handler is no reason to fail.
  EXPECT_EQ(ask(router, "POST", "/%6Cogs").status, 405);
}

TEST(ErrorResponse, ListsTheFieldsAtFault) {
  const HttpResponse response = error_response({ErrorCode::kInvalidArgument,
                                                "camera.fov_deg = 190: must be in (0, 180)\n"
                                                "seed = -1: must be at least 0"});
  EXPECT_EQ(response.status, 400);
  const auto error = nlohmann::json::parse(response.body).at("error");
  ASSERT_EQ(error.at("faults").size(), 2U);
  EXPECT_EQ(error["faults"][0]["field"], "camera.fov_deg");
  EXPECT_EQ(error["faults"][1]["field"], "seed");
}

TEST(ErrorResponse, SurvivesTextThatIsNoUtf8) {
  EXPECT_EQ(error_response({ErrorCode::kNotFound, "no \xFF\xC0 here"}).status, 404);
}

}  // namespace
}  // namespace overfly::net
