// Slices of large logs: read by an index they are the same as those of the whole log.
#include "flight/logs/index/log_index.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <stdlib.h>

#include <fstream>

#include "core/time.hpp"
#include "flight/logs/log_samples.hpp"
#include "flight/logs/probes/probe_log.hpp"
#include "flight/logs/truth/log_trajectory.hpp"
#include "tests/flight/logs/log_bytes.hpp"
#include "tests/support/support.hpp"

namespace overfly::flight::logs {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::Field;

LogBlock block(std::uint64_t begin, std::optional<std::int64_t> t_s, bool declares = false) {
  LogBlock made{{begin, begin + 10}, {}, {}, declares};
  if (t_s) {
    made.first_ns = *t_s * kNsPerS;
    made.last_ns = (*t_s + 20) * kNsPerS;
  }
  return made;
}

auto is_part(std::uint64_t begin, std::uint64_t end) {
  return ::testing::AllOf(Field(&FileRange::begin, begin), Field(&FileRange::end, end));
}

TEST(LogIndex, FindsThePartsOfASlice) {
  const LogIndex index = {block(0, std::nullopt, true),
                          block(10, 0),
                          block(20, 20, true),
                          block(30, 40),
                          block(40, 100),
                          block(50, std::nullopt),
                          block(60, 120),
                          block(70, 140)};
  const auto parts = [&](std::optional<std::int64_t> from_s, std::optional<std::int64_t> to_s) {
    LogSlice slice;
    if (from_s) slice.from_ns = *from_s * kNsPerS;
    if (to_s) slice.to_ns = *to_s * kNsPerS;
    return parts_for(index, slice);
  };
  EXPECT_THAT(parts(105, 109), ElementsAre(is_part(0, 10), is_part(20, 30), is_part(40, 50)));
  EXPECT_THAT(parts(105, 111), ElementsAre(is_part(0, 10), is_part(20, 30), is_part(40, 70)));
  EXPECT_THAT(parts(129, {}), ElementsAre(is_part(0, 10), is_part(20, 30), is_part(40, 80)));
  EXPECT_THAT(parts({}, 5), ElementsAre(is_part(0, 30)));
  EXPECT_THAT(parts(900, 950), ElementsAre(is_part(0, 10), is_part(20, 30)));
}

TEST(LogIndex, IsNotMadeOfAClockThatStartsAgain) {
  LogIndexBuilder builder;
  builder.time({0, 100});
  builder.end_block(10);
  builder.time({1, 5});
  EXPECT_FALSE(builder.finish(20).has_value());
}

/// A log of 67 MB of each format.
class SlicedLogs : public ::testing::TestWithParam<LogFormat> {
 protected:
  void SetUp() override {
    ASSERT_TRUE(write_probe_log(file_, GetParam(), kIndexedLogBytes).ok());
    const auto log = open_log(file_);
    ASSERT_TRUE(log.ok()) << log.error().message;
    fs::rename(beside_, aside_);
    // All but the first and last tenth of the flight, and a few seconds of it.
    const auto first_ns = log->streams[log->truth->position].first_ns;
    const auto last_ns = log->streams[log->truth->position].last_ns;
    ASSERT_TRUE(first_ns && last_ns);
    const std::int64_t middle_ns = (*first_ns + *last_ns) / 2;
    slices_ = {{middle_ns - 3 * kNsPerS, middle_ns + 3 * kNsPerS + 7},
               {*last_ns - 2 * kNsPerS, {}},
               {{}, *first_ns + kNsPerS},
               {*last_ns + kNsPerS, {}}};
  }
  void use_index(bool use) {
    std::error_code ignored;
    fs::remove(beside_, ignored);
    if (use) fs::copy(aside_, beside_);
  }

