// Starting, following, cancelling, continuing and deleting studies, and what they are refused for.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/types.h>

#include <csignal>

#include "server/experiments/studies/study_service.hpp"
#include "tests/server/net/rest/study_routes_fixture.hpp"

namespace overfly::testing {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

TEST_F(StudyRoutesTest, ExplainsARunAndShowsItsFlights) {
  const std::string name = started(explain({{"flights", 5}, {"causes", {"blur", "noise"}}}));
  const json done = wait_for(name, "done");
  EXPECT_EQ(done.at("kind"), "explain");
  EXPECT_EQ(done.at("subject"), run_);
  EXPECT_EQ(done.at("estimator"), "perfect");
  EXPECT_TRUE(done.at("problem").is_null());
  EXPECT_TRUE(done.at("ended_utc").is_string());
  const std::string run = (server_->folder() / "runs" / run_).string();
  ASSERT_EQ(lines("calls").size(), 1U);
  EXPECT_THAT(lines("calls").front(),
              AllOf(HasSubstr("explain " + run + " --estimator perfect --causes blur,noise"),
                    HasSubstr("--flights 5"),
                    HasSubstr("--files-in " + (server_->folder() / "world").string()),
                    HasSubstr("--files-in " + run),
                    HasSubstr("--files-not-in " + (server_->folder() / "studies").string()),
                    Not(HasSubstr("--files-not-in " + (server_->folder() / "runs").string()))));
  const json result = shown(name).at("result");
  const std::string flight = name + "." + kFlight;
  EXPECT_EQ(result.at("flights").at(0).at("run"), flight);
  EXPECT_EQ(result.at("words").at("blur"), "the blur of the images");
  const std::string shown_run = "/api/v1/runs/" + flight;
  EXPECT_EQ(get(shown_run).json().at("id"), flight);
  EXPECT_THAT(get("/api/v1/runs").body, Not(HasSubstr(flight))) << "not listed";
  EXPECT_EQ(ask(server_->port(), "DELETE", shown_run).status, 409);
}

TEST_F(StudyRoutesTest, ServesThePageWithoutScriptsAndOrigin) {
  const std::string name = started({{"kind", "predict"},
                                    {"scenario", "tiny"},
                                    {"overrides", {{"flight.course.height_agl_m", 70}}},
                                    {"rate_hz", 4},
                                    {"map", false}});
  const std::string route = std::string(kRoute) + "/" + name;
  (void)wait_for(name, "done");
  EXPECT_THAT(lines("calls").front(),
              AllOf(HasSubstr("predict " + (folder(name) / "input/scenario.json").string()),
                    HasSubstr("--rate 4 --no-map"),
                    Not(HasSubstr("--files-in " + (server_->folder() / "runs").string()))));
  const json input = json::parse(read_text(folder(name) / "input/scenario.json"));
  EXPECT_EQ(input.at("flight").at("course").at("height_agl_m"), 70);
  const Answer page = get(route + "/page");
  ASSERT_EQ(page.status, 200);
  EXPECT_EQ(page.body, "<h1>Risk</h1>\n");
  EXPECT_THAT(
      page.headers.at("content-security-policy"),
      AllOf(HasSubstr("sandbox;"), HasSubstr("default-src 'none'"), Not(HasSubstr("allow"))));
  const json result = shown(name).at("result");
  EXPECT_FALSE(result.at("instants").at(0).contains("features"));
  EXPECT_FALSE(result.at("map").contains("risk_10_s"));
  EXPECT_EQ(get(route + "/worst").status, 404) << "a prediction has none";
}

TEST_F(StudyRoutesTest, HuntsWithinLimitsAndGivesTheWorstFlight) {
  const std::string name = started(hunt({{"flights", 9}, {"all", true}, {"seed", 3}}));
  (void)wait_for(name, "done");
  EXPECT_THAT(
      lines("calls").front(),
      HasSubstr("hunt " + (folder(name) / "input/hunt.json").string() + " --estimator perfect"));
  const json document = json::parse(read_text(folder(name) / "input/hunt.json"));
  EXPECT_EQ(document.at("most_flights"), 9);
  EXPECT_EQ(document.at("until"), "flights");
  EXPECT_EQ(document.at("seed"), 3);
  EXPECT_EQ(document.at("axes").at(0).at("to"), 80);
  const json result = shown(name).at("result");
  EXPECT_FALSE(result.contains("scenario")) << "names a folder of this machine";
  EXPECT_EQ(get(std::string(kRoute) + "/" + name + "/worst").json().at("seed"), 7);
  EXPECT_EQ(get(std::string(kRoute) + "/" + name + "/page").status, 404);
}

TEST_F(StudyRoutesTest, MakesOneAtATimeAndCancels) {
  put("block");
  const std::string first = started(explain());
  const std::string second = started(explain());
  const std::string third = started(hunt());
  wait_for_processes(1);
  const json made = wait_for(first, "running");
  EXPECT_EQ(entry(second).at("state"), "waiting");
  EXPECT_EQ(entry(second).at("position"), 1);
  EXPECT_EQ(entry(third).at("position"), 2);
  EXPECT_EQ(act(second, "continue").status, 409);
  EXPECT_EQ(ask(server_->port(), "DELETE", std::string(kRoute) + "/" + first).status, 409);
  ASSERT_EQ(act(second, "cancel").status, 202);
  EXPECT_EQ(entry(second).at("state"), "cancelled");
  EXPECT_EQ(entry(third).at("position"), 1);
  for (int i = 0; i < 500 && entry(first).at("progress").at("share") == 0.0; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  EXPECT_EQ(entry(first).at("progress").at("text"), "3 of at most 6 flights");
  const pid_t process = std::stoi(lines("made").front());
  take_away("block");
  ASSERT_EQ(act(first, "cancel").status, 202);
  EXPECT_TRUE(wait_for(first, "cancelled").at("problem").is_null()) << "cancelling is no failure";
  EXPECT_NE(::kill(process, 0), 0) << "its process has ended";
  EXPECT_EQ(act(first, "cancel").status, 409);
  (void)wait_for(third, "done");
  EXPECT_EQ(lines("made").size(), 2U) << "the cancelled one was never begun";
  const json list = get(kRoute).json();
  ASSERT_EQ(list.at("studies").size(), 3U);
  EXPECT_EQ(list.at("limits").at("explain").at("flights").at("most"), 60);
}

TEST_F(StudyRoutesTest, SaysWhyOneFailedAndMakesItAgain) {
  put("fail");
  const std::string name = started(explain());
  EXPECT_EQ(wait_for(name, "failed").at("problem"), "the disk is full");
  EXPECT_THAT(server_->log(), HasSubstr("study " + name + ": the disk is full"));
  take_away("fail");
  ASSERT_EQ(act(name, "continue").status, 202);
  EXPECT_TRUE(wait_for(name, "done").at("problem").is_null());
  EXPECT_EQ(lines("calls").at(0), lines("calls").at(1)) << "the same command";
}

TEST_F(StudyRoutesTest, AKilledProcessOrServerLeavesAClearState) {
  put("block");
  const std::string name = started(hunt());
  wait_for_processes(1);
  ::kill(std::stoi(lines("made").front()), SIGKILL);
  EXPECT_THAT(wait_for(name, "failed").at("problem").get<std::string>(), HasSubstr("signal 9"));
  take_away("block");
  // A server that was killed has written no end.
  fs::remove(folder(name) / "state.json");
  EXPECT_EQ(entry(name).at("state"), "interrupted");
  EXPECT_THAT(entry(name).at("problem").get<std::string>(), HasSubstr("server"));
  ASSERT_EQ(act(name, "continue").status, 202);
  (void)wait_for(name, "done");
}

TEST_F(StudyRoutesTest, EndsWithTheServer) {
  put("block");
  const std::string made = started(explain());
  const std::string waits = started(explain());
  wait_for_processes(1);
  const pid_t process = std::stoi(lines("made").front());
  const fs::path kept = own_.path() / "kept";
  server::experiments::StudyService reader(server_->runs(), {});
  // Two services share the folder as two servers would: this one only reads.
  EXPECT_EQ(reader.entry(made).value().at("state"), "interrupted") << "not made by this one";
  const auto before = std::chrono::steady_clock::now();
  fs::copy(server_->folder() / "studies", kept, fs::copy_options::recursive);
  server_.reset();
  EXPECT_LT(std::chrono::steady_clock::now() - before, std::chrono::seconds(10));
  EXPECT_NE(::kill(process, 0), 0);
  EXPECT_EQ(lines("made").size(), 1U) << "the waiting one was not begun";
}

TEST_F(StudyRoutesTest, DeletesAStudyWithItsFlights) {
  const std::string name = started(explain());
  (void)wait_for(name, "done");
  const std::string route = std::string(kRoute) + "/" + name;
  EXPECT_EQ(ask(server_->port(), "DELETE", route).status, 204);
  EXPECT_FALSE(fs::exists(folder(name)));
  EXPECT_EQ(get(route).status, 404);
  EXPECT_EQ(get("/api/v1/runs/" + name + "." + kFlight).status, 404);
  EXPECT_EQ(ask(server_->port(), "DELETE", route).status, 404);
}

TEST_F(StudyRoutesTest, NamesTheFieldThatIsAtFault) {
  const json many(std::vector<json>(7, {{"path", "seed"}, {"from", 1}, {"to", 2}}));
  const auto axis = [](const json& fields) {
    json one = {{"path", "flight.course.height_agl_m"}, {"from", 50}, {"to", 80}};
    one.update(fields);
    return json{{"axes", json::array({one})}};
  };
  const std::vector<std::pair<json, std::string>> cases = {
      {json::object(), "kind"},
      {{{"kind", "shell"}}, "kind = shell: must be explain, predict or hunt"},
      {{{"kind", "explain"}}, "run: is required"},
      {explain({{"flights", 0}}), "flights = 0: must be"},
      {explain({{"flights", 61}}), "flights = 61: must be"},
      {explain({{"flights", "5"}}), "flights"},
      {explain({{"jobs", 100000}}), "jobs = 100000: must be"},
      {explain({{"out", "/tmp/x"}}), "out: is not a known field"},
      {explain({{"causes", {"gremlins"}}}), "causes = gremlins: must be one of faults"},
      {explain({{"causes", {1}}}), "causes: must be texts"},
      {explain({{"estimator", "--out=/tmp"}}), "estimator = --out=/tmp: must be one of perfect"},
      {{{"kind", "predict"}, {"scenario", "tiny"}, {"rate_hz", 11}}, "rate_hz = 11: must be"},
      {{{"kind", "predict"}, {"scenario", "tiny"}, {"camera", "none"}}, "camera = none: must be"},
      {{{"kind", "predict"}, {"scenario", "tiny"}, {"document", json::object()}}, "scenario"},
      {{{"kind", "predict"}, {"scenario", "broken"}}, "camera.width_px = 3: must be"},
      {hunt({{"axes", json::array()}}), "axes: must have 1 to 6"},
      {hunt({{"axes", many}}), "axes: must have 1 to 6"},
      {hunt({{"axes", {1}}}), "axes.0: must be an object"},
      {hunt(axis({{"to", 50}})), "axes.0.to: must be greater than from"},
      {hunt(axis({{"to", 1e13}})), "axes.0.to"},
      {hunt(axis({{"values", {1, 2}}})), "axes.0.values: is not a known field"},
      {hunt(axis({{"path", ""}})), "axes.0.path"},
      {hunt(axis({{"path", "estimators.0.command"}})), "estimators.0"},
      {hunt(axis({{"from", -50}})), "flight.course.height_agl_m = 15.0: must be in [20, 3000]"},
      {hunt({{"flights", 2}, {"repeats", 3}}), "flights: must be at least repeats = 3"},
      {hunt({{"estimator", "none"}}), "estimator = none: must be one of perfect"},
  };
  for (const auto& [request, text] : cases) {
    const Answer answer = start(request);
    EXPECT_EQ(answer.status, 400) << request << answer.body;
    EXPECT_THAT(answer.body, HasSubstr(text)) << request;
    EXPECT_THAT(answer.body, Not(HasSubstr("scenario.json"))) << "a file of this machine";
  }
  EXPECT_EQ(ask(server_->port(), "POST", kRoute, "{", kJson).status, 400);
  EXPECT_EQ(ask(server_->port(), "POST", kRoute, "{}", {}).status, 415);
  EXPECT_EQ(lines("calls").size(), 0U);
  EXPECT_TRUE(get(kRoute).json().at("studies").empty()) << "nothing is left of them";
  EXPECT_TRUE(fs::is_empty(server_->folder() / "studies"));
}

TEST_F(StudyRoutesTest, ReachesNothingOutside) {
  for (const char* run : {"nobody", "..", "../runs", "/etc", "a/b", ""}) {
    EXPECT_EQ(start(explain({{"run", run}})).status, 404) << run;
  }
  EXPECT_EQ(start({{"kind", "predict"}, {"scenario", "../../etc/passwd"}}).status, 404);
  for (const char* name : {"nobody", "..", "%2e%2e", "a%2fb", ".deleted-x"}) {
    const std::string route = std::string(kRoute) + "/" + name;
    EXPECT_EQ(get(route).status, 404) << name;
    EXPECT_EQ(get(route + "/page").status, 404) << name;
    EXPECT_EQ(get(route + "/worst").status, 404) << name;
    EXPECT_EQ(act(name, "cancel").status, 404) << name;
    EXPECT_EQ(act(name, "continue").status, 404) << name;
    EXPECT_EQ(ask(server_->port(), "DELETE", route).status, 404) << name;
  }
  const json command =
      json::array({{{"name", "perfect"}, {"type", "process"}, {"command", {"/bin/true"}}}});
  const Answer refused =
      start({{"kind", "predict"}, {"scenario", "tiny"}, {"overrides", {{"estimators", command}}}});
  EXPECT_EQ(refused.status, 403) << refused.body;
  const Answer outside = start({{"kind", "predict"},
                                {"scenario", "tiny"},
                                {"overrides", {{"world.imagery.0.file", "/etc/passwd"}}}});
  EXPECT_EQ(outside.status, 400);
  EXPECT_THAT(outside.body, HasSubstr("data folders"));
  // A run of the owner may have flown any command.
  const fs::path scenario = server_->folder() / "runs" / run_ / "scenario.json";
  json flown = json::parse(read_text(scenario));
  flown["estimators"] = command;
  write_text(scenario, flown.dump());
  EXPECT_EQ(start(explain()).status, 403);
  EXPECT_EQ(lines("calls").size(), 0U);
}

TEST_F(StudyRoutesTest, ExplainsOnlyWhatHasFailed) {
  const std::string good = server_->fly("tiny");
  const Answer answer = start(explain({{"run", good}}));
  EXPECT_EQ(answer.status, 400);
  EXPECT_THAT(answer.body, HasSubstr("nothing to explain"));
  const std::string flying = server_->start("slow");
  EXPECT_EQ(start(explain({{"run", flying}})).status, 409);
  EXPECT_TRUE(server_->runs().cancel(flying).ok());
}

TEST_F(StudyRoutesTest, LimitsHowManyWait) {
  put("block");
  const std::size_t most = server::experiments::StudyService::kMostWaiting;
  for (std::size_t i = 0; i <= most; ++i) ASSERT_EQ(start(explain()).status, 201) << i;
  const Answer refused = start(explain());
  EXPECT_EQ(refused.status, 429);
  EXPECT_EQ(refused.json().at("error").at("code"), "too_many_studies");
  EXPECT_THAT(refused.body, HasSubstr("must be below 20"));
}

}  // namespace
}  // namespace overfly::testing
