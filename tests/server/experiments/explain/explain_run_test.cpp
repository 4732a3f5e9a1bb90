// Explanations of flights whose causes are known, flown by a program that a test writes.
#include "server/experiments/explain/explain_run.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "server/experiments/explain/explanation_json.hpp"
#include "server/experiments/explain/explanation_page.hpp"
#include "server/experiments/explain/explanation_words.hpp"
#include "server/record/run_lock.hpp"
#include "tests/server/support/server_fixture.hpp"

namespace overfly::server::experiments {
namespace {

namespace fs = std::filesystem;
using overfly::testing::read_text;
using overfly::testing::TemporaryFolder;
using overfly::testing::write_text;
using server::testing::options_for;
using server::testing::small_scenario;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::UnorderedElementsAre;

/// A flight with faults, blur and noise, whose estimator fails because every frame after 15 s is
/// dropped; and one that succeeds.
class ExplainRun : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    shared_ = new TemporaryFolder;
    fly_to("failed", {R"(faults=[{"kind":"dropped_frames","at_s":15},
                                 {"kind":"blackout","at_s":14.5,"duration_s":2}])"});
    fly_to("completed", {});
  }
  static void TearDownTestSuite() {
    delete shared_;
    shared_ = nullptr;
  }
  static fs::path run(const std::string& name) { return shared_->path() / name; }

  /// Lets the flights fail for which the shell's condition is true. In it, `has NAME` tells whether
  /// a disturbance is still there.
  Result<Explanation> explain(const std::string& fails, std::size_t flights = 12) {
    write_text(own_.path() / "program",
               R"(#!/bin/sh
scenario=$2
has() {
  case $1 in
    faults) grep -q '"blackout"' "$scenario";;
    drops) grep -q '"dropped_frames"' "$scenario" && ! grep -q '"at_s": 86400' "$scenario";;
    blur) grep -q '"motion_blur": true' "$scenario";;
    noise) grep -q '"shot_noise": true' "$scenario";;
    detail) ! grep -q '"detail"' "$scenario";;
    start) ! grep -q '"start_s": [0-9]*\.[67]' "$scenario";;
    seed1) grep -q '"seed": 1,' "$scenario";;
    exposure_ms) grep -q "\"exposure_ms\": $2" "$scenario";;
  esac
}
echo "$scenario" >> ')" +
                   calls().string() + "'\nif " + fails +
                   R"(; then result=failed; else result=completed; fi
cp -r ')" + shared_->path().string() +
                   R"('/$result "$4"
)");
    fs::permissions(own_.path() / "program", fs::perms::owner_all);
    ExplainOptions options;
    options.causes = causes_;
    options.flights.folder = folder();
    options.flights.program = own_.path() / "program";
    options.flights.most_flights = flights;
    options.flights.cancel = &cancel_;
    return explain_run(run("failed"), options);
  }
  [[nodiscard]] std::size_t calls_made() const {
    if (!fs::exists(calls())) return 0;
    const std::string text = read_text(calls());
    return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
  }
  [[nodiscard]] fs::path folder() const { return own_.path() / "out"; }
  [[nodiscard]] fs::path calls() const { return own_.path() / "calls"; }

  std::vector<Cause> causes_;
  std::atomic<bool> cancel_{false};

 private:
  static void fly_to(const std::string& name, std::vector<std::string> overrides) {
    overrides.emplace_back(R"(estimators=[{"name":"p","type":"perfect"}])");
    overrides.emplace_back(
        R"(camera.sensor={"motion_blur":true,"exposure_ms":8,"shot_noise":true})");
    overrides.emplace_back("duration_s=20");
    const auto flown = run_scenario(small_scenario(overrides), options_for(run(name)));
    ASSERT_TRUE(flown.ok()) << flown.error().message;
  }

  static TemporaryFolder* shared_;
  TemporaryFolder own_;
};
TemporaryFolder* ExplainRun::shared_ = nullptr;

