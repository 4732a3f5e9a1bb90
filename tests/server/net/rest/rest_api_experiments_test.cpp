// The routes of sweeps, studies and calibrations, for the test of all routes.
#include <filesystem>
#include <string>
#include <thread>

#include "server/files/jpeg.hpp"
#include "tests/server/calibration/board_fixture.hpp"
#include "tests/server/net/rest/rest_api_fixture.hpp"

namespace overfly::testing {

using nlohmann::json;

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
  const auto wait_for_its_end = [&] {
    for (int turns = 0; turns < 1000 && flies(); ++turns) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
  };
  wait_for_its_end();
  check("POST", go_on, all + "/own/continue", 202, "{}", kJson);
  wait_for_its_end();
  check("DELETE", all + "/{name}", all + "/own", 204);
  check("DELETE", all + "/{name}", all + "/own", 404);
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

}  // namespace overfly::testing
