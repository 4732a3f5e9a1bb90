// Slices of MCAP files by their own index: the same as those of the whole file, or not at all.
#include "flight/logs/mcap/mcap_parts.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <functional>

#include "flight/logs/truth/log_trajectory.hpp"
#include "tests/flight/logs/indexed_mcap.hpp"
#include "tests/flight/logs/log_bytes.hpp"
#include "tests/support/support.hpp"

namespace overfly::flight::logs {
namespace {

namespace fs = std::filesystem;
using testing::append;
using testing::Bytes;
using ::testing::Contains;
using ::testing::HasSubstr;
using testing::IndexedMcap;
using ::testing::IsEmpty;
using testing::mcap_channel;
using testing::mcap_message;
using testing::mcap_schema;
using ::testing::Not;
using testing::Wire;

constexpr std::int64_t kBeginNs = 1'700'000'000'000'000'000;
/// Recording comes that much after the stamps.
constexpr std::int64_t kDelayNs = 300'000'000;
/// From this chunk on there is a third topic.
constexpr int kLateChunk = 30;

Bytes early_declarations() {
  Bytes bytes = mcap_schema(1, "nav_msgs/msg/Odometry");
  append(bytes, mcap_schema(2, "sensor_msgs/msg/Imu"));
  append(bytes, mcap_channel(1, 1, "/odometry", "cdr"));
  append(bytes, mcap_channel(2, 2, "/imu", "cdr"));
  return bytes;
}
Bytes late_declarations() {
  Bytes bytes = mcap_schema(3, "sensor_msgs/msg/NavSatFix");
  append(bytes, mcap_channel(3, 3, "/fix", "cdr"));
  return bytes;
}
Bytes all_declarations() {
  Bytes bytes = early_declarations();
  append(bytes, late_declarations());
  return bytes;
}

/// Messages of a second, 10 of each topic, and `padding` bytes of another kind.
Bytes second_of_flight(int second, std::size_t padding, std::int64_t delay_ns = kDelayNs) {
  Bytes bytes;
  if (second == 0) bytes = early_declarations();
  if (second == kLateChunk) append(bytes, late_declarations());
  for (int i = 0; i < 10; ++i) {
    const std::int64_t t_ns = kBeginNs + second * kNsPerS + i * kNsPerS / 10;
    const auto recorded_ns = static_cast<std::uint64_t>(t_ns + delay_ns);
    const double t = second + 0.1 * i;
    const Eigen::Quaterniond R(Eigen::AngleAxisd(0.01 * t, Eigen::Vector3d::UnitZ()));
    append(bytes,
           mcap_message(
               1,
               recorded_ns,
               testing::odometry(Wire::kCdrLittle, t_ns, Eigen::Vector3d(25.0 * t, t, 300.0), R)));
    append(bytes, mcap_message(2, recorded_ns, testing::imu_message(Wire::kCdrLittle, t_ns, R)));
    if (second >= kLateChunk) {
      append(
          bytes,
          mcap_message(3,
                       recorded_ns,
                       testing::nav_sat_fix(Wire::kCdrLittle, t_ns, 47.0, 8.0 + 1e-4 * t, 500.0)));
    }
  }
  if (padding > 0) append(bytes, testing::mcap_record(0x80, Bytes(padding, 7)));
  return bytes;
}

std::vector<std::uint16_t> channels_of(int second) {
  return second >= kLateChunk ? std::vector<std::uint16_t>{1, 2, 3}
                              : std::vector<std::uint16_t>{1, 2};
}

IndexedMcap flight_of(int seconds, std::size_t padding = 0) {
  IndexedMcap file;
  for (int second = 0; second < seconds; ++second) {
    const std::int64_t first_ns = kBeginNs + second * kNsPerS + kDelayNs;
    file.add_chunk(second_of_flight(second, padding),
                   first_ns,
                   first_ns + 9 * kNsPerS / 10,
                   channels_of(second));
  }
  return file;
}

LogSlice seconds_slice(int from_s, int to_s) {
  return {kBeginNs + from_s * kNsPerS, kBeginNs + to_s * kNsPerS};
}

class McapParts : public ::testing::Test {
 protected:
  Result<std::vector<FileRange>> parts_of(const Bytes& bytes, const LogSlice& slice) {
    testing::write_bytes(file_, bytes);
    return mcap_parts_for(file_, slice, nullptr);
  }
  /// Why an index is not used; empty if it is.
  std::string refusal(const std::function<void(IndexedMcap&)>& spoil,
                      bool right_crc = true,
                      const Bytes& declarations = all_declarations()) {
    IndexedMcap file = flight_of(100);
    spoil(file);
    file.finish(declarations, right_crc);
    const auto parts = parts_of(file.bytes, seconds_slice(50, 52));
    return parts ? "" : parts.error().message;
  }