TEST_F(ExplainRun, ASuccessNeedsNoFlight) {
  ExplainOptions options;
  options.flights.folder = folder();
  const auto explanation = explain_run(run("completed"), options);
  ASSERT_TRUE(explanation.ok()) << explanation.error().message;
  EXPECT_TRUE(explanation->succeeded);
  EXPECT_THAT(explanation->necessary, IsEmpty());
  EXPECT_THAT(explanation->sufficient, IsEmpty());
  EXPECT_FALSE(fs::exists(folder()));
}

TEST_F(ExplainRun, NamesTheOneCauseThatIsBoth) {
  const auto explanation = explain("has blur");
  ASSERT_TRUE(explanation.ok()) << explanation.error().message;
  EXPECT_TRUE(explanation->reproduced);
  EXPECT_EQ(explanation->reproduced_with_other_seed, true);
  EXPECT_THAT(explanation->necessary, ElementsAre(Cause::kBlur));
  EXPECT_THAT(explanation->sufficient, ElementsAre(Cause::kBlur));
  EXPECT_FALSE(explanation->data_limited);
  EXPECT_LE(explanation->flights.size(), 12U);
  EXPECT_EQ(explanation->flights.size(), calls_made());
}

TEST_F(ExplainRun, TwoCausesTogetherAreNotSufficientAlone) {
  const auto explanation = explain("has blur && has noise");
  ASSERT_TRUE(explanation.ok()) << explanation.error().message;
  EXPECT_THAT(explanation->necessary, UnorderedElementsAre(Cause::kBlur, Cause::kNoise));
  EXPECT_THAT(explanation->sufficient, IsEmpty());
  EXPECT_THAT(explanation->together, UnorderedElementsAre(Cause::kBlur, Cause::kNoise));
  EXPECT_EQ(json_from(*explanation, folder()).at("sufficiency_tested").size(), 2U);
}

/// Of the flight with only one of them nothing is known: that it takes both was not seen.
TEST_F(ExplainRun, CausesThatWereNotTestedByThemselvesAreNotCalledInsufficient) {
  const auto explanation = explain(
      "{ if has noise && ! has blur && ! has drops && ! has faults; then exit 1; fi; "
      "has blur && has noise; }");
  ASSERT_TRUE(explanation.ok()) << explanation.error().message;
  EXPECT_THAT(explanation->necessary, UnorderedElementsAre(Cause::kBlur, Cause::kNoise));
  EXPECT_THAT(explanation->sufficiency_tested, ElementsAre(Cause::kBlur));
  EXPECT_THAT(explanation->together, IsEmpty());
}

TEST_F(ExplainRun, OfTwoCausesEachIsEnough) {
  const auto explanation = explain("has drops || has noise");
  ASSERT_TRUE(explanation.ok()) << explanation.error().message;
  EXPECT_THAT(explanation->necessary, IsEmpty());
  EXPECT_THAT(explanation->sufficient, UnorderedElementsAre(Cause::kDrops, Cause::kNoise));
  EXPECT_THAT(explanation->pair, UnorderedElementsAre(Cause::kDrops, Cause::kNoise));
}

TEST_F(ExplainRun, TextureIsTheLimitOfTheDataWhereNoDisturbanceExplains) {
  const auto explanation = explain("has detail");
  ASSERT_TRUE(explanation.ok()) << explanation.error().message;
  EXPECT_THAT(explanation->necessary, ElementsAre(Cause::kTexture));
  EXPECT_THAT(explanation->sufficient, ElementsAre(Cause::kTexture));
  EXPECT_TRUE(explanation->data_limited);
}

/// Every single cause is tried before pairs, also those for which the limit left no flight at
/// first.
TEST_F(ExplainRun, NamesTheStartWhereNothingElseExplains) {
  const auto explanation = explain("has start");
  ASSERT_TRUE(explanation.ok()) << explanation.error().message;
  EXPECT_THAT(explanation->necessary, ElementsAre(Cause::kStart));
  for (const UntriedCause& untried : explanation->untried) {
    EXPECT_THAT(untried.reason, ::testing::Not(HasSubstr("limit"))) << to_string(untried.cause);
  }
}

