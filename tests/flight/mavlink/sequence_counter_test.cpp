#include "flight/mavlink/sequence_counter.hpp"

#include <gtest/gtest.h>

#include <initializer_list>

namespace overfly::flight::mavlink {
namespace {

SequenceCounter counted(std::initializer_list<int> sequences) {
  SequenceCounter counter;
  for (const int sequence : sequences) (void)counter.take(static_cast<std::uint8_t>(sequence));
  return counter;
}

TEST(SequenceCounter, CountsGapsAcrossTheWrap) {
  EXPECT_EQ(counted({250, 251, 253, 1, 2}).lost(), 1U + 3U);  // 252, and 254, 255, 0
  EXPECT_EQ(counted({10, 137}).lost(), 126U);
}

TEST(SequenceCounter, TakesLateMessagesForLostOnesAndDuplicatesForNothing) {
  const SequenceCounter late = counted({254, 1, 255, 0, 2});
  EXPECT_EQ(late.lost(), 0U);
  EXPECT_EQ(late.late(), 2U);
  const SequenceCounter twice = counted({7, 8, 8, 7, 9});
  EXPECT_EQ(twice.lost(), 0U);
  EXPECT_EQ(twice.duplicates(), 2U);
  // The numbers before the first message are not missing.
  EXPECT_EQ(counted({7, 5, 8}).lost(), 0U);
}

TEST(SequenceCounter, RemembersSixtyFourNumbers) {
  SequenceCounter counter;
  (void)counter.take(0);
  (void)counter.take(100);  // 1 to 99 are missing
  EXPECT_EQ(counter.take(37), SequenceCounter::Verdict::kLate);
  EXPECT_EQ(counter.take(37), SequenceCounter::Verdict::kDuplicate);
  EXPECT_EQ(counter.take(36), SequenceCounter::Verdict::kMisplaced);
  EXPECT_EQ(counter.lost(), 98U);
}

TEST(SequenceCounter, BelievesInARestartAfterTwoMessages) {
  SequenceCounter counter = counted({100, 101, 0});
  EXPECT_EQ(counter.misplaced(), 1U);
  EXPECT_EQ(counter.take(102), SequenceCounter::Verdict::kInOrder);
  EXPECT_EQ(counter.take(5), SequenceCounter::Verdict::kMisplaced);
  EXPECT_EQ(counter.take(6), SequenceCounter::Verdict::kRestart);
  EXPECT_EQ(counter.take(8), SequenceCounter::Verdict::kAfterLoss);
  EXPECT_EQ(counter.lost(), 1U);
  EXPECT_EQ(counter.restarts(), 1U);
  EXPECT_EQ(counter.misplaced(), 1U);
}

}  // namespace
}  // namespace overfly::flight::mavlink
