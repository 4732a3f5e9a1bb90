// Who watched a run, and what it cost.
#include "server/timeline/audience.hpp"

#include <gtest/gtest.h>

#include <optional>

namespace overfly::server {
namespace {

using Json = nlohmann::json;

TEST(Audience, CountsWhoCameAndHowManyWereThereAtOnce) {
  const auto audience = std::make_shared<Audience>();
  EXPECT_EQ(audience->summary().at("viewer_s"), 0.0);
  std::optional<Audience::Seat> first(std::in_place, audience);
  { const Audience::Seat second(audience); }
  first.reset();
  const Audience::Seat third(audience);
  const Json summary = audience->summary();
  EXPECT_EQ(summary.at("viewers"), 3);
  EXPECT_EQ(summary.at("most_at_once"), 2);
  // Those who stay count as well.
  EXPECT_GT(summary.at("viewer_s").get<double>(), 0.0);
  EXPECT_GT(audience->summary().at("viewer_s"), summary.at("viewer_s"));
}

TEST(Audience, CountsPicturesAndTheirCost) {
  Audience audience;
  audience.picture_made(Audience::Kind::kScene, 0.5);
  audience.picture_made(Audience::Kind::kScene, 0.25);
  audience.picture_made(Audience::Kind::kCamera, 0.125);
  const Json summary = audience.summary();
  EXPECT_EQ(summary.at("pictures"),
            (Json{{"camera", 1}, {"debug", 0}, {"scene", 2}, {"depth", 0}, {"error", 0}}));
  EXPECT_EQ(summary.at("cpu_s"), 0.875);
  EXPECT_EQ(summary.at("viewers"), 0);
}

}  // namespace
}  // namespace overfly::server