/// Disturbances cannot be the cause if the estimator fails without all of them.
TEST_F(ExplainRun, PairsAreOfWhatMayExplain) {
  const auto explanation = explain("true", 20);
  ASSERT_TRUE(explanation.ok()) << explanation.error().message;
  for (const Reflight& flight : explanation->flights) {
    if (flight.changes.size() != 2) continue;
    for (const CauseChange& change : flight.changes) {
      EXPECT_FALSE(is_disturbance(change.cause)) << flight.name;
    }
  }
}

TEST_F(ExplainRun, FailsWhateverIsChanged) {
  const auto explanation = explain("true");
  ASSERT_TRUE(explanation.ok()) << explanation.error().message;
  EXPECT_TRUE(explanation->reproduced);
  EXPECT_THAT(explanation->necessary, IsEmpty());
  EXPECT_THAT(explanation->sufficient, IsEmpty());
  EXPECT_LE(explanation->flights.size(), 12U);
  EXPECT_THAT(sentences_of(*explanation), ::testing::Contains(HasSubstr("No single cause")));
}

TEST_F(ExplainRun, AFailureThatDoesNotComeAgainIsNotExplained) {
  const auto explanation = explain("false");
  ASSERT_TRUE(explanation.ok()) << explanation.error().message;
  EXPECT_FALSE(explanation->reproduced);
  EXPECT_THAT(explanation->necessary, IsEmpty());
}

/// In the part that begins before the failure it does not initialise, which it did in the run.
TEST_F(ExplainRun, AnotherKindOfFailureIsNotTheFailureOfTheRun) {
  const fs::path unstarted = folder().parent_path() / "unstarted";
  fs::copy(run("failed"), unstarted, fs::copy_options::recursive);
  auto metrics = nlohmann::json::parse(read_text(unstarted / "metrics.json"));
  metrics["estimators"]["p"]["outcome"] = "NOT_INITIALISED";
  write_text(unstarted / "metrics.json", metrics.dump());
  const auto explanation = explain("{ if ! grep -q '\"start_s\": 0' \"$scenario\"; then cp -r '" +
                                   unstarted.string() + "' \"$4\"; exit; fi; has blur; }");
  ASSERT_TRUE(explanation.ok()) << explanation.error().message;
  EXPECT_TRUE(explanation->reproduced);
  EXPECT_EQ(explanation->part.from_s, 0.0);
  EXPECT_THAT(explanation->necessary, ElementsAre(Cause::kBlur));
  ASSERT_GE(explanation->flights.size(), 2U);
  EXPECT_EQ(explanation->flights[0].score.outcome, evaluation::Outcome::kNotInitialised);
  EXPECT_GT(explanation->flights[0].part.from_s, 0.0);
}

TEST_F(ExplainRun, ChanceIsSaid) {
  const auto explanation = explain("has blur && has seed1");
  ASSERT_TRUE(explanation.ok()) << explanation.error().message;
  EXPECT_EQ(explanation->reproduced_with_other_seed, false);
  EXPECT_THAT(sentences_of(*explanation), ::testing::Contains(HasSubstr("chance decides")));
}

/// The limit of flights lets one of two causes be flown with other random numbers.
TEST_F(ExplainRun, SaysWhichCausesWereNotTriedWithOtherRandomNumbers) {
  const auto all = explain("has blur && has noise");
  ASSERT_TRUE(all.ok()) << all.error().message;
  EXPECT_THAT(all->confirmed, UnorderedElementsAre(Cause::kBlur, Cause::kNoise));
  EXPECT_THAT(sentences_of(*all), ::testing::Contains(HasSubstr("the result is the same")));
  fs::remove_all(folder());
  const auto some = explain("has blur && has noise", 10);
  ASSERT_TRUE(some.ok()) << some.error().message;
  EXPECT_THAT(some->necessary, UnorderedElementsAre(Cause::kBlur, Cause::kNoise));
  ASSERT_EQ(some->confirmed.size(), 1U);
  const std::vector<std::string> sentences = sentences_of(*some);
  EXPECT_THAT(sentences,
              ::testing::Contains(HasSubstr("Not tried with other random numbers: the ")));
  EXPECT_THAT(sentences, ::testing::Not(::testing::Contains(HasSubstr("result is the same"))));
  EXPECT_EQ(json_from(*some, folder()).at("confirmed").size(), 1U);
}

