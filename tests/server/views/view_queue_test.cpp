#include "server/views/view_queue.hpp"

#include <gtest/gtest.h>

namespace overfly::server {
namespace {

/// A task with a number.
class NumberedTask final : public ViewTask {
 public:
  explicit NumberedTask(int number) : number_(number) {}
  bool run(ViewPainter& /*painter*/) override { return true; }
  void refuse(const Error& /*reason*/) override {}
  [[nodiscard]] int number() const { return number_; }

 private:
  int number_;
};

ViewQueue::Entry entry(std::uint64_t client, int stream, int number) {
  return {client, stream, std::make_unique<NumberedTask>(number)};
}

int number_of(const std::unique_ptr<ViewTask>& task) {
  const auto* numbered = dynamic_cast<const NumberedTask*>(task.get());
  return numbered == nullptr ? -1 : numbered->number();
}

TEST(ViewQueue, GivesTheNewestWishInTheOldPlace) {
  ViewQueue queue;
  EXPECT_FALSE(queue.push(entry(1, 1, 10)));
  EXPECT_FALSE(queue.push(entry(2, 1, 20)));
  EXPECT_EQ(number_of(queue.push(entry(1, 1, 30))), 10);
  const auto first = queue.pop();
  ASSERT_TRUE(first);
  EXPECT_EQ(first->client, 1U);
  EXPECT_EQ(number_of(first->task), 30);
  EXPECT_EQ(queue.pop()->client, 2U);
  EXPECT_FALSE(queue.pop());
}

TEST(ViewQueue, KeepsTheStreamsOfAClientApart) {
  ViewQueue queue;
  EXPECT_FALSE(queue.push(entry(1, 1, 10)));
  EXPECT_FALSE(queue.push(entry(1, 2, 10)));
  EXPECT_EQ(queue.pop()->stream, 1);
  EXPECT_EQ(queue.pop()->stream, 2);
}

TEST(ViewQueue, ForgetsAClientWhole) {
  ViewQueue queue;
  EXPECT_FALSE(queue.push(entry(1, 1, 10)));
  EXPECT_FALSE(queue.push(entry(1, 2, 10)));
  EXPECT_FALSE(queue.push(entry(2, 1, 10)));
  queue.forget(1);
  EXPECT_EQ(queue.pop()->client, 2U);
  EXPECT_TRUE(queue.empty());
}

TEST(ViewQueue, PassesOverWhatStandsAside) {
  ViewQueue queue;
  EXPECT_FALSE(queue.push(entry(1, 1, 10)));
  EXPECT_FALSE(queue.push(entry(2, 1, 20)));
  EXPECT_FALSE(queue.stand_aside(*queue.pop()));
  EXPECT_EQ(queue.pop()->client, 2U);
  EXPECT_TRUE(queue.empty());
  // A newer task of the stream replaces the one aside.
  EXPECT_EQ(number_of(queue.push(entry(1, 1, 30))), 10);
  EXPECT_TRUE(queue.empty());
  queue.release();
  EXPECT_EQ(number_of(queue.pop()->task), 30);
}

TEST(ViewQueue, LeavesOutWhatHasBecomeOldMeanwhile) {
  ViewQueue queue;
  EXPECT_FALSE(queue.push(entry(1, 1, 10)));
  auto popped = queue.pop();
  EXPECT_FALSE(queue.push(entry(1, 1, 20)));
  EXPECT_EQ(number_of(queue.stand_aside(std::move(*popped))), 10);
  EXPECT_EQ(number_of(queue.pop()->task), 20);
}

}  // namespace
}  // namespace overfly::server
