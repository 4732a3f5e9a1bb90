// Launching, listing and deleting runs when there is too much of everything.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "server/files/whole_file.hpp"
#include "server/record/run_folder.hpp"
#include "tests/server/net/test_client.hpp"
#include "tests/server/net/test_server.hpp"

namespace overfly::testing {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::HasSubstr;

constexpr const char* kRuns = "/api/v1/runs";

Answer launch(const TestServer& server, const json& body) {
  return ask(server.port(), "POST", kRuns, body.dump(), kJson);
}

TEST(RunRoutes, FullQueueIsToldApart) {
  server::RunManagerOptions options;
  options.max_waiting_runs = 2;
  TestServer server(net::ServerOptions(), options);
  const std::string first = server.start("slow");
  // Until it has left the queue.
  const auto timeline = server.runs().timeline(first).value();
  for (std::uint64_t seen = 0; timeline->frame_count() == 0;) {
    seen = timeline->wait_for_change(seen, 1000);
  }
  const Answer waiting = launch(server, {{"scenario", "tiny"}, {"overrides", {{"seed", 7}}}});
  EXPECT_EQ(waiting.status, 201);
  EXPECT_EQ(waiting.json().at("seed"), 7) << "before it flies";
  EXPECT_EQ(launch(server, {{"scenario", "tiny"}}).status, 201);
  const Answer refused = launch(server, {{"scenario", "tiny"}});
  EXPECT_EQ(refused.status, 429);
  EXPECT_EQ(refused.json().at("error").at("code"), "queue_full");
  EXPECT_THAT(refused.body, HasSubstr("waiting runs = 2"));
  EXPECT_EQ(ask(server.port(), "GET", kRuns).json().at("runs").size(), 3U);
}

TEST(RunRoutes, TellsWhatAPixelShows) {
  TestServer server;
  const std::string id = server.fly("tiny");
  const auto look = [&](const std::string& frame, const std::string& query) {
    const std::string place = std::string(kRuns) + "/" + id + "/frames/" + frame + "/pixel";
    return ask(server.port(), "GET", place + query);
  };
  const Answer seen = look("7", "?x_px=10.5&y_px=20&picture=error/perfect");
  ASSERT_EQ(seen.status, 200) << seen.body;
  const json pixel = seen.json();
  EXPECT_EQ(pixel.at("frame"), 7);
  EXPECT_EQ(pixel.at("width_px"), 64);
  EXPECT_GE(pixel.at("grey"), 0);
  EXPECT_TRUE(pixel.at("rgb").is_null());
  EXPECT_EQ(pixel.at("difference"), 0) << "the estimate is perfect";
  EXPECT_GT(pixel.at("range_m"), pixel.at("depth_m"));
  EXPECT_GT(pixel.at("ground").at("lat_deg"), -90.0);
  EXPECT_EQ(look("7", "?x_px=10").status, 400);
  EXPECT_EQ(look("7", "?x_px=64&y_px=1").status, 400);
  EXPECT_EQ(look("7", "?x_px=nan&y_px=1").status, 400);
  EXPECT_EQ(look("7", "?x_px=1&y_px=1&picture=scene").status, 400);
  EXPECT_EQ(look("7", "?x_px=1&y_px=1&picture=error/nobody").status, 404);
  EXPECT_EQ(look("7", "?x_px=1&y_px=1&camera=nobody").status, 404);
  EXPECT_EQ(look("99999", "?x_px=1&y_px=1").status, 404);
  EXPECT_EQ(look("x", "?x_px=1&y_px=1").status, 404);
}

TEST(RunRoutes, KeepsTagsAndNoteOfARun) {
  TestServer server;
  const std::string run = std::string(kRuns) + "/" + server.fly("tiny");
  const json notes = {{"tags", {"baseline", "wind"}}, {"note", "Two\nlines"}};
  const auto put = [&](const json& body) {
    return ask(server.port(), "PUT", run + "/notes", body.dump(), kJson);
  };
  const Answer kept = put(notes);
  ASSERT_EQ(kept.status, 200) << kept.body;
  EXPECT_EQ(kept.json().at("tags"), notes.at("tags"));
  const json listed = ask(server.port(), "GET", kRuns).json().at("runs").at(0);
  EXPECT_EQ(listed.at("note"), "Two\nlines");
  EXPECT_EQ(listed.at("results").at(0).at("outcome"), "COMPLETED");
  EXPECT_LT(listed.at("results").at(0).at("position_rmse_m"), 1e-3);
  EXPECT_THAT(put({{"tags", {"a,b"}}, {"note", ""}}).body, HasSubstr("tags.0: must have no comma"));
  EXPECT_THAT(put({{"tags", {1}}, {"note", ""}}).body, HasSubstr("tags.0"));
  EXPECT_EQ(put({{"tags", {1}}, {"note", ""}}).status, 400);
  EXPECT_EQ(put({{"tags", json::array()}}).status, 400);
  EXPECT_EQ(put({{"tags", json::array()}, {"note", ""}, {"x", 1}}).status, 400);
  EXPECT_EQ(ask(server.port(), "GET", run).json().at("tags"), notes.at("tags")) << "as before";
  EXPECT_EQ(
      ask(server.port(), "PUT", std::string(kRuns) + "/nobody/notes", notes.dump(), kJson).status,
      404);
}

TEST(RunRoutes, ShowsWhatDiffersBetweenRuns) {
  TestServer server;
  const std::string a = server.fly("tiny");
  const Answer again = launch(server, {{"scenario", "tiny"}, {"overrides", {{"seed", 77}}}});
  ASSERT_EQ(again.status, 201) << again.body;
  const std::string b = again.json().at("id");
  server.wait_for_end(b);
  const auto ask_for = [&](const std::string& ids) {
    return ask(server.port(), "GET", "/api/v1/differences?runs=" + ids);
  };
  const Answer answer = ask_for(a + "," + b);
  ASSERT_EQ(answer.status, 200) << answer.body;
  const json differences = answer.json();
  EXPECT_EQ(differences.at("runs"), json({a, b}));
  EXPECT_EQ(differences.at("left_out"), 0);
  bool found = false;
  for (const json& field : differences.at("fields")) {
    if (field.at("field") != "scenario.seed") continue;
    found = true;
    EXPECT_EQ(field.at("values").at(1), "77");
  }
  EXPECT_TRUE(found) << answer.body;
  EXPECT_TRUE(ask_for(a + "," + a).json().at("fields").empty());
  EXPECT_EQ(ask_for(a).status, 400);
  EXPECT_EQ(ask_for("").status, 400);
  EXPECT_EQ(ask_for(a + ",").status, 400);
  EXPECT_EQ(ask_for(a + ",nobody").status, 404);
  EXPECT_EQ(ask_for(a + ",..%2f..%2fetc").status, 404);
  // A default in place of an invalid field would be compared.
  const fs::path file = server::manifest_file(server.folder() / "runs" / b);
  json manifest = server::read_json(file).value();
  manifest["seed"] = "many";
  ASSERT_TRUE(server::write_json(file, manifest).ok());
  const Answer refused = ask_for(a + "," + b);
  EXPECT_EQ(refused.status, 422) << refused.body;
  EXPECT_THAT(refused.body, HasSubstr("seed"));
  std::string many = a;
  for (int i = 0; i < 16; ++i) many += "," + a;
  EXPECT_EQ(ask_for(many).status, 400);
}

TEST(RunRoutes, RunBeyondTheMemoryIsRefusedWithFieldValueAndLimit) {
  server::RunManagerOptions options;
  options.memory_limit_bytes = std::uint64_t{512} << 20U;
  TestServer server(net::ServerOptions(), options);
  json cameras = json::array();
  for (const char* name : {"c0", "c1", "c2", "c3", "c4", "c5", "c6", "c7"}) {
    cameras.push_back({{"name", name}, {"width_px", 8192}, {"height_px", 8192}, {"color", "rgb"}});
  }
  const Answer refused =
      launch(server, {{"scenario", "tiny"}, {"overrides", {{"cameras", cameras}}}});
  EXPECT_EQ(refused.status, 422) << refused.body;
  EXPECT_EQ(refused.json().at("error").at("code"), "not_enough_memory");
  EXPECT_THAT(refused.body, HasSubstr("cameras = 8 of up to 8192 x 8192 px in colour"));
  EXPECT_THAT(refused.body, HasSubstr("512 MiB"));
  EXPECT_EQ(launch(server, {{"scenario", "tiny"}}).status, 201);
}

TEST(RunRoutes, OfSixDeletionsAtATimeOneSucceeds) {
  TestServer server;
  const std::string run = std::string(kRuns) + "/" + server.fly("tiny");
  std::vector<int> statuses(6);
  std::vector<std::thread> clients;
  for (int& status : statuses) {
    clients.emplace_back([&] { status = ask(server.port(), "DELETE", run).status; });
  }
  for (std::thread& client : clients) client.join();
  int deleted = 0;
  for (const int status : statuses) {
    EXPECT_TRUE(status == 204 || status == 404 || status == 409) << status;
    deleted += status == 204 ? 1 : 0;
  }
  EXPECT_EQ(deleted, 1);
}

TEST(RunRoutes, DamagedRunIsListedWithItsProblem) {
  TestServer server;
  const std::string id = server.fly("tiny");
  const fs::path folder = server.folder() / "runs" / id;
  json created = server::read_json(server::created_file(folder)).value();
  created["created_utc"] = nullptr;
  ASSERT_TRUE(server::write_json(server::created_file(folder), created).ok());
  fs::last_write_time(server::manifest_file(folder), fs::file_time_type::clock::now());
  const auto listed = [&] { return ask(server.port(), "GET", kRuns).json().at("runs").at(0); };
  json run = listed();
  // The thread that flew the run may hold what it knows of it for a moment longer.
  for (int i = 0; i < 3000 && run.at("problem").is_null(); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    run = listed();
  }
  EXPECT_THAT(run.at("problem").get<std::string>(), HasSubstr("created.json: created_utc = null"));
  EXPECT_EQ(run.at("status"), "completed");
  write_text(server::manifest_file(folder), "{\"format_version\": ");
  const json damaged = ask(server.port(), "GET", std::string(kRuns) + "/" + id).json();
  EXPECT_EQ(damaged.at("status"), "unreadable");
  EXPECT_EQ(ask(server.port(), "GET", "/api/v1/health").status, 200);
}

/// Damage in rows is found when they are read.
TEST(RunRoutes, DamagedRowsAreTheRunsProblemAndNoFailureOfTheServer) {
  TestServer server;
  const fs::path runs = server.folder() / "runs";
  fs::copy(runs / server.fly("tiny"), runs / "damaged", fs::copy_options::recursive);
  const fs::path rows = server::CameraFiles::of_main_camera(runs / "damaged").rows();
  const std::string whole = read_text(rows);
  std::string changed = whole;
  changed.replace(changed.find("\"frame\":5"), 9, "\"frame\":\"x\"");
  write_text(rows, changed);
  const std::string run = std::string(kRuns) + "/damaged";
  for (const char* part :
       {"/metrics", "/estimators", "/trajectories/truth?format=json", "/frames/3.jpg"}) {
    const Answer refused = ask(server.port(), "GET", run + part);
    EXPECT_EQ(refused.status, 422) << part;
    EXPECT_EQ(refused.json().at("error").at("code"), "unreadable");
  }
  const auto shown = [&] { return ask(server.port(), "GET", run).json(); };
  EXPECT_THAT(shown().at("problem").get<std::string>(), HasSubstr("frames.jsonl"));
  EXPECT_EQ(shown().at("status"), "completed");
  write_text(rows, whole);
  EXPECT_EQ(ask(server.port(), "GET", run + "/metrics").status, 200);
  EXPECT_TRUE(shown().at("problem").is_null());
  write_text(server::metrics_file(runs / "damaged"), "{");
  const Answer metrics = ask(server.port(), "GET", run + "/metrics");
  EXPECT_EQ(metrics.status, 422);
  EXPECT_THAT(metrics.body, HasSubstr("metrics.json, line 1"));
}

TEST(RunRoutes, FailureOfTheServerIsLogged) {
  TestServer server;
  const std::string run = std::string(kRuns) + "/" + server.fly("tiny");
  fs::create_directories(server.folder() / "runs" / run.substr(run.rfind('/') + 1) / "notes.json");
  const json notes = {{"tags", json::array()}, {"note", "cannot be kept"}};
  EXPECT_EQ(ask(server.port(), "PUT", run + "/notes", notes.dump(), kJson).status, 500);
  server.wait_for_log("PUT " + run + "/notes failed: ");
}

TEST(RunRoutes, ViewersOfADeletedRunAreTold) {
  TestServer server;
  const std::string id = server.fly("tiny");
  WebSocketClient viewer(server.port());
  EXPECT_EQ(viewer.command({{"type", "watch"}, {"run", id}}).at("type"), "ok");
  viewer.wait_for("run");
  EXPECT_EQ(ask(server.port(), "DELETE", std::string(kRuns) + "/" + id).status, 204);
  const json told = viewer.wait_until([](const json& message) {
    return message.at("type") == "run" && message.at("run").at("problem") == "the run was deleted";
  });
  EXPECT_EQ(told.at("run").at("id"), id);
}

/// Metrics that `overfly evaluate` has written are served, and viewers are notified.
TEST(RunRoutes, NewMetricsAreServedAndSentToViewers) {
  TestServer server;
  const std::string id = server.fly("tiny");
  WebSocketClient viewer(server.port());
  viewer.send({{"type", "watch"}, {"run", id}});
  json metrics = viewer.wait_for("metrics").at("metrics");
  metrics["flight"]["path_length_m"] = 1.5;
  const fs::path folder = server.folder() / "runs" / id;
  ASSERT_TRUE(server::write_json(server::metrics_file(folder), metrics).ok());
  EXPECT_EQ(viewer.wait_for("metrics").at("metrics"), metrics);
  EXPECT_EQ(ask(server.port(), "GET", std::string(kRuns) + "/" + id + "/metrics").json(), metrics);
}

}  // namespace
}  // namespace overfly::testing
