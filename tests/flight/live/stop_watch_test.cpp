#include "flight/live/stop_watch.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "flight/mavlink/payload.hpp"

namespace overfly::flight::live {
namespace {

/// The number of items after which a flight with a stop at item 5 ends; 0: it goes on.
std::size_t ends_after(const std::vector<std::uint16_t>& items, std::int32_t stop = 5) {
  StopConditions conditions;
  conditions.mission_item = stop;
  StopWatch watch(conditions);
  for (std::size_t i = 0; i < items.size(); ++i) {
    const auto payload = mavlink::PayloadWriter(18).put(0, items[i]).bytes();
    const std::string reason =
        watch.take({mavlink::Version::kTwo, 0, 1, 1, 42, false, payload});  // MISSION_CURRENT
    if (reason.empty()) continue;
    EXPECT_EQ(reason, "the mission has come to item " + std::to_string(items[i]));
    return i + 1;
  }
  return 0;
}

TEST(StopWatch, EndsWhenTheMissionComesToItsItemOrPassesIt) {
  EXPECT_EQ(ends_after({1, 4, 4, 5, 6}), 4U);
  EXPECT_EQ(ends_after({1, 4, 6}), 3U) << "item 5 was current between two messages";
  EXPECT_EQ(ends_after({1, 2, 3, 4, 4}), 0U);
  EXPECT_EQ(ends_after({3, 1}, 1), 2U) << "back to an earlier item";
  EXPECT_EQ(ends_after({1, 0}, 0), 2U);
  EXPECT_EQ(ends_after({1, 4, 5, 6}, -1), 0U);
}

/// A vehicle that has flown its mission keeps the last item until it starts again.
TEST(StopWatch, IgnoresTheItemThatIsCurrentAtFirst) {
  EXPECT_EQ(ends_after({5, 5, 5}), 0U);
  EXPECT_EQ(ends_after({6, 7}), 0U);
  EXPECT_EQ(ends_after({9, 9, 1, 4, 5}), 5U);
}

}  // namespace
}  // namespace overfly::flight::live
