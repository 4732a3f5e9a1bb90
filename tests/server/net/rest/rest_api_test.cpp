// Every route, its answers checked against the OpenAPI file that the server serves.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <thread>

#include "server/files/jpeg.hpp"
#include "server/scenario/document/scenario_schema.hpp"
#include "tests/flight/logs/northward_log.hpp"
#include "tests/server/calibration/board_fixture.hpp"
#include "tests/server/net/rest/documented_api.hpp"

namespace overfly::testing {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

class RestApiTest : public DocumentedApi {
 protected:
  /// Every route of sweeps.
  void check_sweeps();
  /// Those that start sweeps.
  void check_sweep_starts();
  /// Every route of studies.
  void check_studies();
  /// Every route of calibrations.
  void check_calibrations();
  void wait_until_solved(const std::string& session);
};

void RestApiTest::check_sweeps() {
  const std::string all = "/api/v1/sweeps";
  EXPECT_TRUE(check("GET", all, all, 200).json().at("sweeps").empty());
  const std::filesystem::path sweep = server_.folder() / "sweeps/night";
  std::filesystem::create_directories(sweep / "runs");
  write_text(sweep / "sweep.json",
             R"({"title": "Night", "axes": [{"path": "seed"}], "axis_values": {"seed": [1]}})");
  EXPECT_EQ(check("GET", all, all, 200).json().at("sweeps").at(0).at("name"), "night");
  const std::string one = all + "/{name}";
  EXPECT_TRUE(check("GET", one, all + "/night", 200).json().at("table").is_null());
  const std::string run = "0123456789abcdef0123";
  std::filesystem::copy(server_.runs().folder(server_.fly("tiny")).value(),
                        sweep / "runs" / run,
                        std::filesystem::copy_options::recursive);
  write_text(sweep / "results.jsonl",
             R"({"key": "k", "cell": {"seed": 1}, "repeat": 0, "seed": 1, "estimator": "perfect",
                 "run": "runs/0123456789abcdef0123", "error": "", "status": "completed",
                 "outcome": "COMPLETED", "duration_s": 1})"_json.dump() +
                 "\n");
  const json table = check("GET", one, all + "/night", 200).json().at("table");
  ASSERT_EQ(table.at("rows").size(), 1U) << table;
  EXPECT_EQ(table.at("rows").at(0).at("runs"), json::array({"night." + run}));
  const std::string tables = all + "/night/tables";
  check("GET", one + "/tables", tables, 200);
  check("GET", one + "/tables", tables + "?format=pdf", 400);
  check("GET", one + "/tables", tables + "?published=none", 404);
  const std::string comparison = all + "/night/comparison";
  check("POST", one + "/comparison", comparison, 200, R"({"baseline": "night"})", kJson);
  check("POST", one + "/comparison", comparison, 400, "{}", kJson);
  check("POST", one + "/comparison", comparison, 404, R"({"baseline": "none"})", kJson);
  check("POST", one + "/comparison", comparison, 415, "{}");
  const std::string shown = "/api/v1/runs/night." + run;
  EXPECT_EQ(check("GET", "/api/v1/runs/{id}", shown, 200).json().at("id"), "night." + run);
  check("DELETE", "/api/v1/runs/{id}", shown, 409);
  write_text(sweep / "sweep.json", "{");
  check("GET", one, all + "/night", 422);
  check("GET", one, all + "/none", 404);
  check_sweep_starts();
}