/// Without noise the estimator survives with one set of random numbers only.
TEST_F(ExplainRun, ACauseThatFailsTheSecondTestIsNotNamed) {
  const auto explanation = explain("has noise || ! has seed1");
  ASSERT_TRUE(explanation.ok()) << explanation.error().message;
  EXPECT_EQ(explanation->reproduced_with_other_seed, true);
  EXPECT_THAT(explanation->necessary, IsEmpty());
  EXPECT_THAT(explanation->sufficient, IsEmpty());
  EXPECT_THAT(explanation->withdrawn, ElementsAre(Cause::kNoise));
  const std::vector<std::string> sentences = sentences_of(*explanation);
  EXPECT_THAT(sentences, ::testing::Contains(HasSubstr("by chance")));
  EXPECT_THAT(sentences, ::testing::Not(::testing::Contains(HasSubstr("result is the same"))));
}

/// What was found by chance hides nothing: the real cause is looked for with the other numbers.
TEST_F(ExplainRun, TheRealCauseIsNamedWhereTheFirstOneWasChance) {
  const auto explanation = explain("has detail && { has noise || ! has seed1; }", 14);
  ASSERT_TRUE(explanation.ok()) << explanation.error().message;
  EXPECT_THAT(explanation->withdrawn, ElementsAre(Cause::kNoise));
  EXPECT_THAT(explanation->necessary, ElementsAre(Cause::kTexture));
}

/// The exposure falls from 8 ms by bisection: 4 is too much, 2 not, 3 is.
TEST_F(ExplainRun, FindsTheMarginByBisection) {
  const auto explanation =
      explain("has blur && { has exposure_ms 8 || has exposure_ms 4 || has exposure_ms 3; }");
  ASSERT_TRUE(explanation.ok()) << explanation.error().message;
  ASSERT_TRUE(explanation->margin.has_value());
  EXPECT_EQ(explanation->margin->cause, Cause::kBlur);
  EXPECT_EQ(explanation->margin->survives_share, 0.25);
  EXPECT_EQ(explanation->margin->fails_share, 0.375);
}

TEST_F(ExplainRun, KeepsToItsLimitAndSaysWhatItLeftOut) {
  const auto explanation = explain("has noise", 4);
  ASSERT_TRUE(explanation.ok()) << explanation.error().message;
  EXPECT_LE(explanation->flights.size(), 4U);
  EXPECT_LE(calls_made(), 4U);
  EXPECT_THAT(explanation->untried,
              ::testing::Contains(
                  ::testing::Field(&UntriedCause::reason, HasSubstr("the limit of 4 flights"))));
}

TEST_F(ExplainRun, TriesOnlyTheCausesThatAreAskedFor) {
  causes_ = {Cause::kNoise};
  const auto explanation = explain("has blur");
  ASSERT_TRUE(explanation.ok()) << explanation.error().message;
  EXPECT_THAT(explanation->necessary, IsEmpty());
  for (const Reflight& flight : explanation->flights) {
    for (const CauseChange& change : flight.changes) EXPECT_EQ(change.cause, Cause::kNoise);
  }
}

/// The other disturbances stay: that the cause is enough without them was not seen.
TEST_F(ExplainRun, NamesNoSufficientCauseWhereOthersHadToStay) {
  causes_ = {Cause::kBlur};
  const auto explanation = explain("has blur");
  ASSERT_TRUE(explanation.ok()) << explanation.error().message;
  EXPECT_THAT(explanation->necessary, ElementsAre(Cause::kBlur));
  EXPECT_THAT(explanation->sufficient, IsEmpty());
  EXPECT_THAT(explanation->not_changed,
              UnorderedElementsAre(Cause::kFaults, Cause::kDrops, Cause::kNoise));
  EXPECT_THAT(sentences_of(*explanation), ::testing::Contains(HasSubstr("had to stay")));
}

TEST_F(ExplainRun, SaysThatTheLimitLeftOutLongerParts) {
  const auto explanation = explain("false", 1);
  ASSERT_TRUE(explanation.ok()) << explanation.error().message;
  EXPECT_FALSE(explanation->reproduced);
  EXPECT_TRUE(explanation->parts_left_out);
  EXPECT_THAT(sentences_of(*explanation), ::testing::Contains(HasSubstr("allow more flights")));
}

