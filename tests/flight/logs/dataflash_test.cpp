#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/motion/pose.hpp"
#include "core/time.hpp"
#include "flight/logs/dataflash/record_format.hpp"
#include "flight/logs/truth/log_trajectory.hpp"
#include "tests/flight/logs/log_bytes.hpp"
#include "tests/support/support.hpp"

namespace overfly::flight::logs {
namespace {

using testing::append;
using testing::Bytes;
using ::testing::Contains;
using testing::format_record;
using ::testing::HasSubstr;
using testing::put;
using testing::put_text;
using testing::record_header;

/// A record of the letters "QLLf": POS of a flight to the north.
Bytes pos_record(std::uint64_t time_us, std::int32_t lat) {
  Bytes record = record_header(2);
  put(record, time_us);
  put(record, lat);
  put(record, std::int32_t{80000000});
  put(record, 500.0F);
  return record;
}

/// "Qccc": angles in hundredths of a degree.
Bytes att_record(std::uint64_t time_us) {
  Bytes record = record_header(3);
  put(record, time_us);
  for (const std::int16_t value : {1000, -500, 9000}) put(record, value);
  return record;
}

Bytes declarations() {
  Bytes bytes = format_record(0x80, 89, "FMT", "BBnNZ", "Type,Length,Name,Format,Columns");
  append(bytes, format_record(2, 23, "POS", "QLLf", "TimeUS,Lat,Lng,Alt"));
  append(bytes, format_record(3, 17, "ATT", "Qccc", "TimeUS,Roll,Pitch,Yaw"));
  return bytes;
}

Result<OpenedLog> open_bytes(const overfly::testing::TemporaryFolder& folder, const Bytes& bytes) {
  testing::write_bytes(folder.path() / "flight.bin", bytes);
  return open_log(folder.path() / "flight.bin");
}

TEST(Dataflash, ReadsEveryLetter) {
  const Bytes declaration = format_record(9, 250, "ALL", "bBhHiIfdcCeELMqQ", "");
  Bytes record = record_header(9);
  put(record, std::int8_t{-5});
  put(record, std::uint8_t{250});
  put(record, std::int16_t{-300});
  put(record, std::uint16_t{60000});
  put(record, std::int32_t{-70000});
  put(record, std::uint32_t{4000000000U});
  put(record, 1.5F);
  put(record, -2.25);
  put(record, std::int16_t{-150});
  put(record, std::uint16_t{40000});
  put(record, std::int32_t{-12345});
  put(record, std::uint32_t{12345});
  put(record, std::int32_t{-353564430});
  put(record, std::uint8_t{10});
  put(record, std::int64_t{-5000000000});
  put(record, std::uint64_t{18000000000000000000U});
  const auto format = read_format(declaration);
  ASSERT_TRUE(format);
  const std::vector<double> wanted = {-5,
                                      250,
                                      -300,
                                      60000,
                                      -70000,
                                      4e9,
                                      1.5,
                                      -2.25,
                                      -1.5,
                                      400,
                                      -123.45,
                                      123.45,
                                      -35.3564430,
                                      10,
                                      -5e9,
                                      1.8e19};
  ASSERT_EQ(format->fields.size(), wanted.size());
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    EXPECT_DOUBLE_EQ(number_in(format->fields[i], record), wanted[i]) << format->fields[i].letter;
  }
}

TEST(Dataflash, ReadsTextsAndHalfFloats) {
  const auto format =
      read_format(format_record(9, 3 + 4 + 16 + 64 + 64 + 10, "TXT", "nNZaggggg", "A,B,C,D,E"));
  ASSERT_TRUE(format);
  ASSERT_EQ(format->fields.size(), 9U);
  Bytes record = record_header(9);
  put_text(record, "abcd", 4);
  put_text(record, "sixteen letters!", 16);
  put_text(record, std::string("bad\x02"), 64);
  record.resize(record.size() + 64, 1);
  // IEEE 754 binary16: 1, -2, the smallest subnormal number, infinity, the largest number.
  for (const int half : {0x3C00, 0xC000, 0x0001, 0x7C00, 0x7BFF}) {
    put(record, static_cast<std::uint16_t>(half));
  }
  EXPECT_EQ(text_in(format->fields[0], record), "abcd");
  EXPECT_EQ(text_in(format->fields[1], record), "sixteen letters!");
  EXPECT_EQ(text_in(format->fields[2], record), "bad?");
  EXPECT_TRUE(std::isnan(number_in(format->fields[3], record)));
  EXPECT_EQ(number_in(format->fields[4], record), 1.0);
  EXPECT_EQ(number_in(format->fields[5], record), -2.0);
  EXPECT_DOUBLE_EQ(number_in(format->fields[6], record), 5.9604644775390625e-8);
  EXPECT_TRUE(std::isinf(number_in(format->fields[7], record)));
  EXPECT_EQ(number_in(format->fields[8], record), 65504.0);
  EXPECT_EQ(format->fields[5].name, "");  // fewer labels than letters
}

TEST(Dataflash, EndsTheFieldsWhereADeclarationContradictsItself) {
  EXPECT_EQ(read_format(format_record(9, 13, "AB", "QdQ", "A,B,C"))->fields.size(), 1U);
  EXPECT_EQ(read_format(format_record(9, 100, "AB", "Q?Q", "A,B,C"))->fields.size(), 1U);
  EXPECT_FALSE(read_format(format_record(9, 2, "AB", "B", "A")));
  EXPECT_FALSE(read_format(format_record(9, 20, "", "B", "A")));
  EXPECT_FALSE(read_format(format_record(0x80, 20, "FMT", "B", "A")));
}

TEST(Dataflash, JoinsPositionsWithInterpolatedAttitudes) {
  Bytes bytes = declarations();
  for (std::uint32_t i = 0; i < 50; ++i) {
    append(bytes, att_record(1'000'000 + 20'000 * i));
    append(bytes, pos_record(1'005'000 + 20'000 * i, 470000000 + static_cast<int>(45 * i)));
  }
  const overfly::testing::TemporaryFolder folder;
  const auto log = open_bytes(folder, bytes);
  ASSERT_TRUE(log.ok()) << log.error().message;
  EXPECT_EQ(log->format, LogFormat::kDataFlash);
  const auto trajectory = read_log_trajectory(*log, {"", 1'200'000'000, 1'700'000'000});
  ASSERT_TRUE(trajectory.ok()) << trajectory.error().message;
  EXPECT_EQ(trajectory->poses.size(), 25U);
  EXPECT_EQ(trajectory->poses.front().t_ns, 1'205'000'000);
  EXPECT_NEAR(trajectory->poses.front().position.x(), 47.0 + 45e-7 * 10, 1e-12);
  const auto wanted = Eigen::AngleAxisd(rad_from_deg(90.0), Eigen::Vector3d::UnitZ()) *
                      Eigen::AngleAxisd(rad_from_deg(-5.0), Eigen::Vector3d::UnitY()) *
                      Eigen::AngleAxisd(rad_from_deg(10.0), Eigen::Vector3d::UnitX());
  EXPECT_LT(rotation_angle_rad(trajectory->poses.front().R_ned_body, Eigen::Quaterniond(wanted)),
            1e-6);
}

TEST(Dataflash, NamesTheModesOfAPlane) {
  Bytes bytes = declarations();
  append(bytes, format_record(4, 75, "MSG", "QZ", "TimeUS,Message"));
  append(bytes, format_record(5, 14, "MODE", "QMBB", "TimeUS,Mode,ModeNum,Rsn"));
  const auto mode = [](std::uint8_t number) {
    Bytes record = record_header(5);
    put(record, std::uint64_t{2'000'000});
    for (const std::uint8_t value : {number, number, std::uint8_t{1}}) record.push_back(value);
    return record;
  };
  append(bytes, mode(10));
  Bytes text = record_header(4);
  put(text, std::uint64_t{2'000'000});
  put_text(text, "ArduPlane V4.6.0-dev", 64);
  append(bytes, text);
  for (const int number : {10, 9, 200}) append(bytes, mode(static_cast<std::uint8_t>(number)));
  const overfly::testing::TemporaryFolder folder;
  const auto log = open_bytes(folder, bytes);
  ASSERT_TRUE(log.ok()) << log.error().message;
  std::vector<std::string> texts;
  for (const LogEvent& event : log->events) texts.push_back(event.text);
  EXPECT_THAT(texts,
              ::testing::ElementsAre(
                  "mode 10", "ArduPlane V4.6.0-dev", "mode 10 (AUTO)", "mode 9", "mode 200"));
}

TEST(Dataflash, SplitsStreamsByTheInstanceThatFmtuNames) {
  Bytes bytes = declarations();
  append(bytes, format_record(5, 44, "FMTU", "QBNN", "TimeUS,FmtType,UnitIds,MultIds"));
  append(bytes, format_record(6, 13, "TMP", "QBB", "TimeUS,Nr,Deg"));
  Bytes units = record_header(5);
  put(units, std::uint64_t{1});
  put(units, std::uint8_t{6});
  put_text(units, "s#O", 16);
  put_text(units, "F--", 16);
  for (int i = 0; i < 6; ++i) {
    Bytes record = record_header(6);
    put(record, static_cast<std::uint64_t>(1'000'000 + i));
    record.push_back(static_cast<std::uint8_t>(i % 3));
    record.push_back(20);
    if (i == 0) append(bytes, units);
    append(bytes, record);
  }
  const overfly::testing::TemporaryFolder folder;
  const auto log = open_bytes(folder, bytes);
  ASSERT_TRUE(log.ok()) << log.error().message;
  std::vector<std::string> names;
  for (const StreamInfo& stream : log->streams) names.push_back(stream.description.name);
  EXPECT_THAT(names, ::testing::ElementsAre("FMT", "FMTU", "TMP[0]", "TMP[1]", "TMP[2]"));
}

TEST(Dataflash, FindsTheSimulatorsOriginByComparison) {
  Bytes bytes = declarations();
  append(bytes, format_record(7, 23, "SIM", "QLLf", "TimeUS,Lat,Lng,Alt"));
  append(bytes, format_record(8, 47, "SIM2", "Qdddfff", "TimeUS,PN,PE,PD,VN,VE,VD"));
  const auto sim2 = [](std::uint64_t time_us, double north_m) {
    Bytes record = record_header(8);
    put(record, time_us);
    for (const double value : {north_m, 50.0, -100.0}) put(record, value);
    for (const float value : {25.0F, 0.0F, 0.0F}) put(record, value);
    return record;
  };
  append(bytes, att_record(1'000'000));
  append(bytes, sim2(1'000'000, 100.0));
  Bytes sim = pos_record(1'004'000, 470000000);
  sim[2] = 7;
  append(bytes, sim);
  for (std::uint32_t i = 1; i < 100; ++i) {
    append(bytes, sim2(1'000'000 + 10'000 * i, 100.0 + 0.25 * i));
    append(bytes, att_record(1'000'000 + 10'000 * i));
  }
  const overfly::testing::TemporaryFolder folder;
  const auto log = open_bytes(folder, bytes);
  ASSERT_TRUE(log.ok()) << log.error().message;
  EXPECT_EQ(log->streams[log->truth->position].description.name, "SIM");
  const auto trajectory = read_log_trajectory(*log, {"SIM2", {}, {}});
  ASSERT_TRUE(trajectory.ok()) << trajectory.error().message;
  EXPECT_TRUE(trajectory->georeferenced);
  // 0.1 m north of the first point the aircraft is at 47 deg.
  const LogPose& first = trajectory->poses.front();
  EXPECT_NEAR(first.position.x(), 47.0 - 0.1 / 111318.845, 1e-9);
  EXPECT_NEAR(first.position.y(), 8.0, 1e-9);
  EXPECT_NEAR(first.position.z(), 500.0, 1e-9);
}

TEST(Dataflash, DoesNotBelieveASingleDamagedStamp) {
  Bytes bytes = declarations();
  for (std::uint32_t i = 0; i < 50; ++i) {
    append(bytes, att_record(1'000'000 + 20'000 * i));
    append(bytes,
           pos_record(i == 20 ? 0x7FFFFFFFFFFFFFFF : 1'005'000 + 20'000 * i,
                      470000000 + static_cast<int>(45 * i)));
  }
  const overfly::testing::TemporaryFolder folder;
  const auto log = open_bytes(folder, bytes);
  ASSERT_TRUE(log.ok()) << log.error().message;
  EXPECT_EQ(log->boots.size(), 1U);
  EXPECT_THAT(log->warnings, Contains(HasSubstr("1 stamps of records are implausible")));
  EXPECT_EQ(read_log_trajectory(*log, {})->poses.size(), 48U);  // the last has no attitude after it
}

TEST(Dataflash, CountsHeldRecordsWhoseTypeIsDeclaredAgain) {
  Bytes bytes = declarations();
  append(bytes, pos_record(1'000'000, 470000000));  // held: the clock is not proven
  append(bytes, format_record(2, 27, "POS", "QLLff", "TimeUS,Lat,Lng,Alt,RelHomeAlt"));
  for (std::uint32_t i = 0; i < 20; ++i) append(bytes, att_record(1'005'000 + 20'000 * i));
  const overfly::testing::TemporaryFolder folder;
  const auto log = open_bytes(folder, bytes);
  ASSERT_TRUE(log.ok()) << log.error().message;
  EXPECT_THAT(log->warnings,
              Contains(HasSubstr("1 records were left out: their type was declared again")));
}

TEST(Dataflash, SkipsDamageAndGoesOn) {
  Bytes bytes = declarations();
  for (std::uint32_t i = 0; i < 10; ++i) append(bytes, att_record(1'000'000 + 20'000 * i));
  append(bytes, Bytes(100, 0xA3));
  for (std::uint32_t i = 10; i < 20; ++i) append(bytes, att_record(1'000'000 + 20'000 * i));
  Bytes cut = att_record(3'000'000);
  cut.resize(10);
  append(bytes, cut);
  const overfly::testing::TemporaryFolder folder;
  const auto log = open_bytes(folder, bytes);
  ASSERT_TRUE(log.ok()) << log.error().message;
  // The record in front of the damage is not followed by another one.
  EXPECT_EQ(log->streams[1].messages, 19U);
  EXPECT_THAT(log->warnings, Contains(HasSubstr("127 bytes in 2 places")));
}

/// A log of an old version: the receiver's TimeMS is that of the GPS week, and T that of the clock.
Bytes old_log(const std::string& receiver) {
  Bytes bytes = format_record(0x80, 89, "FMT", "BBnNZ", "Type,Length,Name,Format,Columns");
  append(bytes,
         format_record(10, 30, receiver, "BIHLLeII", "Status,TimeMS,Week,Lat,Lng,Alt,Spd,T"));
  append(bytes, format_record(11, 13, "EKF1", "Iccc", "TimeMS,Roll,Pitch,Yaw"));
  for (std::uint32_t i = 0; i < 20; ++i) {
    Bytes gps = record_header(10);
    gps.push_back(i < 3 ? 1 : 3);
    put(gps, std::uint32_t{604091400} + 200 * i);  // time of the week
    put(gps, std::uint16_t{1871});
    for (const std::int32_t value : {-353622797, 1491659262, 59014}) put(gps, value);
    put(gps, std::uint32_t{4});
    put(gps, std::uint32_t{250000 + 200 * i});
    append(bytes, gps);
    Bytes ekf = record_header(11);
    put(ekf, std::uint32_t{250050 + 200 * i});
    for (const std::int16_t value : {0, 0, 9000}) put(ekf, value);
    append(bytes, ekf);
  }
  return bytes;
}

TEST(Dataflash, ReadsOldLogsInMilliseconds) {
  const overfly::testing::TemporaryFolder folder;
  for (const std::string receiver : {"GPS", "GPS2"}) {
    const auto log = open_bytes(folder, old_log(receiver));
    ASSERT_TRUE(log.ok()) << log.error().message;
    ASSERT_TRUE(log->truth) << receiver;
    const StreamInfo& gps = log->streams[log->truth->position];
    EXPECT_EQ(gps.description.name, receiver);
    EXPECT_EQ(gps.first_ns, 250 * kNsPerS);
    EXPECT_EQ(gps.invalid, 3U);
    EXPECT_DOUBLE_EQ(gps.highest_m, 590.14);
  }
}

}  // namespace
}  // namespace overfly::flight::logs
