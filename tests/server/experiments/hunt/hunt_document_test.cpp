// Hunt files and scenarios with limits: what is accepted, and what each message names.
#include "server/experiments/hunt/hunt_document.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "tests/support/support.hpp"

namespace overfly::server::experiments {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using Json = nlohmann::json;

const fs::path& scenarios() {
  static const fs::path folder = fs::path(OVERFLY_SOURCE_DIR) / "scenarios";
  return folder;
}

Json limits_document() {
  return {{"format_version", 1},
          {"scenario", "course.json"},
          {"axes",
           {{{"path", "flight.course.airspeed_m_s"}, {"from", 10}, {"to", 30}},
            {{"path", "flight.course.height_agl_m"}, {"values", {100, 200, 300}}}}}};
}

Result<Hunt> resolve(const Json& json, const std::string& estimator = "") {
  return resolve_hunt(json, scenarios(), estimator);
}

std::string message(const Json& json, const std::string& estimator = "") {
  const Result<Hunt> hunt = resolve(json, estimator);
  return hunt.ok() ? "" : hunt.error().message;
}

TEST(HuntDocument, ReadsFieldsAndDefaults) {
  Json json = limits_document();
  const Result<Hunt> plain = resolve(json);
  ASSERT_TRUE(plain.ok()) << plain.error().message;
  EXPECT_EQ(plain->estimator, "feature");
  EXPECT_EQ(plain->method, SearchMethod::kModel);
  EXPECT_TRUE(plain->stop_at_failure);
  EXPECT_EQ(plain->most_flights, 60U);
  EXPECT_EQ(plain->batch, 1U);
  EXPECT_FALSE(plain->rule.position_rmse_limit_m.has_value());
  json["estimator"] = {{"name", "mine"}, {"type", "perfect"}};
  json["method"] = "random";
  json["until"] = "flights";
  json["most_flights"] = 9;
  json["repeats"] = 3;
  json["batch"] = 2;
  json["seed"] = 7;
  json["position_rmse_limit_m"] = 2.5;
  json["alignment"] = "sim3";
  const Result<Hunt> hunt = resolve(json);
  ASSERT_TRUE(hunt.ok()) << hunt.error().message;
  EXPECT_EQ(hunt->estimator, "mine");
  EXPECT_EQ(hunt->method, SearchMethod::kRandom);
  EXPECT_FALSE(hunt->stop_at_failure);
  EXPECT_EQ(hunt->most_flights, 9U);
  EXPECT_EQ(hunt->sweep.repeats.most, 3);
  EXPECT_EQ(hunt->batch, 2U);
  EXPECT_EQ(hunt->seed, 7U);
  EXPECT_EQ(hunt->rule.position_rmse_limit_m, 2.5);
  EXPECT_EQ(hunt->rule.alignment, evaluation::AlignmentMode::kSim3);
}

TEST(HuntDocument, GivesEachPointItsFlight) {
  const Hunt hunt = resolve(limits_document()).value();
  const auto axes = search_axes(hunt);
  ASSERT_EQ(axes.size(), 2U);
  EXPECT_EQ(axes[0].values, 0U);
  EXPECT_EQ(axes[1].values, 3U);
  const auto at = [&](double x, double y) { return cell_at(hunt, Eigen::Vector2d(x, y)).values; };
  const std::string speed = "flight.course.airspeed_m_s";
  const std::string height = "flight.course.height_agl_m";
  EXPECT_EQ(at(0.0, 0.0), Json({{speed, 10.0}, {height, 100}}));
  EXPECT_EQ(at(1.0, 1.0), Json({{speed, 30.0}, {height, 300}}));
  EXPECT_EQ(at(0.123456789, 0.5), Json({{speed, 12.46914}, {height, 200}})) << "seven digits";
  const Result<Scenario> scenario =
      scenario_of(hunt.sweep, cell_at(hunt, Eigen::Vector2d(0.25, 0.5)), 0);
  ASSERT_TRUE(scenario.ok());
  EXPECT_EQ(scenario->resolved.at("flight").at("course").at("airspeed_m_s"), 15.0);
  EXPECT_EQ(scenario->estimators.size(), 1U);
}

TEST(HuntDocument, TakesOneEstimatorOfTheScenario) {
  Json json = limits_document();
  json["set"] = {
      {"estimators", {{{"name", "a"}, {"type", "perfect"}}, {{"name", "b"}, {"type", "feature"}}}}};
  EXPECT_EQ(resolve(json).value().estimator, "a");
  const Hunt hunt = resolve(json, "b").value();
  const Scenario scenario =
      scenario_of(hunt.sweep, cell_at(hunt, Eigen::Vector2d(0.5, 0.5)), 0).value();
  ASSERT_EQ(scenario.estimators.size(), 1U);
  EXPECT_EQ(scenario.estimators[0].name, "b");
  EXPECT_THAT(message(json, "c"), HasSubstr("estimator = c: must be one of a, b"));
  json["estimator"] = {{"name", "mine"}, {"type", "perfect"}};
  EXPECT_THAT(message(json, "a"), HasSubstr("the hunt file has one of its own"));
}

TEST(HuntDocument, NamesWhatIsInvalid) {
  const auto with = [](const char* field, const Json& value) {
    Json json = limits_document();
    json[field] = value;
    return message(json);
  };
  EXPECT_THAT(with("most_flights", 501), HasSubstr("most_flights = 501"));
  EXPECT_THAT(with("method", "guess"), HasSubstr("method = \"guess\""));
  EXPECT_THAT(with("axes", Json::array()), HasSubstr("axes"));
  EXPECT_THAT(with("axis", 1), HasSubstr("axis"));
  EXPECT_THAT(with("position_rmse_limit_m", 0), HasSubstr("position_rmse_limit_m = 0"));
  EXPECT_THAT(with("scenario", "absent.json"), HasSubstr("absent.json"));
  const Json reversed = {{{"path", "flight.course.airspeed_m_s"}, {"from", 30}, {"to", 10}}};
  EXPECT_THAT(with("axes", reversed), HasSubstr("axes.0.to = 10: must be at least"));
  const Json unknown = {{{"path", "flight.course.airsped"}, {"from", 1}, {"to", 2}}};
  EXPECT_THAT(with("axes", unknown), HasSubstr("airsped"));
  Json few = limits_document();
  few["most_flights"] = 2;
  few["repeats"] = 3;
  EXPECT_THAT(message(few), HasSubstr("most_flights = 2: must be at least repeats = 3"));
}

/// Limits beyond those of the scenario are found at a corner, before any flight.
TEST(HuntDocument, ChecksEveryCornerOfTheLimits) {
  Json json = limits_document();
  json["axes"][0]["from"] = -1;
  EXPECT_THAT(message(json), HasSubstr("flight.course.airspeed_m_s = -1"));
  json["axes"][0]["from"] = 10;
  json["axes"][0]["to"] = 81;  // the middle is within the limits
  EXPECT_THAT(message(json), HasSubstr("flight.course.airspeed_m_s = 81"));
}

TEST(HuntDocument, ReadsAnAxisFromAnOption) {
  EXPECT_EQ(parse_axis("a.b=1:2.5").value(), Json({{"path", "a.b"}, {"from", 1.0}, {"to", 2.5}}));
  EXPECT_EQ(parse_axis("a=-1e1:2:0.5").value(),
            Json({{"path", "a"}, {"from", -10.0}, {"to", 2.0}, {"step", 0.5}}));
  for (const char* text : {"a", "=1:2", "a=1", "a=1:", "a=1:x", "a=1:2:3:4", "a=1:inf", "a=1:2 "}) {
    const auto axis = parse_axis(text);
    ASSERT_FALSE(axis.ok()) << text;
    EXPECT_THAT(axis.error().message, HasSubstr("must be PATH=FROM:TO"));
  }
}

TEST(HuntDocument, MakesAHuntOfAScenario) {
  const Json json = read_hunt_document(scenarios() / "course.json").value();
  EXPECT_EQ(json.at("scenario"), "course.json");
  EXPECT_TRUE(json.at("axes").empty());
  const overfly::testing::TemporaryFolder folder;
  overfly::testing::write_text(folder.path() / "list.json", "[1]");
  EXPECT_THAT(read_hunt_document(folder.path() / "list.json").error().message,
              HasSubstr("is no JSON object"));
}

TEST(HuntDocument, TheHuntsOfThisRepositoryAreValid) {
  for (const auto& entry : fs::directory_iterator(scenarios() / "hunts")) {
    const auto json = read_hunt_document(entry.path());
    ASSERT_TRUE(json.ok());
    const auto hunt = resolve_hunt(*json, entry.path().parent_path(), "");
    EXPECT_TRUE(hunt.ok()) << entry.path() << hunt.error().message;
  }
}

}  // namespace
}  // namespace overfly::server::experiments
