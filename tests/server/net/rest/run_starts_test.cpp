// Runs that are started and cancelled, and requests that are refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <set>
#include <string>

#include "tests/server/net/rest/documented_api.hpp"

namespace overfly::testing {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

using RunStartsTest = DocumentedApi;

TEST_F(RunStartsTest, CancelsARunningRunAndDoesNotDeleteOne) {
  const std::string id = server_.start("slow");
  const std::string run = "/api/v1/runs/" + id;
  check("DELETE", "/api/v1/runs/{id}", run, 409);
  check("POST", "/api/v1/runs/{id}/cancel", run + "/cancel", 202);
  server_.wait_for_end(id);
  EXPECT_EQ(check("GET", "/api/v1/runs/{id}", run, 200).json().at("status"), "cancelled");
}

TEST_F(RunStartsTest, StartsRunsWithOverridesAndNamesWhatIsAtFault) {
  const auto post = [&](const json& body, int status) {
    return check("POST", "/api/v1/runs", "/api/v1/runs", status, body.dump(), kJson);
  };
  const Answer bad =
      post({{"scenario", "tiny"},
            {"overrides", {{"flight.course.airspeed_m_s", 400}, {"camera.rate_hz", -1}}}},
           400);
  std::set<std::string> fields;
  const json faults = bad.json().at("error").at("faults");
  for (const json& fault : faults) fields.insert(fault.at("field"));
  EXPECT_TRUE(fields.contains("flight.course.airspeed_m_s"));
  EXPECT_TRUE(fields.contains("camera.rate_hz"));
  EXPECT_THAT(post({{"scenario", "tiny"}, {"speed", 3}}, 400).body, HasSubstr("speed"));
  EXPECT_THAT(post({{"scenario", 3}}, 400).body, HasSubstr("scenario"));
  EXPECT_THAT(post(json::object(), 400).body, HasSubstr("scenario"));
  EXPECT_THAT(post({{"scenario", "tiny"}, {"overrides", {1}}}, 400).body, HasSubstr("overrides"));
  post({{"scenario", "none"}}, 404);
  post({{"scenario", "../tiny"}}, 404);
  const Answer good = post({{"scenario", "tiny"}, {"overrides", {{"duration_s", 0.5}}}}, 201);
  const std::string id = good.json().at("id");
  server_.wait_for_end(id);
  EXPECT_EQ(ask(server_.port(), "GET", "/api/v1/runs/" + id).json().at("frames"), 16);
}

/// What a client could make the server start, listen on, write to, or speak to.
TEST_F(RunStartsTest, RefusesCommandsThatNoScenarioFileHas) {
  const auto post = [&](const json& body, int status) {
    return check("POST", "/api/v1/runs", "/api/v1/runs", status, body.dump(), kJson);
  };
  const json evil = {{"name", "e"}, {"type", "process"}, {"command", {"/bin/true"}}};
  const json listening = {{"name", "e"}, {"type", "process"}, {"listen", "tcp:0.0.0.0:9"}};
  const json writing = {{"name", "e"}, {"type", "lcm"}, {"lcm", {{"url", "file:///etc/x?mode=w"}}}};
  const json calling = {
      {"name", "e"}, {"type", "ros1"}, {"ros1", {{"master_uri", "http://example.org:80"}}}};
  const json reading = {
      {"name", "e"}, {"type", "perfect"}, {"parameters", {{"file", "/etc/passwd"}}}};
  const std::map<std::string, json> wanted = {{"command", evil},
                                              {"listen", listening},
                                              {"lcm.url", writing},
                                              {"ros1.master_uri", calling},
                                              {"parameters.file", reading}};
  for (const auto& [field, estimator] : wanted) {
    for (const json& overrides :
         {json{{"estimators", {estimator}}}, json{{"estimators.0", estimator}}}) {
      const Answer refused = post({{"scenario", "tiny"}, {"overrides", overrides}}, 403);
      EXPECT_EQ(refused.json().at("error").at("code"), "forbidden") << field;
      EXPECT_THAT(refused.body, HasSubstr("estimators.0." + field));
      EXPECT_THAT(refused.body, HasSubstr("--allow-commands"));
    }
  }
  EXPECT_TRUE(server_.runs().runs().empty());
  const json scaled = {{"estimators.0.parameters.scale", 2}, {"duration_s", 0.5}};
  const Answer plain = post({{"scenario", "tiny"}, {"overrides", scaled}}, 201);
  server_.wait_for_end(plain.json().at("id"));
}

TEST_F(RunStartsTest, FliesADocumentAndNamesWhatIsAtFaultInIt) {
  const auto post = [&](const json& body, int status) {
    return check("POST", "/api/v1/runs", "/api/v1/runs", status, body.dump(), kJson);
  };
  json document = ask(server_.port(), "GET", "/api/v1/scenarios/tiny").json();
  document["duration_s"] = 0.5;
  const std::string id = post({{"document", document}}, 201).json().at("id");
  server_.wait_for_end(id);
  EXPECT_EQ(ask(server_.port(), "GET", "/api/v1/runs/" + id).json().at("frames"), 16);
  EXPECT_THAT(post({{"document", document}, {"scenario", "tiny"}}, 400).body,
              HasSubstr("must not be given with document"));
  post({{"document", 7}}, 400);
  document["seed"] = -1;
  EXPECT_THAT(post({{"document", document}}, 400).body, HasSubstr("\"field\":\"seed\""));
  document["seed"] = 1;
  document["estimators"] = {{{"name", "e"}, {"type", "process"}, {"command", {"/bin/true"}}}};
  EXPECT_THAT(post({{"document", document}}, 403).body, HasSubstr("estimators.0.command"));
  check("PUT", "/api/v1/scenarios/{name}", "/api/v1/scenarios/evil", 403, document.dump(), kJson);
  document.erase("estimators");
  document["world"] = {{"manifest", "/etc/passwd"}};
  EXPECT_THAT(post({{"document", document}}, 400).body, HasSubstr("data folders"));
}

/// Files of this machine that a client names: inside of the data folders, and everywhere else.
TEST_F(RunStartsTest, SaysTheSameOfEveryFileOutsideOfTheDataFolders) {
  const auto post = [&](const std::string& field, const json& value, int status) {
    const json body = {{"scenario", "tiny"}, {"overrides", {{field, value}}}};
    return check("POST", "/api/v1/runs", "/api/v1/runs", status, body.dump(), kJson).body;
  };
  const std::filesystem::path world = server_.folder() / "world";
  EXPECT_THAT(post("world.manifest", (world / "none.json").string(), 404), HasSubstr("no such"));
  EXPECT_THAT(post("world.manifest", world.string() + "/.", 400), HasSubstr("must be"));
  for (const char* field : {"world.manifest", "world.imagery.0.file", "flight.log.file"}) {
    for (const std::string& file : {std::string("/etc/passwd"),
                                    std::string("/etc/no such file"),
                                    std::string("/proc/self/mem"),
                                    std::string("/proc/kmsg"),
                                    std::string("/dev/zero"),
                                    std::string("/vsicurl/http://127.0.0.1:9/a.tif"),
                                    std::string("../../../../../../../../etc/passwd"),
                                    (server_.folder() / "runs" / "a" / "scenario.json").string()}) {
      EXPECT_THAT(post(field, file, 400),
                  HasSubstr(": must be a file inside of the server's data folders"))
          << field << " " << file;
    }
  }
  EXPECT_THAT(post("data", "/etc", 201), HasSubstr("queued"));  // the files of "tiny" are absolute
  for (const char* crs :
       {"http://127.0.0.1:9/crs", "/vsicurl/http://127.0.0.1:9/", "/etc/passwd"}) {
    EXPECT_THAT(post("world.imagery.0.crs", crs, 400), HasSubstr("world.imagery.0.crs"));
  }
  EXPECT_THAT(post("$schema", "<VRTDataset/>", 400), HasSubstr("$schema"));
}

TEST_F(RunStartsTest, GivesTheSameRunForTheSameKey) {
  Headers headers = kJson;
  headers["Idempotency-Key"] = "once";
  const auto post = [&](int status) {
    return check(
        "POST", "/api/v1/runs", "/api/v1/runs", status, TestServer::body_of("tiny"), headers);
  };
  const std::string id = post(201).json().at("id");
  EXPECT_EQ(post(200).json().at("id"), id);
  EXPECT_EQ(server_.runs().runs().size(), 1U);
  // Whatever it asks for: it was not this.
  for (const char* other :
       {R"({"scenario":"tiny","overrides":{"seed":8}})", R"({"scenario":"none"})"}) {
    const Answer refused = check("POST", "/api/v1/runs", "/api/v1/runs", 422, other, headers);
    EXPECT_EQ(refused.json().at("error").at("code"), "idempotency_key_used");
    EXPECT_THAT(refused.body, HasSubstr(id));
  }
  headers["Idempotency-Key"] = "twice";
  EXPECT_NE(post(201).json().at("id"), id);
  headers["Idempotency-Key"] = std::string(300, 'k');
  post(400);
}

TEST_F(RunStartsTest, RefusesOtherMethodsBodiesAndOrigins) {
  const Answer put = ask(server_.port(), "PUT", "/api/v1/runs");
  EXPECT_EQ(put.status, 405);
  EXPECT_EQ(put.headers.at("allow"), "GET, HEAD, POST");
  EXPECT_EQ(ask(server_.port(), "GET", "/api/v1/none").status, 404);
  EXPECT_EQ(ask(server_.port(), "GET", "/api/v1/stream").status, 426);
  const std::string runs = "/api/v1/runs";
  check("POST", runs, runs, 415, TestServer::body_of("tiny"), {{"Content-Type", "text/plain"}});
  // The case of a media type has no meaning.
  for (const char* type : {"APPLICATION/JSON", "Application/Json; Charset=UTF-8"}) {
    check("POST", runs, runs, 400, "{", {{"Content-Type", type}});
  }
  check("POST", runs, runs, 413, std::string((1 << 20) + 1, ' '), kJson);
  check("POST", runs, runs, 400, "{", kJson);
  const std::string start = R"({"scenario":"tiny","overrides":{)";
  const std::string deep =
      R"("seed":)" + std::string(80'000, '[') + std::string(80'000, ']') + "}}";
  EXPECT_THAT(check("POST", runs, runs, 400, start + deep, kJson).body, HasSubstr("64 deep"));
  std::string path = "seed";
  for (int i = 1; i < 100'000; ++i) path += ".a";
  const std::string parts = "\"" + path + "\":1}}";
  EXPECT_THAT(check("POST", runs, runs, 400, start + parts, kJson).body, HasSubstr("100000 parts"));
  Headers foreign = kJson;
  foreign["Origin"] = "http://evil.example";
  check("POST", runs, runs, 403, TestServer::body_of("tiny"), foreign);
  EXPECT_EQ(ask(server_.port(), "GET", runs, "", {{"Host", "evil.example"}}).status, 403);
  EXPECT_TRUE(server_.runs().runs().empty());
}

/// Whether or not the route takes a body.
TEST_F(RunStartsTest, RefusesLargeBodiesAtEveryRouteAsDocumented) {
  const std::string large((1U << 20U) + 1U, ' ');
  for (const auto& [path, operations] : api_.at("paths").items()) {
    std::string target = path;
    std::erase_if(target, [](char c) { return c == '{' || c == '}'; });
    for (const std::string method : {"POST", "PUT"}) {
      const auto operation = operations.find(method == "POST" ? "post" : "put");
      if (operation == operations.end()) continue;
      // Uploads have limits of their own.
      if (operation->dump().find("application/octet-stream") != std::string::npos) continue;
      check(method, path, target, 413, large, kJson);
    }
  }
}

TEST_F(RunStartsTest, AnswersHeadLikeGetWithoutABody) {
  const Answer get = ask(server_.port(), "GET", "/api/v1/health");
  const Answer head = ask(server_.port(), "HEAD", "/api/v1/health");
  EXPECT_EQ(head.status, 200);
  EXPECT_TRUE(head.body.empty());
  EXPECT_EQ(head.headers.at("content-length"), get.headers.at("content-length"));
}

TEST_F(RunStartsTest, ServesTheDashboardBesideTheInterface) {
  EXPECT_THAT(ask(server_.port(), "GET", "/").body, HasSubstr("Overfly"));
  EXPECT_EQ(ask(server_.port(), "GET", "/../scenarios/tiny.json").status, 404);
  EXPECT_EQ(ask(server_.port(), "GET", "/api/v1/runs/..%2Fscenarios/manifest").status, 404);
}

TEST(RunStarts, ParametersOfNativeEstimatorsAreCheckedFirst) {
  TestServer server;
  const Answer tiny = ask(server.port(), "GET", "/api/v1/scenarios/tiny");
  json document = tiny.json();
  document["estimators"] = {
      {{"name", "f"}, {"type", "feature"}, {"parameters", {{"features", 5}}}},
      {{"name", "p"}, {"type", "perfect"}, {"parameters", {{"drift", 0.5}}}},
      {{"name", "q"}, {"type", "perfect"}, {"parameters", {{"scal", 2}}}},
      {{"name", "h"}, {"type", "baseline_hold"}, {"parameters", {{"window", 2}}}},
      {{"name", "o"}, {"type", "baseline_homography"}, {"parameters", {{"features", "many"}}}}};
  const auto fields = [](const json& faults) {
    std::vector<std::string> names;
    for (const json& fault : faults) names.push_back(fault.at("field"));
    return names;
  };
  const std::vector<std::string> at_fault{"estimators.0.parameters.features",
                                          "estimators.2.parameters.scal",
                                          "estimators.3.parameters.window",
                                          "estimators.4.parameters.features"};
  const Answer checked = ask(
      server.port(), "POST", "/api/v1/scenario-check", json{{"document", document}}.dump(), kJson);
  EXPECT_EQ(checked.json().at("valid"), false) << checked.body;
  EXPECT_EQ(fields(checked.json().at("faults")), at_fault) << checked.body;
  const Answer started =
      ask(server.port(), "POST", "/api/v1/runs", json{{"document", document}}.dump(), kJson);
  EXPECT_EQ(started.status, 400);
  EXPECT_EQ(fields(started.json().at("error").at("faults")), at_fault) << started.body;
  EXPECT_TRUE(ask(server.port(), "GET", "/api/v1/runs").json().at("runs").empty());
}

}  // namespace
}  // namespace overfly::testing
