#include "server/views/view_queue.hpp"
#include "server/views/picture_request.hpp"

#include <gtest/gtest.h>

namespace overfly::server {
namespace {

ViewQueue::Entry entry(std::uint64_t client, int stream, std::int64_t t_ns) {
  PictureRequest request;
  request.t_ns = t_ns;
  return {client, stream, request, [](const Result<Picture>&) {}};
}

TEST(ViewQueue, GivesTheNewestWishInTheOldPlace) {
  ViewQueue queue;
  EXPECT_FALSE(queue.push(entry(1, 1, 10)));
  EXPECT_FALSE(queue.push(entry(2, 1, 20)));
  EXPECT_TRUE(queue.push(entry(1, 1, 30)));
  const auto first = queue.pop();
  ASSERT_TRUE(first);
  EXPECT_EQ(first->client, 1U);
  EXPECT_EQ(first->request.t_ns, 30);
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
  // A newer request of the stream replaces the one aside.
  EXPECT_TRUE(queue.push(entry(1, 1, 30)));
  EXPECT_TRUE(queue.empty());
  queue.release();
  EXPECT_EQ(queue.pop()->request.t_ns, 30);
}

TEST(ViewQueue, LeavesOutWhatHasBecomeOldMeanwhile) {
  ViewQueue queue;
  EXPECT_FALSE(queue.push(entry(1, 1, 10)));
  auto popped = queue.pop();
  EXPECT_FALSE(queue.push(entry(1, 1, 20)));
  EXPECT_TRUE(queue.stand_aside(std::move(*popped)));
  EXPECT_EQ(queue.pop()->request.t_ns, 20);
}

}  // namespace
}  // namespace overfly::server