void RestApiTest::check_sweep_starts() {
  const std::string all = "/api/v1/sweeps";
  const std::string files = "/api/v1/sweep-files";
  const std::filesystem::path folder = server_.folder() / "scenarios/sweeps";
  std::filesystem::create_directories(folder);
  write_text(folder / "own.json",
             R"({"format_version": 1, "scenario": "../tiny.json",
                 "axes": [{"path": "seed", "values": [1]}]})");
  EXPECT_EQ(check("GET", files, files, 200).json().at("files").size(), 1U);
  check("GET", files + "/{name}", files + "/own", 200);
  check("GET", files + "/{name}", files + "/none", 404);
  const std::string cost = "/api/v1/sweep-check";
  EXPECT_EQ(check("POST", cost, cost, 200, R"({"file": "own"})", kJson).json().at("cells"), 1);
  check("POST", cost, cost, 200, R"({"document": {}})", kJson);
  check("POST", cost, cost, 400, R"({})", kJson);
  check("POST", all, all, 201, R"({"name": "own", "file": "own"})", kJson);
  check("POST", all, all, 400, R"({"name": "a/b", "file": "own"})", kJson);
  check("POST", all, all, 404, R"({"name": "x", "file": "none"})", kJson);
  check("GET", all + "/{name}/document", all + "/own/document", 200);
  check("GET", all + "/{name}/document", all + "/none/document", 404);
  const std::string go_on = all + "/{name}/continue";
  check("POST", go_on, all + "/none/continue", 404, "{}", kJson);
  check("POST", all + "/{name}/cancel", all + "/none/cancel", 404);
  const auto flies = [&] {
    for (const json& sweep : json(ask(server_.port(), "GET", all).json().at("sweeps"))) {
      if (sweep.at("name") == "own") return !sweep.at("here").is_null();
    }
    return false;
  };
  for (int turns = 0; turns < 1000 && flies(); ++turns) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  check("POST", go_on, all + "/own/continue", 202, "{}", kJson);
}

