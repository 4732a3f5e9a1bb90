// Every route, its answers checked against the OpenAPI file that the server serves.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/files/jpeg.hpp"
#include "server/scenario/document/scenario_schema.hpp"
#include "tests/flight/logs/northward_log.hpp"
#include "tests/server/net/rest/rest_api_fixture.hpp"

namespace overfly::testing {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

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
