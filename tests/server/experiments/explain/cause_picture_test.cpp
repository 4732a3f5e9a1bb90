#include "server/experiments/explain/cause_picture.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace overfly::server::experiments {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

Reflight flight(const std::vector<Cause>& causes, bool survived, const std::string& error = "") {
  Reflight made;
  for (const Cause cause : causes) made.changes.push_back(without(cause));
  made.survived = survived;
  made.error = error;
  return made;
}

const CauseFinding* finding_of(const std::vector<CauseFinding>& findings, Cause cause) {
  for (const CauseFinding& finding : findings) {
    if (finding.cause == cause) return &finding;
  }
  return nullptr;
}

/// Blur is the cause, noise is none; drops had no result, and only the pair has exposure.
Explanation example() {
  Explanation made;
  made.necessary = {Cause::kBlur};
  made.sufficient = {Cause::kBlur};
  made.sufficiency_tested = {Cause::kBlur, Cause::kNoise};
  made.margin = CauseMargin{Cause::kBlur, 0.25, 0.5};
  made.flights = {flight({}, false),
                  flight({Cause::kBlur}, true),
                  flight({Cause::kNoise}, false),
                  flight({Cause::kDrops}, false, "out of memory"),
                  flight({Cause::kNoise, Cause::kExposure}, false)};
  return made;
}

TEST(CauseFinding, SaysOnlyWhatFlightsHaveShown) {
  const std::vector<CauseFinding> findings = findings_of(example());
  ASSERT_EQ(findings.size(), 2U);
  EXPECT_EQ(findings.front().cause, Cause::kBlur) << "the named ones first";
  EXPECT_EQ(findings.front().necessary, true);
  EXPECT_EQ(findings.front().sufficient, true);
  ASSERT_TRUE(findings.front().margin);
  const CauseFinding* const noise = finding_of(findings, Cause::kNoise);
  ASSERT_NE(noise, nullptr);
  EXPECT_EQ(noise->necessary, false);
  EXPECT_EQ(noise->sufficient, false);
  EXPECT_FALSE(noise->margin);
}

TEST(CauseFinding, WhatWasNotTriedIsNeitherYesNorNo) {
  Explanation pair;
  pair.pair = {Cause::kBlur, Cause::kNoise};
  pair.flights = {flight({Cause::kBlur}, false), flight({Cause::kBlur, Cause::kNoise}, true)};
  const std::vector<CauseFinding> findings = findings_of(pair);
  EXPECT_EQ(finding_of(findings, Cause::kBlur)->necessary, false);
  EXPECT_EQ(finding_of(findings, Cause::kBlur)->sufficient, std::nullopt);
  EXPECT_EQ(finding_of(findings, Cause::kNoise)->necessary, std::nullopt);
}

TEST(CauseFinding, ACauseThatWasWithdrawnIsNotNecessary) {
  Explanation made;
  made.withdrawn = {Cause::kBlur};
  made.flights = {flight({Cause::kBlur}, true)};
  EXPECT_EQ(finding_of(findings_of(made), Cause::kBlur)->necessary, false);
}

TEST(CausePicture, HasAMarkAndAWordForEachAnswer) {
  const std::string svg = cause_picture(findings_of(example()));
  EXPECT_THAT(svg, HasSubstr("class=\"mark-yes\""));
  EXPECT_THAT(svg, HasSubstr("class=\"mark-no\""));
  EXPECT_THAT(svg,
              HasSubstr(words_for(Cause::kBlur) + ": necessary yes, sufficient yes, survives "
                                                  "25 % of it and fails at 50 %."));
  // A quarter of 340 px is survived, and half of them failed.
  EXPECT_THAT(svg, HasSubstr("class=\"band-tracking\" x=\"520\""));
  EXPECT_THAT(svg, HasSubstr("width=\"85\""));
  EXPECT_THAT(svg, HasSubstr("class=\"band-lost\" x=\"690\""));
  EXPECT_THAT(svg, HasSubstr("width=\"170\""));
}

TEST(CausePicture, WithoutAMarginThereIsNoAxisForOne) {
  Explanation made = example();
  made.margin.reset();
  const std::string svg = cause_picture(findings_of(made));
  EXPECT_THAT(svg, Not(HasSubstr("share of the cause")));
  EXPECT_THAT(svg, Not(HasSubstr("band-lost")));
  EXPECT_EQ(svg.find("<svg"), svg.rfind("<svg"));
}

}  // namespace
}  // namespace overfly::server::experiments