void RestApiTest::check_studies() {
  const std::string all = "/api/v1/studies";
  EXPECT_TRUE(check("GET", all, all, 200).json().at("studies").empty());
  const auto post = [&](const std::string& body, int status) {
    return check("POST", all, all, status, body, kJson);
  };
  post("{}", 400);
  post(R"({"kind": "explain", "run": "none"})", 404);
  check("POST", all, all, 415, "{}");
  const Answer started = post(R"({"kind": "predict", "scenario": "tiny"})", 201);
  const std::string study = started.headers.at("location");
  const std::string one = all + "/{name}";
  const auto state = [&] {
    return check("GET", one, study, 200).json().at("study").at("state").get<std::string>();
  };
  // Its program is /bin/false.
  for (int turns = 0; turns < 1000 && state() != "failed"; ++turns) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  EXPECT_EQ(state(), "failed");
  check("GET", all, all, 200);
  check("GET", one + "/page", study + "/page", 404);
  const std::filesystem::path folder =
      server_.folder() / "studies" / started.json().at("name").get<std::string>();
  write_text(folder / "predict.html", "<h1>Risk</h1>");
  check("GET", one + "/page", study + "/page", 200);
  check("GET", one + "/worst", study + "/worst", 404);
  write_text(folder / "worst.json", "{}");
  check("GET", one + "/worst", study + "/worst", 200);
  write_text(folder / "predict.json", "{");
  check("GET", one, study, 422);
  check("POST", one + "/cancel", study + "/cancel", 409);
  check("POST", one + "/continue", study + "/continue", 202);
  for (int turns = 0; turns < 1000; ++turns) {
    const Answer removed = ask(server_.port(), "DELETE", study);
    if (removed.status == 204) break;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  check("DELETE", one, study, 404);
  check("POST", one + "/continue", study + "/continue", 404);
}

void RestApiTest::wait_until_solved(const std::string& session) {
  for (int turns = 0; turns < 3000; ++turns) {
    if (ask(server_.port(), "GET", session).json().at("solution").is_number()) return;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  ADD_FAILURE() << session << " is not solved";
}

void RestApiTest::check_calibrations() {
  const std::string sessions = "/api/v1/calibration-sessions";
  const std::string one = sessions + "/{id}";
  check("GET", "/api/v1/calibration-sources", "/api/v1/calibration-sources", 200);
  check("POST", sessions, sessions, 400, "{}", kJson);
  const json board = {{"cols", 9}, {"rows", 6}, {"square_m", 0.03}};
  const auto begin = [&](const json& source, int status) {
    const json body = {{"source", source}, {"board", board}};
    return check("POST", sessions, sessions, status, body.dump(), kJson);
  };
  begin({{"kind", "folder"}, {"name", "none"}}, 404);
  const std::string session = begin({{"kind", "upload"}}, 201).headers.at("location");
  const std::string other = begin({{"kind", "upload"}}, 201).headers.at("location");
  begin({{"kind", "upload"}}, 503);
  EXPECT_EQ(check("GET", sessions, sessions, 200).json().at("sessions").size(), 2U);
  check("DELETE", one, other, 204);
  check("DELETE", one, other, 404);
  check("GET", one, other, 404);
  check("GET", one + "/solution", session + "/solution", 404);
  check("POST", one + "/solution", session + "/solution", 409, "{}", kJson);
  check("POST", one + "/solution", session + "/solution", 400, R"({"left_out":[-1]})", kJson);
  for (const Image& image : server::testing::board_images(5)) {
    const auto jpeg = server::encode_jpeg(image, 95).value();
    const std::string images = session + "/images?name=a.jpg";
    const std::string body(jpeg.begin(), jpeg.end());
    while (ask(server_.port(), "GET", session).json().at("phase") == "opening") {
    }
    const json before = ask(server_.port(), "GET", session).json().at("images");
    check("POST", one + "/images", images, 202, body);
    while (ask(server_.port(), "GET", session).json().at("images") == before) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
  }
  check("POST", one + "/images", session + "/images?name=", 400, "x");
  check("GET", one + "/images/{file}", session + "/images/0.jpg", 200);
  check("GET", one + "/images/{file}", session + "/images/0.png", 404);
  check("POST", one + "/control", session + "/control", 202, R"({"finish":true})", kJson);
  check("POST", one + "/control", session + "/control", 400, R"({"finish":1})", kJson);
  wait_until_solved(session);
  check("POST", one + "/control", session + "/control", 409, R"({"capture":true})", kJson);
  const json state = check("GET", one, session, 200).json();
  check("GET", one, session + "?revision=" + state.at("revision").dump(), 204);
  check("POST", one + "/solution", session + "/solution", 202, R"({"left_out":[0]})", kJson);
  check("GET", one + "/solution", session + "/solution", 200);
  check("GET", one + "/views/{view}", session + "/views/0", 200);
  check("GET", one + "/views/{view}", session + "/views/5", 404);

  const std::string saved = "/api/v1/calibrations";
  const std::string id = session.substr(session.rfind('/') + 1);
  const std::string save = json{{"session", id}, {"name", "c"}}.dump();
  EXPECT_TRUE(check("GET", saved, saved, 200).json().at("calibrations").empty());
  check("POST", saved, saved, 201, save, kJson);
  check("POST", saved, saved, 409, save, kJson);
  check("POST", saved, saved, 404, json{{"session", "none"}, {"name", "c"}}.dump(), kJson);
  check("POST", saved, saved, 400, json{{"session", id}, {"name", "../c"}}.dump(), kJson);
  EXPECT_EQ(check("GET", saved, saved, 200).json().at("calibrations").size(), 1U);
  check("GET", saved + "/{name}", saved + "/c", 200);
  check("GET", saved + "/{name}", saved + "/c?format=kalibr", 200);
  check("GET", saved + "/{name}", saved + "/c?format=dso", 200);
  check("GET", saved + "/{name}", saved + "/c?format=x", 400);
  check("GET", saved + "/{name}", saved + "/none", 404);
  check("DELETE", saved + "/{name}", saved + "/c", 204);
  check("DELETE", saved + "/{name}", saved + "/c", 404);
}

TEST_F(RestApiTest, AnswersEveryRouteAsDocumented) {
  const std::string runs = "/api/v1/runs";
  const std::string one = runs + "/{id}";
  check("GET", "/api/v1/health", "/api/v1/health", 200);
  check("GET", "/api/v1/openapi.json", "/api/v1/openapi.json", 200);
  const Answer scenarios = check("GET", "/api/v1/scenarios", "/api/v1/scenarios", 200);
  EXPECT_EQ(scenarios.json().at("scenarios").size(), 3U);
  check("GET", "/api/v1/scenarios/{name}", "/api/v1/scenarios/tiny", 200);
  check("GET", "/api/v1/scenarios/{name}", "/api/v1/scenarios/none", 404);
  check("GET", "/api/v1/scenarios/{name}", "/api/v1/scenarios/broken", 400);
  const Answer world =
      check("GET", "/api/v1/scenarios/{name}/world", "/api/v1/scenarios/tiny/world", 200);
  EXPECT_EQ(world.json().at("outline").size(), 32U);
  check("GET", "/api/v1/scenarios/{name}/world", "/api/v1/scenarios/none/world", 404);
  check("GET", "/api/v1/scenarios/{name}/world", "/api/v1/scenarios/broken/world", 400);
  const Answer schema = check("GET", "/api/v1/scenario-schema", "/api/v1/scenario-schema", 200);
  EXPECT_EQ(schema.body, server::scenario_schema_text());

  const std::string scenario = "/api/v1/scenarios/{name}";
  const json tiny = ask(server_.port(), "GET", "/api/v1/scenarios/tiny").json();
  const std::string mine = "/api/v1/scenarios/mine";
  const Answer saved = check("PUT", scenario, mine, 201, tiny.dump(), kJson);
  EXPECT_EQ(saved.headers.at("location"), mine);
  check("PUT", scenario, mine, 409, tiny.dump(), kJson);
  check("PUT", scenario, mine + "?replace=true", 200, tiny.dump(), kJson);
  check("PUT", scenario, mine + "?replace=yes", 400, tiny.dump(), kJson);
  check("PUT", scenario, mine, 415, tiny.dump());
  check("PUT", scenario, "/api/v1/scenarios/tiny?replace=true", 403, tiny.dump(), kJson);
  check("PUT", scenario, "/api/v1/scenarios/..%2Ftiny", 400, tiny.dump(), kJson);
  check("DELETE", scenario, "/api/v1/scenarios/tiny", 403);
  check("DELETE", scenario, mine, 204);
  check("DELETE", scenario, mine, 404);
  check_sweeps();
  check_studies();
  const std::string checks = "/api/v1/scenario-check";
  const auto checked = [&](const json& document, int status) {
    return check("POST", checks, checks, status, json{{"document", document}}.dump(), kJson);
  };
  EXPECT_EQ(checked(tiny, 200).json().at("valid"), true);
  json wrong = tiny;
  wrong["camera"]["rate_hz"] = -1;
  wrong.erase("flight");
  const json verdict = checked(wrong, 200).json();
  EXPECT_EQ(verdict.at("valid"), false);
  std::set<std::string> fields;
  for (const json& fault : verdict.at("faults")) fields.insert(fault.at("field"));
  EXPECT_EQ(fields, (std::set<std::string>{"camera.rate_hz", "flight"}));
  checked(3, 400);
  check("POST", checks, checks, 415, "{}");

  const std::string worlds = "/api/v1/worlds";
  const std::string ground = worlds + "/scenario:tiny";
  EXPECT_EQ(check("GET", worlds, worlds, 200).json().at("worlds").at(0).at("name"), "builtin:1");
  const json described = check("GET", worlds + "/{name}", ground, 200).json();
  check("GET", worlds + "/{name}", worlds + "/none", 404);
  check("POST", worlds + "/{name}/make", ground + "/make?progress=12345678", 200);
  check("POST", worlds + "/{name}/make", ground + "/make?progress=1", 400);
  const std::string tiles = worlds + "/{name}/tiles/{z}/{x}/{y}";
  const int zoom = described.at("max_zoom");
  const double lat = described.at("centre").at("lat_deg").get<double>() * 0.017453292519943295;
  const double lon = described.at("centre").at("lon_deg").get<double>();
  const int column = static_cast<int>((lon + 180.0) / 360.0 * (1 << zoom));
  const int row =
      static_cast<int>((0.5 - std::asinh(std::tan(lat)) / (2.0 * 3.14159265358979)) * (1 << zoom));
  const std::string tile = ground + "/tiles/" + std::to_string(zoom) + "/" +
                           std::to_string(column) + "/" + std::to_string(row);
  const std::string version = described.at("version");
  const Answer drawn_tile = check("GET", tiles, tile + "?version=" + version, 200);
  EXPECT_THAT(drawn_tile.headers.at("cache-control"), HasSubstr("immutable"));
  EXPECT_EQ(check("GET", tiles, tile, 200).headers.at("cache-control"), "no-cache");
  check("GET", tiles, ground + "/tiles/3/0/0", 200);
  check("GET", tiles, ground + "/tiles/3/8/0", 400);
  check("GET", tiles, ground + "/tiles/x/8/0", 400);
  check("GET", tiles, worlds + "/none/tiles/3/0/0", 404);
  const std::string heights = worlds + "/{name}/heights";
  const json place = {described.at("centre").at("lat_deg"), described.at("centre").at("lon_deg")};
  const json measured = check("POST",
                              heights,
                              ground + "/heights",
                              200,
                              json{{"points", {place, {10.0, 10.0}}}}.dump(),
                              kJson)
                            .json();
  EXPECT_EQ(measured.at("imagery"), (json{true, false}));
  EXPECT_NEAR(measured.at("alt_ellipsoid_m").at(0).get<double>(),
              described.at("centre").at("alt_ellipsoid_m").get<double>(),
              0.01);
  for (const json& points : {json::array(),
                             json{{91, 0}},
                             json{{1, 2, 3}},
                             json{7},
                             json(std::vector<json>(2001, place))}) {
    check("POST", heights, ground + "/heights", 400, json{{"points", points}}.dump(), kJson);
  }
  check("POST", heights, worlds + "/none/heights", 404, json{{"points", {place}}}.dump(), kJson);

  const std::string missions = "/api/v1/missions/report";
  const auto mission_of = [&](int command) {
    json document = tiny;
    const json home = {place[0], place[1], 230.0};
    const json params = {0, 0, 0, nullptr, place[0], place[1].get<double>() + 0.01, 150};
    document["flight"] = {{"mission",
                           {{"plan",
                             {{"fileType", "Plan"},
                              {"mission",
                               {{"version", 2},
                                {"plannedHomePosition", home},
                                {"items",
                                 {{{"type", "SimpleItem"},
                                   {"command", command},
                                   {"frame", 3},
                                   {"params", params}}}}}}}}}}};
    return document;
  };
  const json limits = {{"min_clearance_m", 100}, {"max_bank_deg", 30}};
  const json wanted = {{"document", mission_of(16)}, {"limits", limits}, {"samples", 50}};
  const json report = check("POST", missions, missions, 200, wanted.dump(), kJson).json();
  EXPECT_EQ(report.at("items").at(0).at("item"), 1);
  const std::string planned = "/api/v1/scenarios/planned";
  check("PUT", scenario, planned, 201, mission_of(16).dump(), kJson);
  EXPECT_EQ(check("GET", scenario + "/plan", planned + "/plan", 200).json(),
            mission_of(16).at("flight").at("mission").at("plan"));
  check("GET", scenario + "/plan", "/api/v1/scenarios/tiny/plan", 400);
  check("GET", scenario + "/plan", "/api/v1/scenarios/none/plan", 404);
  check("DELETE", scenario, planned, 204);
  const auto refused = [&](const json& body, int status) {
    return check("POST", missions, missions, status, body.dump(), kJson).body;
  };
  EXPECT_THAT(refused({{"document", tiny}}, 400), HasSubstr("must be a mission"));
  EXPECT_THAT(refused({{"document", mission_of(82)}}, 400), HasSubstr("item 1: command 82"));
  EXPECT_THAT(refused({{"document", mission_of(16)}, {"limits", {{"max_bank_deg", 99}}}}, 400),
              HasSubstr("limits.max_bank_deg"));
  refused({{"document", mission_of(16)}, {"samples", 7}}, 400);
  check("POST", missions, missions, 415, "{}");

  const Answer started = check("POST", runs, runs, 201, TestServer::body_of("tiny"), kJson);
  const std::string id = started.json().at("id");
  EXPECT_EQ(started.headers.at("location"), runs + "/" + id);
  server_.wait_for_end(id);
  const std::string run = runs + "/" + id;
  EXPECT_EQ(check("GET", runs, runs, 200).json().at("runs").at(0).at("id"), id);
  EXPECT_EQ(check("GET", one, run, 200).json().at("status"), "completed");
  check("GET", one + "/metrics", run + "/metrics", 200);
  const std::string notes = json{{"tags", {"wind"}}, {"note", "again"}}.dump();
  check("PUT", one + "/notes", run + "/notes", 200, notes, kJson);
  check("PUT", one + "/notes", run + "/notes", 400, "{}", kJson);
  check("PUT", one + "/notes", run + "/notes", 415, notes);
  check("PUT", one + "/notes", runs + "/none/notes", 404, notes, kJson);
  const std::string differences = "/api/v1/differences";
  check("GET", differences, differences + "?runs=" + id + "," + id, 200);
  check("GET", differences, differences + "?runs=" + id, 400);
  check("GET", differences, differences + "?runs=none," + id, 404);
  const std::string reported = "/api/v1/report";
  check("GET", reported, reported + "?runs=" + id, 200);
  check("GET", reported, reported + "?runs=" + id + "&alignment=sim4", 400);
  check("GET", reported, reported + "?runs=none", 404);
  check("GET", one + "/manifest", run + "/manifest", 200);
  EXPECT_EQ(check("GET", one + "/scenario", run + "/scenario", 200).json().at("name"), "tiny");
  const json statuses =
      check("GET", one + "/estimators", run + "/estimators", 200).json().at("estimators");
  EXPECT_EQ(statuses.at("perfect").at("state"), "TRACKING");
  EXPECT_EQ(statuses.at("perfect").at("answered"), 63);
  EXPECT_EQ(statuses.at("perfect").at("hash_mismatches"), 0);
  EXPECT_EQ(statuses.at("perfect").at("resources").at("measured"), "calling_thread");
  check("GET", one + "/sensors", run + "/sensors?from_s=0&to_s=1&points=100", 200);
  check("GET", one + "/sensors", run + "/sensors?points=1", 400);
  check("GET", one + "/sensors", runs + "/none/sensors", 404);
  const std::string trajectories = one + "/trajectories/{name}";
  const Answer tum = check("GET", trajectories, run + "/trajectories/truth", 200);
  EXPECT_GE(std::count(tum.body.begin(), tum.body.end(), '\n'), 62);
  const Answer columns = check("GET", trajectories, run + "/trajectories/truth?format=json", 200);
  EXPECT_EQ(columns.json().at("frame").size(), 63U);
  check("GET", trajectories, run + "/trajectories/perfect", 200);
  check("GET", trajectories, run + "/trajectories/perfect?format=json", 200);
  check("GET", trajectories, run + "/trajectories/none", 404);
  check("GET", trajectories, run + "/trajectories/truth?format=xml", 400);
  check("GET", trajectories, run + "/trajectories/truth?fromat=tum", 400);
  check("GET", trajectories, run + "/trajectories/perfect?format=json&alignment=sim3", 200);
  check("GET", trajectories, run + "/trajectories/perfect?format=json&alignment=sim4", 400);
  check("GET", trajectories, run + "/trajectories/perfect?alignment=sim3", 400);
  const std::string frames = one + "/frames/{file}";
  check("GET", frames + "/pixel", run + "/frames/17/pixel?x_px=3&y_px=4", 200);
  check("GET", frames + "/pixel", run + "/frames/17/pixel?x_px=-3&y_px=4", 400);
  check("GET", frames + "/pixel", run + "/frames/9999/pixel?x_px=3&y_px=4", 404);
  const Answer frame = check("GET", frames, run + "/frames/17.jpg", 200);
  const auto image = server::decode_jpeg(
      {reinterpret_cast<const std::uint8_t*>(frame.body.data()), frame.body.size()});
  ASSERT_TRUE(image);
  EXPECT_EQ(image->width_px, 64);
  for (const char* none :
       {"/frames/9999.jpg", "/frames/x.jpg", "/frames/1.png", "/frames/-1.jpg"}) {
    check("GET", frames, run + none, 404);
  }
  check("POST", one + "/cancel", run + "/cancel", 409);
  check("POST", one + "/cancel", runs + "/none/cancel", 404);
  check("DELETE", one, run, 204);
  check("DELETE", one, run, 404);
  for (const char* rest : {"", "/metrics", "/manifest", "/scenario", "/estimators"}) {
    check("GET", one + rest, run + rest, 404);
  }

  const std::string logs = "/api/v1/logs";
  const std::string log = logs + "/{name}";
  const std::string upload = logs + "/uploads%2Fa.bin";
  EXPECT_TRUE(check("GET", logs, logs, 200).json().at("logs").empty());
  const Answer taken = check("POST", logs, logs + "?name=a.bin", 201, northward_log());
  EXPECT_EQ(taken.headers.at("location"), upload);
  EXPECT_EQ(check("GET", logs, logs, 200).json().at("logs").at(0), taken.json());
  EXPECT_EQ(check("GET", log, upload, 200).json().at("truth").at("position"), "SIM");
  check("GET", log, upload + "?from_s=x", 400);
  check("GET", log, logs + "/none", 404);
  const std::string series = log + "/series";
  const Answer drawn = check("GET", series, upload + "/series?from_s=1.5&to_s=2&points=100", 200);
  EXPECT_EQ(drawn.json().at("positions").at("t_s").size(), 13U);
  check("GET", series, upload + "/series?points=7", 400);
  check("GET", series, logs + "/none/series", 404);
  const std::string residuals = log + "/residuals";
  check("GET", residuals, upload + "/residuals?from_s=1&to_s=2.9&points=100", 200);
  check("GET", residuals, upload + "/residuals?time_offset_s=3", 400);
  check("GET", residuals, upload + "/residuals?time_offset_s=auto", 422);
  check("GET", residuals, logs + "/none/residuals", 404);
  check("GET", "/api/v1/progress/{id}", "/api/v1/progress/none", 404);
  check("DELETE", log, upload, 204);
  check("DELETE", log, upload, 404);

  const std::string files = "/api/v1/trajectories";
  const std::string file = files + "/file:uploads%2Fa.tum";
  EXPECT_TRUE(check("GET", files, files, 200).json().at("trajectories").empty());
  const Answer kept = check("POST", files, files + "?name=a.tum", 201, "0 0 0 0 0 0 0 1\n");
  EXPECT_EQ(kept.headers.at("location"), file);
  check("POST", files, files + "?name=a.tum", 409, "0 0 0 0 0 0 0 1\n");
  check("POST", files, files + "?name=b.tum", 422, "0 0 0 0 0 0 0 2\n");
  EXPECT_EQ(check("GET", files, files, 200).json().at("trajectories").at(0), kept.json());
  check("GET", files + "/{name}/series", file + "/series?points=100", 200);
  check("GET", files + "/{name}/series", file + "/series?points=7", 400);
  check("GET", files + "/{name}/series", files + "/none/series", 404);
  const std::string evaluations = "/api/v1/evaluations";
  const json scored = {{"truth", "file:uploads/a.tum"}, {"estimates", {"file:uploads/a.tum"}}};
  check("POST", evaluations, evaluations, 200, scored.dump(), kJson);
  check("POST", evaluations, evaluations, 400, "{}", kJson);
  check("DELETE", files + "/{name}", file, 204);
  check("DELETE", files + "/{name}", file, 404);
  check("POST", evaluations, evaluations, 404, scored.dump(), kJson);

  check_calibrations();

  // Nothing is documented that was not asked for above.
  for (const auto& [path, operations] : api_.at("paths").items()) {
    for (const auto& [verb, operation] : operations.items()) {
      if (verb == "parameters") continue;
      EXPECT_TRUE(seen_.contains(verb + " " + path)) << verb << path;
    }
  }
}

}  // namespace
}  // namespace overfly::testing