/// A flight without a result neither survived nor failed.
TEST_F(ExplainRun, ConcludesNothingFromAFlightWithoutResult) {
  const auto explanation =
      explain("if has seed1; then has blur; else echo out of memory >&2; exit 1; fi");
  ASSERT_TRUE(explanation.ok()) << explanation.error().message;
  EXPECT_THAT(explanation->necessary, ElementsAre(Cause::kBlur));
  EXPECT_FALSE(explanation->reproduced_with_other_seed.has_value());
}

TEST_F(ExplainRun, FliesNothingTwice) {
  ASSERT_TRUE(explain("has blur").ok());
  const std::size_t flown = calls_made();
  const auto again = explain("has blur");
  ASSERT_TRUE(again.ok());
  EXPECT_EQ(calls_made(), flown);
  EXPECT_THAT(again->necessary, ElementsAre(Cause::kBlur));
}

TEST_F(ExplainRun, FaultsKeepTheirPlaceInTheFlight) {
  ASSERT_TRUE(explain("has blur").ok());
  std::size_t parts = 0;
  for (const auto& entry : fs::directory_iterator(folder() / "scenarios")) {
    const auto document = nlohmann::json::parse(read_text(entry.path()));
    const double start_s = document.value("start_s", 0.0);
    for (const auto& fault : document.at("faults")) {
      if (fault.at("at_s") == 86400.0) continue;  // taken away
      const double at_s = fault.at("kind") == "blackout" ? 14.5 : 15.0;
      EXPECT_DOUBLE_EQ(fault.at("at_s").get<double>(), std::max(0.0, at_s - start_s));
    }
    EXPECT_EQ(document.at("estimators").size(), 1U);
    ++parts;
  }
  EXPECT_GT(parts, 0U);
}

TEST_F(ExplainRun, CancelledItSaysThatItCanBeContinued) {
  cancel_ = true;
  const auto explanation = explain("has blur");
  ASSERT_FALSE(explanation.ok());
  EXPECT_EQ(explanation.error().code, ErrorCode::kCancelled);
}

TEST_F(ExplainRun, OneProcessWorksInAFolder) {
  fs::create_directories(folder());
  const auto lock = RunLock::take(folder());
  ASSERT_TRUE(lock.ok());
  EXPECT_EQ(explain("true").error().code, ErrorCode::kConflict);
}

TEST_F(ExplainRun, UnknownEstimatorsAndRunsAreRefused) {
  ExplainOptions options;
  options.flights.folder = folder();
  options.estimator = "nobody";
  const auto unknown = explain_run(run("failed"), options);
  EXPECT_THAT(unknown.error().message, HasSubstr("estimator = nobody: must be one of p"));
  EXPECT_FALSE(explain_run(run("absent"), options).ok());
}

TEST_F(ExplainRun, JsonAndPageSayTheSame) {
  const auto explanation = explain("has blur");
  ASSERT_TRUE(explanation.ok()) << explanation.error().message;
  const auto json = json_from(*explanation, folder());
  EXPECT_EQ(json.at("necessary"), nlohmann::json::array({"blur"}));
  EXPECT_EQ(json.at("sufficient"), nlohmann::json::array({"blur"}));
  EXPECT_EQ(json.at("data_limited"), false);
  ASSERT_EQ(json.at("flights").size(), explanation->flights.size());
  const std::string run_name = json.at("flights").at(0).at("run").get<std::string>();
  EXPECT_TRUE(fs::exists(folder() / run_name / "manifest.json")) << run_name;
  const std::string page = page_of(*explanation, folder());
  EXPECT_THAT(page, HasSubstr("Why p failed"));
  EXPECT_THAT(page, HasSubstr("href=\"" + run_name + "/\""));
  EXPECT_THAT(page, HasSubstr("<svg"));
  EXPECT_THAT(page, HasSubstr(words_for(Cause::kBlur) + ": necessary yes, sufficient yes"));
  EXPECT_THAT(page, ::testing::Not(HasSubstr("<script")));
}

}  // namespace
}  // namespace overfly::server::experiments
