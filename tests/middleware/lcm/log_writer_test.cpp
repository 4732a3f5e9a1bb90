#include "middleware/lcm/log_writer.hpp"

#include <gmock/gmock.h>

#include <lcm/lcm-cpp.hpp>
#include <overfly_lcm/truth_t.hpp>

#include "tests/support/support.hpp"

namespace overfly::lcm {
namespace {

TEST(LcmLogWriter, WritesEventsThatLcmReadsBack) {
  const overfly::testing::TemporaryFolder folder;
  const auto file = folder.path() / "a.lcm";
  const Image image(4, 2, 1, 9);
  constexpr std::int64_t kEpochNs = 1'700'000'000'000'000'000;
  {
    const auto writer = LogWriter::create(file, kEpochNs).value();
    ASSERT_TRUE(writer->write_calibration("C_", "belly", {}, 1'000).ok());
    ASSERT_TRUE(writer->write_image("C_", {3, 97'000'000, 5'000, image}).ok());
    ASSERT_TRUE(
        writer->write_truth("C_", {3, 96'000'000, 97'000'000, {{0.5, 0.5, -0.5, 0.5}, {1, 2, 3}}})
            .ok());
    ASSERT_TRUE(writer->finish().ok());
  }
  ::lcm::LogFile log(file.string(), "r");
  ASSERT_TRUE(log.good());
  std::vector<std::string> channels;
  overfly_lcm::truth_t truth{};
  std::int64_t last_us = 0;
  while (const ::lcm::LogEvent* event = log.readNextEvent()) {
    EXPECT_EQ(event->eventnum, static_cast<std::int64_t>(channels.size()));
    channels.push_back(event->channel);
    last_us = event->timestamp;
    if (event->channel == "C_TRUTH") {
      EXPECT_GT(truth.decode(event->data, 0, event->datalen), 0);
    }
  }
  EXPECT_THAT(channels, ::testing::ElementsAre("C_CALIBRATION", "C_IMAGE", "C_TIME", "C_TRUTH"));
  EXPECT_EQ(last_us, 1'700'000'000'097'000);
  EXPECT_EQ(truth.t_ns, 96'000'000);
  EXPECT_EQ(truth.stamp_ns, 97'000'000);
  EXPECT_EQ(truth.position[2], 3.0);
  // x y z w of the quaternion made of w x y z = 0.5 0.5 -0.5 0.5.
  EXPECT_THAT(truth.orientation, ::testing::ElementsAre(0.5, -0.5, 0.5, 0.5));
}

TEST(LcmLogWriter, NamesTheFileThatCannotBeMade) {
  const overfly::testing::TemporaryFolder folder;
  const auto writer = LogWriter::create(folder.path() / "none" / "a.lcm", 0);
  ASSERT_FALSE(writer.ok());
  EXPECT_EQ(writer.error().code, ErrorCode::kIo);
  EXPECT_THAT(writer.error().message, ::testing::HasSubstr("none/a.lcm"));
}

/// Every byte that is written to /dev/full fails for want of space.
TEST(LcmLogWriter, SaysWhenTheDiskIsFull) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  const auto writer = LogWriter::create("/dev/full", 0).value();
  const Image image(64, 64, 1);
  Status status = writer->write_image("C_", {0, 0, 0, image});
  if (status) status = writer->finish();
  ASSERT_FALSE(status.ok());
  EXPECT_EQ(status.error().code, ErrorCode::kIo);
  EXPECT_THAT(status.error().message, ::testing::HasSubstr("/dev/full"));
}

}  // namespace
}  // namespace overfly::lcm
