// The layout for Lichtblick in docs/examples shows topics that a flight of `feature` has.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "server/files/whole_file.hpp"
#include "server/net/foxglove/channels.hpp"

namespace overfly::net::foxglove {
namespace {

/// Topics in names and values: "/estimates/feature/state" of "/estimates/feature/state.error_m".
void add_topics(const nlohmann::json& value, std::set<std::string>* topics) {
  if (value.is_string()) {
    const auto text = value.get<std::string>();
    if (text.starts_with('/')) topics->insert(text.substr(0, text.find('.')));
  }
  if (!value.is_structured()) return;
  for (const auto& [name, member] : value.items()) {
    if (value.is_object()) add_topics(name, topics);
    add_topics(member, topics);
  }
}

TEST(FoxgloveLayout, ShowsTopicsOfAFlight) {
  std::set<std::string> known;
  const FlightNames names = names_of({{"", PinholeCamera(), Pose()}}, {"feature"});
  for (const Channel& channel : channels_of(names, 1)) known.insert(channel.topic);
  const auto layout = server::read_json(std::filesystem::path(OVERFLY_SOURCE_DIR) /
                                        "docs/examples/lichtblick_layout.json");
  ASSERT_TRUE(layout.ok()) << layout.error().message;
  std::set<std::string> shown;
  add_topics(layout->at("configById"), &shown);
  EXPECT_GE(shown.size(), 9U);
  EXPECT_THAT(known, ::testing::IsSupersetOf(shown));
}

}  // namespace
}  // namespace overfly::net::foxglove
