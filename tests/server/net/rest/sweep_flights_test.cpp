// Cancelling, continuing and extending sweeps, and what their flights share with the server.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/types.h>

#include <chrono>
#include <csignal>
#include <cstdint>
#include <thread>

#include "server/record/run_lock.hpp"
#include "tests/server/net/rest/sweep_routes_fixture.hpp"

namespace overfly::testing {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::HasSubstr;

TEST_F(SweepRoutesTest, CancelsAndContinues) {
  block();
  ASSERT_EQ(start("seeds").status, 201);
  wait_for_calls(1);
  const pid_t flight = std::stoi(lines("flights").front());
  EXPECT_EQ(post_to("seeds", "continue").status, 429);
  const Answer cancelled = post_to("seeds", "cancel");
  EXPECT_EQ(cancelled.status, 202) << cancelled.body;
  const json stopped = ended("seeds");
  EXPECT_EQ(stopped.at("problem"), nullptr) << "cancelling is no failure";
  EXPECT_EQ(stopped.at("progress").at("passed"), 0);
  EXPECT_NE(::kill(flight, 0), 0) << "its flight has ended";
  EXPECT_EQ(post_to("seeds", "cancel").status, 409);
  unblock();
  const Answer continued = post_to("seeds", "continue");
  ASSERT_EQ(continued.status, 202) << continued.body;
  EXPECT_EQ(continued.json().at("here"), "flying");
  EXPECT_EQ(ended("seeds").at("progress").at("passed"), 3);
  EXPECT_EQ(lines("calls").size(), 4U);
  ASSERT_EQ(post_to("seeds", "continue").status, 202) << "nothing is left to be flown";
  EXPECT_EQ(ended("seeds").at("progress").at("flown"), 0);
  EXPECT_EQ(lines("calls").size(), 4U);
}

TEST_F(SweepRoutesTest, FlightsOfAllSweepsShareAFrameCache) {
  const fs::path cache = server_->folder() / "sweeps/.frame_cache";
  fs::create_directories(cache);
  for (const char* name : {"one", "two"}) {
    ASSERT_EQ(start(name).status, 201);
    (void)ended(name);
  }
  const auto calls = lines("calls");
  ASSERT_EQ(calls.size(), 6U);
  for (const std::string& call : calls) {
    EXPECT_THAT(call, HasSubstr("--frame-cache " + cache.string() + " --frame-cache-gib 2.5 "));
  }
  const json list = ask(server_->port(), "GET", kSweepRoute).json();
  EXPECT_EQ(list.at("sweeps").size(), 2U) << "the cache is no sweep";
  EXPECT_EQ(start(".frame_cache").status, 400);
}

TEST_F(SweepRoutesTest, ExtendsASweepWithAChangedDocument) {
  ASSERT_EQ(start("seeds").status, 201);
  (void)ended("seeds");
  const std::string route = std::string(kSweepRoute) + "/seeds";
  json extended = ask(server_->port(), "GET", route + "/document").json();
  EXPECT_FALSE(extended.contains("axis_values")) << "what the sweep was flown with is left out";
  extended["axes"][0]["values"] = {1, 2, 3, 4};
  ASSERT_EQ(post(route + "/continue", {{"document", extended}, {"jobs", 1}}).status, 202);
  EXPECT_EQ(ended("seeds").at("progress").at("passed"), 4);
  EXPECT_EQ(lines("calls").size(), 4U) << "only the fourth cell was flown";
}

/// The program's flights all survive: two of twenty seeds are needed, then one more as its
/// neighbour.
TEST_F(SweepRoutesTest, FliesOnlyTheBorderAlongAnAxis) {
  json seeds = json::array();
  for (int seed = 1; seed <= 20; ++seed) seeds.push_back(seed);
  const json axes = json::array({{{"path", "seed"}, {"values", seeds}}});
  const json wanted = {{"name", "border"},
                       {"document", document({{"axes", axes}})},
                       {"border", {{"axis", "seed"}}},
                       {"jobs", 1}};
  ASSERT_EQ(post(kSweepRoute, wanted).status, 201);
  const json sweep = ended("border");
  EXPECT_EQ(sweep.at("problem"), nullptr);
  EXPECT_EQ(sweep.at("envelope").at("axis"), "seed");
  EXPECT_EQ(sweep.at("envelope").at("found"), true);
  const std::string route = std::string(kSweepRoute) + "/border";
  const json envelope = ask(server_->port(), "GET", route).json().at("envelope");
  EXPECT_EQ(envelope.at("cells"), 20);
  const std::size_t needed = envelope.at("cells_needed");
  EXPECT_LE(needed, 6U);
  EXPECT_EQ(lines("calls").size(), needed);
  EXPECT_EQ(sweep.at("progress").at("passed"), needed) << "of the whole sweep";
  EXPECT_EQ(sweep.at("progress").at("most"), 20);
  const json line = envelope.at("lines").at(0);
  EXPECT_EQ(line.at("survives"), 20);
  EXPECT_EQ(line.at("fails"), nullptr);

  ASSERT_EQ(post_to("border", "continue").status, 202) << "without border the rest is flown";
  EXPECT_EQ(ended("border").at("progress").at("passed"), 20);
  EXPECT_EQ(lines("calls").size(), 20U);
  EXPECT_EQ(entry("border").at("envelope").at("found"), true);
  const json other = document({{"axes", axes}, {"title", "Another one"}});
  ASSERT_EQ(post(route + "/continue", {{"document", other}}).status, 202);
  EXPECT_EQ(ended("border").at("envelope"), nullptr) << "it was that of another document";
}

TEST_F(SweepRoutesTest, ABorderOfOtherCellsOrADamagedOneIsNotShown) {
  const json wanted = {
      {"name", "border"}, {"document", document()}, {"border", {{"axis", "seed"}}}, {"jobs", 1}};
  ASSERT_EQ(post(kSweepRoute, wanted).status, 201);
  ASSERT_EQ(ended("border").at("envelope").at("found"), true);
  const fs::path file = server_->folder() / "sweeps/border/envelope.json";
  const std::string route = std::string(kSweepRoute) + "/border";
  json envelope = json::parse(read_text(file));
  envelope["cells"] = 4;
  write_text(file, envelope.dump());
  EXPECT_EQ(entry("border").at("envelope"), nullptr) << "the sweep has three cells";
  for (const char* text : {"{", "[]", R"({"axis":"seed"})", R"({"lines":[7]})"}) {
    write_text(file, text);
    EXPECT_EQ(entry("border").at("envelope"), nullptr) << text;
    EXPECT_EQ(ask(server_->port(), "GET", route).json().at("envelope"), nullptr) << text;
  }
}

TEST_F(SweepRoutesTest, ABorderIsCheckedBeforeTheFlight) {
  const auto refused = [&](const json& border, const json& fields = json::object()) {
    const Answer answer =
        post(kSweepRoute, {{"name", "border"}, {"document", document(fields)}, {"border", border}});
    EXPECT_EQ(answer.status, 400) << answer.body;
    EXPECT_FALSE(fs::exists(server_->folder() / "sweeps/border")) << border;
    return answer.body;
  };
  EXPECT_THAT(refused({{"axis", "height"}}), HasSubstr("border.axis = height: must be an axis"));
  EXPECT_THAT(refused({{"axis", "seed"}, {"estimator", "x"}}), HasSubstr("border.estimator = x"));
  EXPECT_THAT(refused(json::object()), HasSubstr("border.axis"));
  EXPECT_THAT(refused({{"axis", "seed"}, {"along", 1}}), HasSubstr("border.along"));
  const json one = json::array({{{"path", "seed"}, {"values", {1}}}});
  EXPECT_THAT(refused({{"axis", "seed"}}, {{"axes", one}}), HasSubstr("at least two values"));
  const Answer check = post("/api/v1/sweep-check", {{"document", document()}});
  EXPECT_EQ(check.json().at("border_axes").at(0).at("name"), "seed") << check.body;
  EXPECT_EQ(check.json().at("estimator_names").size(), 1U);
}

TEST_F(SweepRoutesTest, ACancelledBorderIsContinued) {
  block();
  const json wanted = {
      {"name", "border"}, {"document", document()}, {"border", {{"axis", "seed"}}}, {"jobs", 1}};
  ASSERT_EQ(post(kSweepRoute, wanted).status, 201);
  wait_for_calls(1);
  ASSERT_EQ(post_to("border", "cancel").status, 202);
  const json stopped = ended("border");
  EXPECT_EQ(stopped.at("problem"), nullptr);
  EXPECT_EQ(stopped.at("envelope").at("found"), false);
  unblock();
  const std::string route = std::string(kSweepRoute) + "/border/continue";
  ASSERT_EQ(post(route, {{"border", {{"axis", "seed"}}}}).status, 202);
  EXPECT_EQ(ended("border").at("envelope").at("found"), true);
}

TEST_F(SweepRoutesTest, FliesOneSweepAtATime) {
  block();
  ASSERT_EQ(start("first").status, 201);
  const Answer second = start("second");
  EXPECT_EQ(second.status, 429);
  EXPECT_EQ(second.json().at("error").at("code"), "sweep_flying");
  EXPECT_THAT(second.body, HasSubstr("first"));
  EXPECT_FALSE(fs::exists(server_->folder() / "sweeps/second"));
  ASSERT_EQ(post_to("first", "cancel").status, 202);
  (void)ended("first");
  unblock();
  EXPECT_EQ(start("first").status, 409) << "the name is taken";
  EXPECT_EQ(start("second").status, 201);
  (void)ended("second");
}

TEST_F(SweepRoutesTest, LeavesSweepsOfOtherProcessesAlone) {
  ASSERT_EQ(start("seeds").status, 201);
  (void)ended("seeds");
  const auto lock = server::RunLock::take(server_->folder() / "sweeps/seeds");
  ASSERT_TRUE(lock.ok());
  EXPECT_EQ(post_to("seeds", "continue").status, 409);
  EXPECT_EQ(post_to("seeds", "cancel").status, 409);
  EXPECT_EQ(entry("seeds").at("flying"), true);
  EXPECT_EQ(entry("seeds").at("here"), nullptr);
  for (const char* name : {"nobody", "..", "a%2fb"}) {
    EXPECT_EQ(post_to(name, "cancel").status, 404) << name;
    EXPECT_EQ(post_to(name, "continue").status, 404) << name;
  }
}

TEST_F(SweepRoutesTest, GivesTheReasonWhyASweepEndedEarly) {
  ASSERT_EQ(start("seeds").status, 201);
  (void)ended("seeds");
  const fs::path results = server_->folder() / "sweeps/seeds/results.jsonl";
  fs::remove(results);
  fs::create_directory(results);
  ASSERT_EQ(post_to("seeds", "continue").status, 202);
  const json sweep = ended("seeds");
  ASSERT_TRUE(sweep.at("problem").is_string()) << sweep;
  EXPECT_THAT(sweep.at("problem").get<std::string>(), HasSubstr("results.jsonl"));
  EXPECT_THAT(server_->log(), HasSubstr("sweep seeds"));
}

TEST_F(SweepRoutesTest, EndsItsFlightsWithTheServer) {
  block();
  ASSERT_EQ(start("seeds").status, 201);
  wait_for_calls(1);
  const pid_t flight = std::stoi(lines("flights").front());
  EXPECT_EQ(::kill(flight, 0), 0);
  const auto before = std::chrono::steady_clock::now();
  server_.reset();
  EXPECT_LT(std::chrono::steady_clock::now() - before, std::chrono::seconds(10));
  EXPECT_NE(::kill(flight, 0), 0);
}

TEST_F(SweepRoutesTest, FlightsAndRunsShareTheMemory) {
  server::RunManager& runs = server_->runs();
  server::RunMemory most;
  most.images_bytes = std::uint64_t{1} << 50U;
  // The run of the fixture may still be about to end.
  auto held = runs.hold_memory(most);
  for (int i = 0; i < 500 && !held; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    held = runs.hold_memory(most);
  }
  ASSERT_NE(held, nullptr) << "nothing else flies";
  server::RunMemory little;
  little.images_bytes = 1;
  EXPECT_EQ(runs.hold_memory(little), nullptr);
  const std::string id = server_->start("tiny");
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  EXPECT_EQ(runs.run(id)->status, server::RunStatus::kQueued) << "it waits for memory";
  ASSERT_EQ(start("seeds").status, 201);
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  EXPECT_TRUE(lines("calls").empty()) << "no flight of the sweep begins before the run";
  held.reset();
  server_->wait_for_end(id);
  EXPECT_EQ(runs.run(id)->status, server::RunStatus::kCompleted);
  EXPECT_EQ(ended("seeds").at("progress").at("passed"), 3);
}

}  // namespace
}  // namespace overfly::testing