  overfly::testing::TemporaryFolder folder_;
  fs::path file_ = folder_.path() / "flight.log";
  fs::path beside_ = folder_.path() / "flight.log.overfly-index";
  fs::path aside_ = folder_.path() / "index";
  std::vector<LogSlice> slices_;
};

TEST_P(SlicedLogs, AreTheSameWithAndWithoutAnIndex) {
  for (const LogSlice& slice : slices_) {
    use_index(false);
    auto whole = open_log(file_, nullptr, {.slice = slice});
    ASSERT_TRUE(whole.ok()) << whole.error().message;
    EXPECT_TRUE(fs::exists(beside_));
    EXPECT_FALSE(whole->parts.empty());
    const auto indexed = open_log(file_, nullptr, {.slice = slice});
    ASSERT_TRUE(indexed.ok()) << indexed.error().message;
    std::uint64_t read_bytes = 0;
    for (const FileRange& part : indexed->parts) read_bytes += part.end - part.begin;
    // 20 s in addition to the slice: in DataFlash a seventh of the flight.
    EXPECT_LT(read_bytes, kIndexedLogBytes / 3);
    ASSERT_EQ(indexed->streams.size(), whole->streams.size());
    for (std::size_t i = 0; i < whole->streams.size(); ++i) {
      const StreamInfo& a = indexed->streams[i];
      const StreamInfo& b = whole->streams[i];
      EXPECT_EQ(a.description.name, b.description.name);
      EXPECT_EQ(a.messages, b.messages) << a.description.name;
      EXPECT_EQ(a.positions, b.positions) << a.description.name;
      EXPECT_EQ(a.attitudes, b.attitudes) << a.description.name;
      EXPECT_EQ(a.first_ns, b.first_ns) << a.description.name;
      EXPECT_EQ(a.last_ns, b.last_ns) << a.description.name;
      EXPECT_EQ(a.rate_hz, b.rate_hz) << a.description.name;
    }
    whole->parts.clear();
    const TrajectoryRequest request{"", slice.from_ns, slice.to_ns};
    const auto expected = read_log_trajectory(*whole, request);
    const auto trajectory = read_log_trajectory(*indexed, request);
    ASSERT_EQ(trajectory.ok(), expected.ok());
    if (!expected.ok()) continue;
    EXPECT_EQ(trajectory->warnings, expected->warnings);
    const auto expected_samples = read_log_samples(*whole, request);
    const auto samples = read_log_samples(*indexed, request);
    ASSERT_TRUE(samples.ok() && expected_samples.ok());
    ASSERT_EQ(samples->positions.size(), expected_samples->positions.size());
    ASSERT_EQ(samples->attitudes.size(), expected_samples->attitudes.size());
    EXPECT_EQ(samples->attitudes.front().t_ns, expected_samples->attitudes.front().t_ns);
    EXPECT_EQ(samples->attitudes.back().t_ns, expected_samples->attitudes.back().t_ns);
    EXPECT_EQ(trajectory->georeferenced, expected->georeferenced);
    ASSERT_EQ(trajectory->poses.size(), expected->poses.size());
    EXPECT_GT(expected->poses.size(), 30U);
    for (std::size_t i = 0; i < expected->poses.size(); ++i) {
      ASSERT_EQ(trajectory->poses[i].t_ns, expected->poses[i].t_ns);
      ASSERT_EQ(trajectory->poses[i].position, expected->poses[i].position);
      ASSERT_EQ(trajectory->poses[i].R_ned_body.coeffs(), expected->poses[i].R_ned_body.coeffs());
    }
  }
}

INSTANTIATE_TEST_SUITE_P(AllFormats,
                         SlicedLogs,
                         ::testing::ValuesIn(kProbeFormats),
                         [](const auto& parameter) {
                           return std::string(to_string(parameter.param));
                         });

class LogIndexFile : public ::testing::Test {
 protected:
  void SetUp() override {
    testing::write_bytes(log_, testing::Bytes(200'000, 7));
    identity_ = identify_log(log_).value();
    index_ = {block(0, 0, true), block(10, std::nullopt), block(20, -5)};
    index_[2].bytes.end = identity_.size_bytes;
  }

  overfly::testing::TemporaryFolder folder_;
  fs::path log_ = folder_.path() / "flight.bin";
  fs::path beside_ = folder_.path() / "flight.bin.overfly-index";
  LogIdentity identity_;
  LogIndex index_;
};

TEST_F(LogIndexFile, KeepsAllBlocks) {
  save_log_index(log_, identity_, index_);
  ASSERT_TRUE(fs::exists(beside_));
  const auto loaded = load_log_index(log_, identity_);
  ASSERT_TRUE(loaded.has_value());
  ASSERT_EQ(loaded->size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ((*loaded)[i].bytes.begin, index_[i].bytes.begin);
    EXPECT_EQ((*loaded)[i].bytes.end, index_[i].bytes.end);
    EXPECT_EQ((*loaded)[i].first_ns, index_[i].first_ns);
    EXPECT_EQ((*loaded)[i].last_ns, index_[i].last_ns);
    EXPECT_EQ((*loaded)[i].declares, index_[i].declares);
  }
}

TEST_F(LogIndexFile, IsIgnoredIfItIsDamaged) {
  save_log_index(log_, identity_, index_);
  const std::string whole = overfly::testing::read_text(beside_);
  for (std::size_t i = 0; i < whole.size(); ++i) {
    std::string changed = whole;
    changed[i] = static_cast<char>(changed[i] ^ 1);
    overfly::testing::write_text(beside_, changed);
    EXPECT_FALSE(load_log_index(log_, identity_).has_value()) << i;
    overfly::testing::write_text(beside_, whole.substr(0, i));
    EXPECT_FALSE(load_log_index(log_, identity_).has_value()) << i;
  }
}

TEST_F(LogIndexFile, IsIgnoredIfTheLogHasChanged) {
  save_log_index(log_, identity_, index_);
  ASSERT_TRUE(load_log_index(log_, identity_).has_value());
  const fs::file_time_type modified = fs::last_write_time(log_);
  // One byte at the end, with the same size and time.
  testing::Bytes bytes(200'000, 7);
  bytes.back() = 8;
  testing::write_bytes(log_, bytes);
  fs::last_write_time(log_, modified);
  const auto changed = identify_log(log_);
  ASSERT_TRUE(changed.has_value());
  EXPECT_EQ(changed->size_bytes, identity_.size_bytes);
  EXPECT_EQ(changed->modified_ns, identity_.modified_ns);
  EXPECT_FALSE(load_log_index(log_, *changed).has_value());
  EXPECT_FALSE(identify_log(folder_.path() / "absent").has_value());
}

TEST_F(LogIndexFile, IsInTheCacheFolderWhereTheLogsFolderIsReadOnly) {
  // Also for the superuser, whom the system would let write there.
  const fs::path cache = folder_.path() / "cache";
  fs::create_directory(folder_.path() / "logs");
  const fs::path log = folder_.path() / "logs" / "flight.bin";
  fs::copy(log_, log);
  const LogIdentity identity = identify_log(log).value();
  fs::permissions(log.parent_path(), fs::perms::owner_read | fs::perms::owner_exec);
  ASSERT_EQ(::setenv("OVERFLY_CACHE", cache.c_str(), 1), 0);
  save_log_index(log, identity, index_);
  EXPECT_TRUE(load_log_index(log, identity).has_value());
  EXPECT_EQ(std::distance(fs::directory_iterator(cache / "log-indices"), {}), 1);
  EXPECT_EQ(std::distance(fs::directory_iterator(log.parent_path()), {}), 1);
  ASSERT_EQ(::unsetenv("OVERFLY_CACHE"), 0);
  fs::permissions(log.parent_path(), fs::perms::owner_all);
}

}  // namespace
}  // namespace overfly::flight::logs