  overfly::testing::TemporaryFolder folder_;
  fs::path file_ = folder_.path() / "flight.mcap";
};

TEST_F(McapParts, AreThoseOfTheSliceAndOfWhatDeclares) {
  IndexedMcap file = flight_of(200);
  const std::vector<testing::IndexedChunk> chunks = file.chunks;
  file.finish(all_declarations());
  const auto parts = parts_of(file.bytes, seconds_slice(100, 102));
  ASSERT_TRUE(parts.ok()) << parts.error().message;
  // The first four chunks, those in which the third topic begins, and 12 s around the slice: the
  // margin of parts_for and the delay of 2 s that stamps may have.
  ASSERT_EQ(parts->size(), 3U);
  EXPECT_EQ((*parts)[0].begin, 0U);
  EXPECT_EQ((*parts)[0].end, chunks[4].offset);
  EXPECT_EQ((*parts)[1].begin, chunks[kLateChunk].offset);
  EXPECT_EQ((*parts)[1].end, chunks[kLateChunk + 4].offset);
  EXPECT_EQ((*parts)[2].begin, chunks[87].offset);
  EXPECT_EQ((*parts)[2].end, chunks[114].offset);
  EXPECT_TRUE(parts_of(file.bytes, seconds_slice(10, 190)).value().empty());
}

TEST_F(McapParts, HaveWhatTheIndexLeavesOut) {
  IndexedMcap file = flight_of(200);
  const testing::IndexedChunk gone = file.chunks[150];
  file.chunks.erase(file.chunks.begin() + 150);
  file.finish(all_declarations());
  const auto parts = parts_of(file.bytes, seconds_slice(100, 102));
  ASSERT_TRUE(parts.ok()) << parts.error().message;
  EXPECT_TRUE(std::any_of(parts->begin(), parts->end(), [&](const FileRange& part) {
    return part.begin <= gone.offset && part.end >= gone.offset + gone.length;
  }));
}

TEST_F(McapParts, AreNotMadeOfAWrongIndex) {
  EXPECT_EQ(refusal([](IndexedMcap&) {}), "");
  EXPECT_THAT(refusal([](IndexedMcap& file) { file.chunks[60].offset += 1; }),
              HasSubstr("overlaps"));
  EXPECT_THAT(refusal([](IndexedMcap& file) {
                file.chunks[60].offset += 1;
                file.chunks[60].length -= 1;
              }),
              HasSubstr("does not agree with the chunk there"));
  EXPECT_THAT(refusal([](IndexedMcap& file) { file.chunks[60].offset = 0; }),
              HasSubstr("overlaps"));
  EXPECT_THAT(refusal([](IndexedMcap& file) { file.chunks[60] = file.chunks[61]; }),
              HasSubstr("overlaps"));
  EXPECT_THAT(refusal([](IndexedMcap& file) { file.chunks[99].length = ~std::uint64_t{0} - 5; }),
              HasSubstr("reaches beyond the data"));
  EXPECT_THAT(refusal([](IndexedMcap& file) { file.chunks[99].offset = ~std::uint64_t{0}; }),
              HasSubstr("reaches beyond the data"));
  EXPECT_THAT(refusal([](IndexedMcap& file) { file.chunks[99].index_length += 1; }),
              HasSubstr("reaches beyond the data"));
  EXPECT_THAT(refusal([](IndexedMcap& file) { file.chunks[60].index_length -= 1; }),
              HasSubstr("wrong message indexes"));
  EXPECT_THAT(refusal([](IndexedMcap& file) { file.chunks[60].index_length = 0; }),
              HasSubstr("no message indexes"));
  EXPECT_THAT(refusal([](IndexedMcap& file) { file.chunks[60].last_ns += 1; }),
              HasSubstr("does not agree with the chunk there"));
  EXPECT_THAT(refusal([](IndexedMcap& file) { file.chunks[60].first_ns = ~std::uint64_t{0}; }),
              HasSubstr("impossible times"));
  EXPECT_THAT(refusal([](IndexedMcap& file) { file.chunks[60].size += 1; }),
              HasSubstr("does not agree with the chunk there"));
  EXPECT_THAT(refusal([](IndexedMcap&) {}, false), HasSubstr("summary has a wrong checksum"));
  EXPECT_THAT(refusal([](IndexedMcap& file) { file.chunks.clear(); }),
              HasSubstr("no chunk indexes"));
}

TEST_F(McapParts, AreNotMadeWhereTheMessagesSayOtherwise) {
  const auto with_second = [&](const Bytes& records, std::int64_t first_ns, bool right_crc = true) {
    IndexedMcap file = flight_of(51);
    file.add_chunk(records, first_ns, first_ns + 9 * kNsPerS / 10, channels_of(51), right_crc);
    for (int second = 52; second < 100; ++second) {
      const std::int64_t begin_ns = kBeginNs + second * kNsPerS + kDelayNs;
      file.add_chunk(
          second_of_flight(second, 0), begin_ns, begin_ns + 9 * kNsPerS / 10, channels_of(second));
    }
    file.finish(all_declarations());
    const auto parts = parts_of(file.bytes, seconds_slice(50, 52));
    return parts ? "" : parts.error().message;
  };
  const std::int64_t first_ns = kBeginNs + 51 * kNsPerS + kDelayNs;
  EXPECT_EQ(with_second(second_of_flight(51, 0), first_ns), "");
  EXPECT_THAT(with_second(second_of_flight(51, 0), first_ns, false), HasSubstr("damaged"));
  EXPECT_THAT(with_second(second_of_flight(51, 0), first_ns - kNsPerS),
              HasSubstr("messages outside of its times"));
  EXPECT_THAT(with_second(second_of_flight(51, 0, kDelayNs + 2 * kNsPerS), first_ns + 2 * kNsPerS),
              HasSubstr("more than 2 s away from the times of recording"));
  Bytes cut = second_of_flight(51, 0);
  cut.pop_back();
  EXPECT_THAT(with_second(cut, first_ns), HasSubstr("damaged"));
  // A channel of the summary that nothing of what is read declares.
  Bytes more = all_declarations();
  append(more, mcap_channel(9, 3, "/other", "cdr"));
  EXPECT_THAT(refusal([](IndexedMcap&) {}, true, more), HasSubstr("not declared"));
}

TEST_F(McapParts, NeedASummary) {
  IndexedMcap file = flight_of(100);
  Bytes bytes = file.bytes;
  append(bytes, testing::mcap_end());
  EXPECT_EQ(parts_of(bytes, seconds_slice(50, 52)).error().code, ErrorCode::kNotFound);
  EXPECT_EQ(parts_of(file.bytes, seconds_slice(50, 52)).error().code, ErrorCode::kNotFound);
  EXPECT_EQ(parts_of({}, seconds_slice(50, 52)).error().code, ErrorCode::kNotFound);
  // A summary that begins anywhere.
  file.finish(all_declarations());
  for (const std::uint64_t start : {std::uint64_t{1}, std::uint64_t{500}, ~std::uint64_t{0}}) {
    Bytes wrong = file.bytes;
    for (int i = 0; i < 8; ++i) {
      wrong[wrong.size() - 8 - 20 + static_cast<std::size_t>(i)] =
          static_cast<std::uint8_t>(start >> (8 * i));
    }
    EXPECT_FALSE(parts_of(wrong, seconds_slice(50, 52)).ok()) << start;
  }
  // Cut anywhere, it is refused, and nothing else happens.
  for (std::size_t cut = 1; cut < 3000; cut += 7) {
    const Bytes shorter(file.bytes.begin(), file.bytes.end() - static_cast<std::ptrdiff_t>(cut));
    EXPECT_FALSE(parts_of(shorter, seconds_slice(50, 52)).ok()) << cut;
  }
}

/// @pre of the same file
void expect_equal_slices(const OpenedLog& a, const OpenedLog& b) {
  ASSERT_EQ(a.streams.size(), b.streams.size());
  for (std::size_t i = 0; i < a.streams.size(); ++i) {
    EXPECT_EQ(a.streams[i].description.name, b.streams[i].description.name);
    EXPECT_EQ(a.streams[i].messages, b.streams[i].messages);
    EXPECT_EQ(a.streams[i].positions, b.streams[i].positions);
    EXPECT_EQ(a.streams[i].attitudes, b.streams[i].attitudes);
    EXPECT_EQ(a.streams[i].first_ns, b.streams[i].first_ns);
    EXPECT_EQ(a.streams[i].last_ns, b.streams[i].last_ns);
    EXPECT_EQ(a.streams[i].rate_hz, b.streams[i].rate_hz);
  }
  const TrajectoryRequest request{"", a.slice.from_ns, a.slice.to_ns};
  const auto poses_a = read_log_trajectory(a, request);
  const auto poses_b = read_log_trajectory(b, request);
  ASSERT_EQ(poses_a.ok(), poses_b.ok());
  if (!poses_a) return;
  ASSERT_EQ(poses_a->poses.size(), poses_b->poses.size());
  for (std::size_t i = 0; i < poses_a->poses.size(); ++i) {
    ASSERT_EQ(poses_a->poses[i].t_ns, poses_b->poses[i].t_ns);
    ASSERT_EQ(poses_a->poses[i].position, poses_b->poses[i].position);
    ASSERT_EQ(poses_a->poses[i].R_ned_body.coeffs(), poses_b->poses[i].R_ned_body.coeffs());
  }
}

TEST_F(McapParts, GiveTheSliceOfTheWholeFile) {
  IndexedMcap file = flight_of(660, 100'000);
  file.finish(all_declarations());
  ASSERT_GT(file.bytes.size(), kIndexedLogBytes);
  testing::write_bytes(file_, file.bytes);
  const fs::path beside = file_.string() + ".overfly-index";
  const LogSlice slices[] = {
      seconds_slice(300, 309), seconds_slice(5, 8), seconds_slice(655, 900), {{}, kBeginNs + 1}};
  std::vector<OpenedLog> by_own_index;
  for (const LogSlice& slice : slices) {
    auto log = open_log(file_, nullptr, {.slice = slice});
    ASSERT_TRUE(log.ok()) << log.error().message;
    EXPECT_FALSE(log->parts.empty());
    EXPECT_THAT(log->warnings, Not(Contains(HasSubstr("own index"))));
    EXPECT_FALSE(fs::exists(beside));  // nothing was read completely
    std::uint64_t read_bytes = 0;
    for (const FileRange& part : log->parts) read_bytes += part.end - part.begin;
    EXPECT_LT(read_bytes, kIndexedLogBytes / 10);
    by_own_index.push_back(std::move(*log));
  }
  for (const OpenedLog& log : by_own_index) {
    OpenedLog whole = log;
    whole.parts.clear();
    fs::remove(beside);
    // The reference: all bytes are read, which also makes an index of ours.
    ASSERT_TRUE(open_log(file_).ok());
    ASSERT_TRUE(fs::exists(beside));
    const auto by_ours = open_log(file_, nullptr, {.slice = log.slice});
    ASSERT_TRUE(by_ours.ok());
    expect_equal_slices(log, *by_ours);
    expect_equal_slices(log, whole);
  }
  // With a wrong index of the file the result is the same, and the note says why.
  fs::remove(beside);
  Bytes wrong = file.bytes;
  wrong[wrong.size() - 100] ^= 1U;
  testing::write_bytes(file_, wrong);
  const auto log = open_log(file_, nullptr, {.slice = slices[0]});
  ASSERT_TRUE(log.ok()) << log.error().message;
  EXPECT_THAT(log->warnings,
              Contains("the file's own index was not used, and the whole log was read: its summary "
                       "has a wrong checksum"));
  EXPECT_TRUE(fs::exists(beside));
  expect_equal_slices(*log, by_own_index[0]);
}

}  // namespace
}  // namespace overfly::flight::logs
