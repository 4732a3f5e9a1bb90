// Starting and checking sweeps: what is flown, and what is refused.
#include "tests/server/net/rest/sweep_routes_fixture.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <thread>
#include <vector>

#include "server/experiments/service/sweep_service.hpp"
#include "server/record/run_lock.hpp"

namespace overfly::testing {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::HasSubstr;

constexpr const char* kCheck = "/api/v1/sweep-check";

TEST_F(SweepRoutesTest, FliesASweepThatAClientStarts) {
  const Answer started = start("seeds");
  ASSERT_EQ(started.status, 201) << started.body;
  EXPECT_EQ(started.headers.at("location"), "/api/v1/sweeps/seeds");
  EXPECT_EQ(started.json().at("title"), "Three seeds");
  EXPECT_EQ(started.json().at("here"), "flying");
  EXPECT_EQ(started.json().at("flying"), true);
  const json sweep = ended("seeds");
  EXPECT_EQ(sweep.at("problem"), nullptr);
  EXPECT_EQ(sweep.at("progress").at("passed"), 3);
  EXPECT_EQ(sweep.at("progress").at("failed"), 0);
  EXPECT_EQ(sweep.at("flying"), false);
  EXPECT_TRUE(fs::exists(server_->folder() / "sweeps/seeds/summary.md"));
  const json state = ask(server_->port(), "GET", std::string(kSweepRoute) + "/seeds").json();
  EXPECT_EQ(state.at("table").at("rows").size(), 3U);
  EXPECT_EQ(lines("calls").size(), 3U);
}

TEST_F(SweepRoutesTest, DeletesASweepWithItsFlights) {
  const std::string route = std::string(kSweepRoute) + "/seeds";
  block();
  ASSERT_EQ(start("seeds").status, 201);
  wait_for_calls(1);
  const Answer flying = ask(server_->port(), "DELETE", route);
  EXPECT_EQ(flying.status, 409);
  EXPECT_THAT(flying.body, HasSubstr("cancel it"));
  EXPECT_EQ(post_to("seeds", "cancel").status, 202);
  unblock();
  (void)ended("seeds");
  EXPECT_EQ(post_to("seeds", "continue").status, 202);
  EXPECT_EQ(ended("seeds").at("progress").at("passed"), 3);
  const json table = ask(server_->port(), "GET", route).json().at("table");
  const std::string run = table.at("rows").at(0).at("runs").at(0);
  ASSERT_EQ(ask(server_->port(), "GET", "/api/v1/runs/" + run).status, 200);
  EXPECT_EQ(ask(server_->port(), "DELETE", route).status, 204);
  EXPECT_FALSE(fs::exists(server_->folder() / "sweeps/seeds"));
  EXPECT_EQ(ask(server_->port(), "GET", route).status, 404);
  EXPECT_EQ(ask(server_->port(), "GET", "/api/v1/runs/" + run).status, 404);
  EXPECT_EQ(ask(server_->port(), "DELETE", route).status, 404);
  EXPECT_EQ(start("seeds").status, 201) << "the name is free again";
  (void)ended("seeds");
}

TEST_F(SweepRoutesTest, LeavesNoFilesOfADeletedSweep) {
  const fs::path folder = server_->folder() / "sweeps";
  const auto entries = [&] { return std::distance(fs::directory_iterator(folder), {}); };
  ASSERT_EQ(start("seeds").status, 201);
  (void)ended("seeds");
  ASSERT_EQ(ask(server_->port(), "DELETE", std::string(kSweepRoute) + "/seeds").status, 204);
  for (int i = 0; i < 1000 && entries() > 0; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  EXPECT_EQ(entries(), 0);
  // What a server that was killed has left, the next one deletes.
  fs::create_directories(folder / ".deleted-night-1/runs/a");
  const server::experiments::SweepService next(server_->runs(), {});
  EXPECT_EQ(entries(), 0);
}

TEST_F(SweepRoutesTest, DeletesNothingElse) {
  const fs::path folder = server_->folder() / "sweeps";
  for (const char* name : {"notes", ".frame_cache"}) fs::create_directories(folder / name);
  write_text(folder / "notes/mine.txt", "not a sweep");
  write_text(folder / ".frame_cache/x", "");
  for (const char* name : {"notes", ".frame_cache", "nobody", "..", "%2e%2e", "a%2fb"}) {
    EXPECT_EQ(ask(server_->port(), "DELETE", std::string(kSweepRoute) + "/" + name).status, 404)
        << name;
  }
  EXPECT_TRUE(fs::exists(folder / "notes/mine.txt"));
  EXPECT_TRUE(fs::exists(folder / ".frame_cache/x"));
  ASSERT_EQ(start("seeds").status, 201);
  (void)ended("seeds");
  const auto lock = server::RunLock::take(folder / "seeds");
  ASSERT_TRUE(lock);
  EXPECT_EQ(ask(server_->port(), "DELETE", std::string(kSweepRoute) + "/seeds").status, 409)
      << "another process works on it";
  EXPECT_TRUE(fs::exists(folder / "seeds/sweep.json"));
  fs::create_directory_symlink(folder / "seeds", folder / "linked");
  EXPECT_EQ(ask(server_->port(), "DELETE", std::string(kSweepRoute) + "/linked").status, 409)
      << "the same through a link";
}

TEST_F(SweepRoutesTest, ConfinesTheProcessesOfItsFlights) {
  ASSERT_EQ(start("seeds").status, 201);
  (void)ended("seeds");
  const std::string call = lines("calls").front();
  const auto option = [&](const std::string& name, const std::string& folder) {
    return " " + name + " " + (server_->folder() / folder).string();
  };
  EXPECT_THAT(call, HasSubstr(option("--files-in", "world")));
  EXPECT_THAT(call, HasSubstr(option("--files-in", "uploads")));
  EXPECT_THAT(call, HasSubstr(option("--files-not-in", "runs")));
  EXPECT_THAT(call, HasSubstr(option("--files-not-in", "sweeps")));
}

TEST_F(SweepRoutesTest, RefusesNamesThatAreNotPlain) {
  const std::vector<std::string> names = {"",
                                          ".",
                                          "..",
                                          "../x",
                                          "a/b",
                                          "/tmp/x",
                                          ".x",
                                          "a.b",
                                          "_a",
                                          "-a",
                                          "a b",
                                          std::string(65, 'a'),
                                          std::string("a\0b", 3)};
  for (const std::string& name : names) {
    const Answer refused = start(name);
    EXPECT_EQ(refused.status, 400) << name;
    EXPECT_EQ(refused.json().at("error").at("faults").at(0).at("field"), "name") << refused.body;
  }
  EXPECT_FALSE(fs::exists(server_->folder() / "sweeps"));
}

TEST_F(SweepRoutesTest, NamesTheFieldsAtFault) {
  const auto fault = [&](const json& fields) {
    const Answer refused = start("x", fields);
    EXPECT_EQ(refused.status, 400) << refused.body;
    return refused.json().at("error").at("faults").at(0);
  };
  EXPECT_EQ(
      fault({{"axes", {{{"path", "seed"}, {"from", 1}, {"to", 0}, {"step", 1}}}}}).at("field"),
      "axes.0.to");
  EXPECT_EQ(fault({{"repeats", {{"most", 0}}}}).at("field"), "repeats.most");
  EXPECT_EQ(fault({{"scenario", "nobody"}}).at("field"), "scenario");
  EXPECT_EQ(fault({{"set", {{"camera.width_px", 3}}}}).at("field"), "camera.width_px")
      << "an error of all cells is none of the axis";
  EXPECT_THAT(fault({{"set", {{"camera.width_px", 3}}}}).at("message"),
              HasSubstr("camera.width_px = 3"));
  EXPECT_FALSE(fs::exists(server_->folder() / "sweeps/x"));
}

TEST_F(SweepRoutesTest, RefusesRequestsAtFault) {
  const auto status = [&](const json& body) { return post(kSweepRoute, body).status; };
  EXPECT_EQ(status({{"name", "x"}}), 400);
  EXPECT_EQ(status({{"document", document()}}), 400);
  EXPECT_EQ(status({{"name", "x"}, {"document", document()}, {"file", "quick"}}), 400);
  EXPECT_EQ(status({{"name", "x"}, {"document", document()}, {"jobs", 0}}), 400);
  EXPECT_EQ(status({{"name", "x"}, {"document", document()}, {"jobs", 1000000}}), 400);
  EXPECT_EQ(status({{"name", "x"}, {"document", document()}, {"out", "/tmp"}}), 400);
  EXPECT_EQ(status({{"name", "x"}, {"file", "nobody"}}), 404);
  EXPECT_EQ(status({{"name", "x"}, {"file", "../tiny"}}), 404);
  EXPECT_EQ(ask(server_->port(), "POST", kSweepRoute, "{}", {}).status, 415);
  EXPECT_EQ(ask(server_->port(), "POST", kSweepRoute, "{", kJson).status, 400);
  EXPECT_EQ(ask(server_->port(), "GET", "/api/v1/sweep-files/..%2ftiny").status, 404);
  EXPECT_FALSE(fs::exists(server_->folder() / "sweeps"));
}

TEST_F(SweepRoutesTest, RefusesFilesOutsideOfTheDataFolders) {
  const fs::path outside = own_.path() / "outside.json";
  fs::copy_file(server_->folder() / "scenarios/tiny.json", outside);
  fs::create_directories(server_->folder() / "sweeps/other");
  fs::copy_file(outside, server_->folder() / "sweeps/other/tiny.json");
  const auto refused = [&](const json& fields) {
    const Answer answer = start("x", fields);
    EXPECT_EQ(answer.status, 400) << fields << answer.body;
    return answer.json().at("error").at("message").get<std::string>();
  };
  const char* const kMust = "must be a file inside of the server's data folders";
  for (const std::string& file : {outside.string(),
                                  std::string("/etc/passwd"),
                                  std::string("/no/such.json"),
                                  std::string("../../../etc/passwd"),
                                  std::string("../../sweeps/other/tiny.json")}) {
    EXPECT_THAT(refused({{"scenario", file}}), HasSubstr(kMust)) << file;
  }
  EXPECT_THAT(refused({{"set", {{"world.imagery.0.file", "/etc/passwd"}}}}), HasSubstr(kMust));
  EXPECT_THAT(
      refused(
          {{"axes",
            {{{"path", "world.imagery.0.file"}, {"values", {"/etc/passwd", "/no/such.tif"}}}}}}),
      HasSubstr(kMust));
  EXPECT_EQ(start("x", {{"scenario", "../tiny.json"}}).status, 201)
      << "next to the folder of sweep files";
  (void)ended("x");
}

TEST_F(SweepRoutesTest, RefusesCommandsButThoseOfTheOwner) {
  const json estimators =
      json::array({{{"name", "perfect"}, {"type", "process"}, {"command", {"/bin/true"}}}});
  const json fields = {{"estimators", estimators}};
  const Answer refused = start("x", fields);
  EXPECT_EQ(refused.status, 403) << refused.body;
  EXPECT_EQ(refused.json().at("error").at("code"), "forbidden");
  EXPECT_FALSE(fs::exists(server_->folder() / "sweeps/x"));
  // As the owner wrote it, it may be flown by its name, as a document, and continued.
  json owned = document(fields);
  owned["scenario"] = "../tiny.json";
  write_text(sweep_files() / "own.json", owned.dump());
  ASSERT_EQ(post(kSweepRoute, {{"name", "by_name"}, {"file", "own"}}).status, 201);
  (void)ended("by_name");
  ASSERT_EQ(start("as_document", fields).status, 201);
  (void)ended("as_document");
  ASSERT_EQ(post_to("by_name", "continue").status, 202);
  (void)ended("by_name");
  json changed = fields;
  changed["estimators"][0]["command"][0] = "/bin/false";
  EXPECT_EQ(start("y", changed).status, 403);
  // What a sweep's folder says is not trusted either.
  json recorded = json::parse(read_text(server_->folder() / "sweeps/by_name/sweep.json"));
  recorded["estimators"][0]["command"][0] = "/bin/false";
  write_text(server_->folder() / "sweeps/by_name/sweep.json", recorded.dump());
  EXPECT_EQ(post_to("by_name", "continue").status, 403);
}

/// Otherwise a sweep would open the link of an owner's scenario without --allow-link.
TEST_F(SweepRoutesTest, RefusesLiveFlights) {
  json live = json::parse(read_text(server_->folder() / "scenarios/tiny.json"));
  live["flight"] = {{"mavlink", {{"link", "tcp:127.0.0.1:1"}, {"patience_s", 0.1}}}};
  write_text(server_->folder() / "scenarios/live.json", live.dump());
  const Answer refused = start("x", {{"scenario", "live"}});
  EXPECT_EQ(refused.status, 400) << refused.body;
  EXPECT_THAT(refused.body, HasSubstr("flight: must not be live in a sweep"));
  write_text(sweep_files() / "own.json", document({{"scenario", "../live.json"}}).dump());
  EXPECT_EQ(post(kSweepRoute, {{"name", "x"}, {"file", "own"}}).status, 400);
  EXPECT_TRUE(lines("calls").empty());
}

TEST_F(SweepRoutesTest, RefusesFlightsThatNeedTooMuchMemory) {
  json cameras = json::array();
  for (int i = 0; i < 8; ++i) {
    cameras.push_back({{"name", "c" + std::to_string(i)}, {"width_px", 8192}, {"height_px", 8192}});
  }
  server::RunManagerOptions small;
  small.memory_limit_bytes = std::uint64_t{512} << 20U;
  TestServer server(net::ServerOptions(), small);
  const json wanted = document({{"set", {{"cameras", cameras}}}});
  const Answer refused = ask(
      server.port(), "POST", kSweepRoute, json{{"name", "x"}, {"document", wanted}}.dump(), kJson);
  EXPECT_EQ(refused.status, 422) << refused.body;
  EXPECT_EQ(refused.json().at("error").at("code"), "not_enough_memory");
}

TEST_F(SweepRoutesTest, ChecksADocumentAndShowsTheCost) {
  const Answer cost = post(kCheck, {{"document", document({{"repeats", {{"most", 4}}}})}});
  ASSERT_EQ(cost.status, 200) << cost.body;
  EXPECT_EQ(cost.json().at("valid"), true);
  EXPECT_EQ(cost.json().at("cells"), 3);
  EXPECT_EQ(cost.json().at("estimators"), 1);
  EXPECT_EQ(cost.json().at("flights"), 12);
  EXPECT_EQ(cost.json().at("flight_s"), nullptr) << "nothing like it has flown";
  ASSERT_EQ(start("seeds").status, 201);
  (void)ended("seeds");
  const json known = post(kCheck, {{"document", document({{"repeats", {{"most", 4}}}})}}).json();
  EXPECT_GT(known.at("flight_s").get<double>(), 0.0);
  const json other = post(kCheck, {{"document", document({{"set", {{"duration_s", 1}}}})}}).json();
  EXPECT_EQ(other.at("flight_s"), nullptr) << "other flights";
  const json invalid = post(kCheck, {{"document", document({{"repeats", {{"most", 0}}}})}}).json();
  EXPECT_EQ(invalid.at("valid"), false);
  EXPECT_EQ(invalid.at("faults").at(0).at("field"), "repeats.most");
  EXPECT_FALSE(fs::exists(server_->folder() / "sweeps/x"));
}

/// They share threads with what other viewers read.
TEST_F(SweepRoutesTest, ChecksFewSweepsAtATime) {
  const json large = document({{"axes",
                                {{{"path", "seed"}, {"from", 1}, {"to", 100}, {"step", 1}},
                                 {{"path", "start_s"}, {"from", 0}, {"to", 3.6}, {"step", 0.4}}}}});
  std::vector<int> statuses(8);
  std::vector<std::thread> clients;
  for (int& status : statuses) {
    clients.emplace_back([&] { status = post(kCheck, {{"document", large}}).status; });
  }
  for (std::thread& client : clients) client.join();
  const auto checked = std::count(statuses.begin(), statuses.end(), 200);
  EXPECT_GE(checked, 2);
  EXPECT_EQ(checked + std::count(statuses.begin(), statuses.end(), 503), 8);
  EXPECT_GT(std::count(statuses.begin(), statuses.end(), 503), 0);
  EXPECT_EQ(post(kCheck, {{"document", document()}}).status, 200) << "places are free again";
}

TEST_F(SweepRoutesTest, ListsTheSweepFilesOfTheServer) {
  write_text(sweep_files() / "good.json",
             document({{"scenario", "../tiny.json"}, {"description", "Words"}}).dump());
  write_text(sweep_files() / "bad.json", "{}");
  const json list = ask(server_->port(), "GET", "/api/v1/sweep-files").json();
  ASSERT_EQ(list.at("files").size(), 2U);
  EXPECT_EQ(list.at("files").at(0).at("name"), "bad");
  EXPECT_THAT(list.at("files").at(0).at("error").get<std::string>(), HasSubstr("scenario"));
  EXPECT_EQ(list.at("files").at(1),
            (json{{"name", "good"},
                  {"title", "Three seeds"},
                  {"description", "Words"},
                  {"error", nullptr}}));
  EXPECT_GE(list.at("jobs").at("most"), list.at("jobs").at("default"));
  const json good = ask(server_->port(), "GET", "/api/v1/sweep-files/good").json();
  EXPECT_EQ(good.at("scenario"), "../tiny.json");
}

}  // namespace
}  // namespace overfly::testing
