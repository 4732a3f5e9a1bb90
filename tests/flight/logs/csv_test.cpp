// Mappings of CSV files: what they may say, how rows become samples, and what is left out.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <functional>
#include <string>
#include <utility>

#include "core/motion/pose.hpp"
#include "flight/logs/csv/csv_mapping.hpp"
#include "flight/logs/flight_log.hpp"
#include "flight/logs/log_samples.hpp"
#include "flight/logs/ned_attitude.hpp"
#include "flight/logs/truth/log_trajectory.hpp"
#include "tests/support/support.hpp"

namespace overfly::flight::logs {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

constexpr const char* kMapping = R"({"csv_mapping_version": 1, "pieces": [
  {"name": "GPS", "file": "gps.csv", "origin": "gps",
   "time": {"column": "ms", "unit": "ms", "offset_s": -100},
   "valid": {"column": "fix", "at_least": 3},
   "columns": {"lat": {"column": "lat", "unit": "1e-7deg"},
               "lon": {"column": "lon", "unit": "1e-7deg"},
               "alt_msl": {"column": "ft", "unit": "ft"}}},
  {"name": "ATT", "file": "att.csv", "origin": "estimate",
   "time": {"column": "s", "unit": "s"},
   "columns": {"roll": {"column": "roll", "unit": "deg", "scale": -1},
               "pitch": {"column": "pitch", "unit": "rad"},
               "yaw": {"column": "yaw", "unit": "cdeg"}}}]})";

std::string changed(std::string text, const std::string& what, const std::string& by) {
  const std::size_t at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return text.replace(at, what.size(), by);
}

class CsvLog : public ::testing::Test {
 protected:
  void SetUp() override {
    write("log.json", kMapping);
    write(
        "gps.csv",
        "ms,lat,lon,ft,fix\n101000,470000000,80000000,1000,3\n102000,470001000,80000000,1000,4\n");
    write("att.csv", "yaw,roll,pitch,s\n9000,-10,0.1,0.9\n9000,-10,0.1,1.5\n9100,-10,0.1,2.5\n");
  }
  void write(const std::string& name, const std::string& text) {
    overfly::testing::write_text(folder_.path() / name, text);
  }
  [[nodiscard]] Result<OpenedLog> open() { return open_log(folder_.path() / "log.json"); }
  [[nodiscard]] std::string error_of(const std::string& mapping) {
    write("log.json", mapping);
    const Result<OpenedLog> log = open();
    return log ? "" : log.error().message;
  }

  overfly::testing::TemporaryFolder folder_;
};

TEST_F(CsvLog, JoinsPiecesWithTheirUnitsAndClocks) {
  const Result<OpenedLog> log = open();
  ASSERT_TRUE(log.ok()) << log.error().message;
  EXPECT_EQ(log->format, LogFormat::kCsv);
  ASSERT_EQ(log->streams.size(), 2U);
  EXPECT_EQ(log->streams[0].positions, 2U);
  EXPECT_EQ(log->streams[1].attitudes, 3U);
  EXPECT_TRUE(log->truth && log->truth->position == 0 && log->truth->attitude == 1U);
  const Result<LogTrajectory> flight = read_log_trajectory(*log, {});
  ASSERT_TRUE(flight.ok()) << flight.error().message;
  ASSERT_EQ(flight->poses.size(), 2U);
  EXPECT_EQ(flight->poses[0].t_ns, 1'000'000'000);
  EXPECT_NEAR(flight->poses[1].position.x(), 47.0001, 1e-12);
  EXPECT_NEAR(flight->poses[1].position.y(), 8.0, 1e-12);
  EXPECT_NEAR(flight->poses[1].position.z(), 304.8, 1e-9);
  const RollPitchYaw first = attitude_from(R_enu_ned() * flight->poses[0].R_ned_body);
  EXPECT_NEAR(deg_from_rad(first.roll_rad), 10.0, 1e-4);  // stored as floats
  EXPECT_NEAR(first.pitch_rad, 0.1, 1e-6);
  EXPECT_NEAR(deg_from_rad(first.yaw_rad), 90.0, 1e-4);
  // Half way between the rows of 1.5 s and 2.5 s.
  const RollPitchYaw second = attitude_from(R_enu_ned() * flight->poses[1].R_ned_body);
  EXPECT_NEAR(deg_from_rad(second.yaw_rad), 90.5, 1e-3);
}

TEST_F(CsvLog, CountsTheRowsOfASlice) {
  const std::filesystem::path file = folder_.path() / "log.json";
  const LogSlice slice{1'200'000'000, 2'200'000'000};
  const Result<OpenedLog> log = open_log(file, nullptr, {.slice = slice});
  ASSERT_TRUE(log.ok()) << log.error().message;
  EXPECT_TRUE(log->parts.empty());
  EXPECT_EQ(log->size_bytes, open()->size_bytes);
  ASSERT_EQ(log->streams.size(), 2U);
  EXPECT_EQ(log->streams[0].positions, 1U);
  EXPECT_EQ(log->streams[0].first_ns, 2'000'000'000);
  EXPECT_EQ(log->streams[1].attitudes, 1U);
  EXPECT_EQ(log->streams[1].first_ns, 1'500'000'000);
  // The attitudes around the position are read, also the one behind the slice.
  const auto trajectory = read_log_trajectory(*log, {"", slice.from_ns, slice.to_ns});
  ASSERT_TRUE(trajectory.ok()) << trajectory.error().message;
  ASSERT_EQ(trajectory->poses.size(), 1U);
  EXPECT_EQ(trajectory->poses[0].t_ns, 2'000'000'000);

  const auto empty = open_log(file, nullptr, {.slice = {9'000'000'000, {}}});
  ASSERT_TRUE(empty.ok()) << empty.error().message;
  EXPECT_THAT(empty->warnings, Contains("no valid positions in the time asked for"));
  EXPECT_THAT(read_log_samples(*empty, {}).error().message,
              HasSubstr("log.json: no valid positions in the time asked for"));
}

TEST_F(CsvLog, ReadsQuaternionsWindowsLinesAndQuotes) {
  write("att.csv", "\xEF\xBB\xBF\"w\", x ,y,z,s\r\n0.5,0.5,0.5,0.5,+1\r\n\r\n0.5,0.5,0.5,0.5,2.5");
  write("log.json",
        R"({"csv_mapping_version": 1, "pieces": [{"name": "Q", "file": "att.csv",
            "origin": "simulation", "time": {"column": "s", "unit": "s"},
            "columns": {"qw": {"column": "w"}, "qx": {"column": "x"}, "qy": {"column": "y"},
                        "qz": {"column": "z"}}}]})");
  const Result<OpenedLog> log = open();
  ASSERT_TRUE(log.ok()) << log.error().message;
  EXPECT_EQ(log->streams[0].attitudes, 2U);
  EXPECT_EQ(log->streams[0].last_ns, 2'500'000'000);
}

TEST_F(CsvLog, CountsWhatItLeavesOut) {
  write("att.csv",
        "yaw,roll,pitch,s\n"
        "9000,-10,0.1,1\n"
        "9000,-10,0.1,1\n"      // the same time
        "9000,-10,,1.1\n"       // blank
        "9000,-10,nan,1.2\n"    // invalid sample
        "9000,x,0.1,1.3\n"      // not a number
        "9000,-10,0.1,\n"       // no time
        "9000,-10,0.1,1e300\n"  // no time
        "9000,-10,3.1,1.4\n"    // pitch beyond 90 deg: invalid sample
        "9000,-10,0.1,99999\n"  // implausible
        "9000,-10,0.1,1.35\n"   // earlier than the row before
        "9000,-10,0.1,2\n"
        "9000,-1");  // half a line
  write("gps.csv",
        "ms,lat,lon,ft,fix\n101000,470000000,80000000,1000,3\n101200,0,0,0,1\n"
        "101400,910000000000,80000000,1000,3\n");
  const Result<OpenedLog> log = open();
  ASSERT_TRUE(log.ok()) << log.error().message;
  EXPECT_EQ(log->streams[0].positions, 1U);
  EXPECT_EQ(log->streams[0].invalid, 2U);
  EXPECT_EQ(log->streams[1].attitudes, 3U);
  EXPECT_EQ(log->streams[1].invalid, 2U);
  EXPECT_EQ(log->streams[1].backward, 1U);
  for (const char* warning :
       {"1 rows with another number of fields than the header were left out in ATT",
        "2 rows without a readable time were left out in ATT",
        "1 rows with an implausible time were left out in ATT",
        "1 rows repeat the time of the row before and were left out in ATT",
        "1 rows with a blank field were left out in ATT",
        "1 rows with a field that is not a number were left out in ATT"}) {
    EXPECT_THAT(log->warnings, Contains(warning));
  }
}

/// Rows at 5 Hz from 0 s on, to the north. @param fix  of each row
std::string gps_rows(int count, double speed_m_s, const std::function<int(int)>& fix) {
  std::string rows = "ms,lat,lon,ft,fix\n";
  for (int i = 0; i < count; ++i) {
    const auto lat = static_cast<std::int64_t>(470000000.0 + 0.2 * i * speed_m_s * 90.0);
    rows += std::to_string(100000 + 200 * i) + "," + std::to_string(lat) + ",80000000,1000," +
            std::to_string(fix(i)) + "\n";
  }
  return rows;
}

TEST_F(CsvLog, WarnsOfGapsBetweenValidPositions) {
  write("gps.csv", gps_rows(60, 20.0, [](int i) { return i >= 20 && i < 30 ? 1 : 3; }));
  const Result<OpenedLog> log = open();
  ASSERT_TRUE(log.ok()) << log.error().message;
  EXPECT_EQ(log->streams[0].gaps, 0U);  // the rows are there
  EXPECT_EQ(log->streams[0].position_gaps, 1U);
  EXPECT_THAT(log->warnings,
              Contains("1 gap between valid positions of GPS, the longest 2.2 s long"));
}

TEST_F(CsvLog, TellsAShortSliceOfAFlightFromAnAircraftOnTheGround) {
  write("gps.csv", gps_rows(100, 11.0, [](int) { return 3; }));
  const auto slice =
      open_log(folder_.path() / "log.json", nullptr, {.slice = {5'000'000'000, 7'000'000'000}});
  ASSERT_TRUE(slice.ok()) << slice.error().message;
  EXPECT_LT(slice->streams[0].reach_m, kGroundReachM);
  EXPECT_FALSE(slice->on_ground);
  write("gps.csv", gps_rows(100, 0.2, [](int) { return 3; }));
  const Result<OpenedLog> parked = open();
  ASSERT_TRUE(parked.ok()) << parked.error().message;
  EXPECT_TRUE(parked->on_ground);
}

TEST_F(CsvLog, SaysWhichValuesCannotBeRight) {
  write("att.csv", "yaw,roll,pitch,s\n9000,10,0.1,1\n9000,10,0.1,2\n");
  const std::string as_rad =
      changed(kMapping, "\"unit\": \"deg\", \"scale\"", "\"unit\": \"rad\", \"scale\"");
  write("log.json", as_rad);
  Result<OpenedLog> log = open();
  ASSERT_TRUE(log.ok()) << log.error().message;
  const char* angles =
      "ATT: 2 samples cannot be right and were left out, the first at 1 s: roll -572.95";
  EXPECT_THAT(log->warnings, Contains(HasSubstr(angles)));
  const auto flight = read_log_trajectory(*log, {});
  ASSERT_FALSE(flight.ok());
  EXPECT_THAT(
      flight.error().message,
      HasSubstr("GPS: no valid attitudes of the same vehicle are in the log; ATT: 2 samples"));

  write("gps.csv", "ms,lat,lon,ft,fix\n101000,950000000,80000000,1000,3\n");
  log = open();
  ASSERT_TRUE(log.ok()) << log.error().message;
  EXPECT_THAT(
      log->warnings,
      Contains(HasSubstr("the log has no valid positions; GPS: 1 sample cannot be right and "
                         "was left out, the first at 1 s: latitude 95")));
}

TEST_F(CsvLog, TakesLongitudesFrom0To360Deg) {
  write("gps.csv", "ms,lat,lon,ft,fix\n101000,470000000,3520000000,1000,3\n");
  const Result<OpenedLog> log = open();
  ASSERT_TRUE(log.ok()) << log.error().message;
  const auto flight = read_log_trajectory(*log, {});
  ASSERT_TRUE(flight.ok()) << flight.error().message;
  EXPECT_NEAR(flight->poses[0].position.y(), -8.0, 1e-9);
}

TEST_F(CsvLog, LeavesOutAnEndlessLine) {
  std::string text = "yaw,roll,pitch,s\n9000,-10,0.1,1\n";
  text += std::string(3'000'000, '7') + "\n9000,-10,0.1,2\n";
  write("att.csv", text);
  const Result<OpenedLog> log = open();
  ASSERT_TRUE(log.ok()) << log.error().message;
  EXPECT_EQ(log->streams[1].attitudes, 2U);
  EXPECT_THAT(log->warnings, Contains("1 lines of more than 65536 bytes were left out in ATT"));
}

TEST_F(CsvLog, RejectsMappingsThatSayTooLittleOrTooMuch) {
  const std::pair<std::pair<std::string, std::string>, std::string> faults[] = {
      {{"version\": 1", "version\": 2"}, "csv_mapping_version = 2: must be 1"},
      {{"\"name\": \"ATT\"", "\"name\": \"GPS\""}, "pieces.1.name = \"GPS\": another piece has it"},
      {{"\"file\": \"gps.csv\", ", ""}, "pieces.0.file: must be a text of 1 to 4096 bytes"},
      {{"\"gps\"", "\"radar\""}, "pieces.0.origin = \"radar\": must be one of simulation"},
      {{"\"unit\": \"ms\"", "\"unit\": \"h\""}, "pieces.0.time.unit = \"h\": must be one of s, ms"},
      {{"\"unit\": \"ft\"", "\"unit\": \"deg\""},
       "pieces.0.columns.alt_msl.unit = \"deg\": must be one of m, cm, mm, ft"},
      {{"\"scale\": -1", "\"scale\": 0"}, "pieces.1.columns.roll.scale = 0: must not be 0"},
      {{"\"roll\": {", "\"role\": {"}, "pieces.1.columns.role"},
      {{"\"roll\": {", "\"lat\": {"}, "pieces.1.columns: needs all or none of lat, lon, alt_msl"},
      {{"-100", "1e10"}, "pieces.0.time.offset_s = 10000000000.0: must be a number in"},
      {{"\"pieces\": [", "\"pieces\": [7, "}, "pieces.0: must be an object"},
      {{"gps.csv", "absent.csv"}, "absent.csv: no such file"},
      {{"\"column\": \"ms\"", "\"column\": \"us\""},
       "gps.csv: has no column 'us': its header is ms, lat, lon, ft, fix"},
  };
  for (const auto& [change, message] : faults) {
    EXPECT_THAT(error_of(changed(kMapping, change.first, change.second)), HasSubstr(message));
  }
  EXPECT_THAT(error_of(changed(kMapping, "]}", "]")), HasSubstr("log.json, line"));
}

TEST_F(CsvLog, RejectsAHeaderWithAColumnTwiceAndAnEmptyFile) {
  write("att.csv", "yaw,roll,pitch,s,roll\n");
  EXPECT_THAT(error_of(kMapping), HasSubstr("has the column 'roll' twice"));
  write("att.csv", "\n\n");
  EXPECT_THAT(error_of(kMapping), HasSubstr("att.csv: has no header line"));
}

TEST_F(CsvLog, ReadsOnlyFilesThatThePolicyAllows) {
  const std::filesystem::path inside = folder_.path() / "data";
  std::filesystem::create_directory(inside);
  write("data/log.json", changed(kMapping, "gps.csv", "../gps.csv"));
  write("data/att.csv", "yaw,roll,pitch,s\n");
  const SourcePolicy policy = SourcePolicy::inside({inside});
  const Result<OpenedLog> log = open_log(inside / "log.json", nullptr, {.sources = policy});
  ASSERT_FALSE(log.ok());
  EXPECT_EQ(log.error().code, ErrorCode::kInvalidArgument);
  EXPECT_THAT(log.error().message, HasSubstr("pieces.0.file"));
  EXPECT_THAT(log.error().message, HasSubstr("must be a file inside of the server's data folders"));
  EXPECT_TRUE(open_log(inside / "log.json").ok());
}

TEST_F(CsvLog, SurvivesEveryCutOfItsFiles) {
  for (const std::string name : {"log.json", "gps.csv", "att.csv"}) {
    const std::string whole = overfly::testing::read_text(folder_.path() / name);
    for (std::size_t size = 0; size < whole.size(); ++size) {
      write(name, whole.substr(0, size));
      const Result<OpenedLog> log = open();
      if (log) static_cast<void>(read_log_trajectory(*log, {}));
    }
    write(name, whole);
  }
  EXPECT_TRUE(open().ok());
}

TEST(RecordedCsvLog, HasTheFlightOfTheSkywalker) {
  OVERFLY_DATA_OR_SKIP(gps, "flight_logs/skywalker_x8/TestLog2_GPS.csv");
  const Result<OpenedLog> log =
      open_log(overfly::testing::source_file("scenarios/flight_logs/skywalker_x8.mapping.json"));
  ASSERT_TRUE(log.ok()) << log.error().message;
  ASSERT_EQ(log->streams.size(), 3U);
  EXPECT_GT(log->size_bytes, std::filesystem::file_size(gps));
  EXPECT_EQ(log->streams[0].positions, 3050U);  // lines below the header, counted with wc
  EXPECT_EQ(log->streams[1].attitudes, 30650U);
  EXPECT_EQ(log->streams[2].messages, 6129U);
  EXPECT_EQ(log->streams[1].first_ns, 13'178'000'000);
  EXPECT_EQ(log->streams[1].last_ns, 626'280'000'000);
  EXPECT_NEAR(log->streams[1].rate_hz, 50.0, 0.1);
  ASSERT_TRUE(log->truth && log->truth->attitude);
  EXPECT_EQ(log->streams[log->truth->position].description.name, "GPS");
  EXPECT_EQ(log->streams[*log->truth->attitude].description.name, "ATT");
  const Result<LogTrajectory> flight = read_log_trajectory(*log, {});
  ASSERT_TRUE(flight.ok()) << flight.error().message;
  EXPECT_EQ(flight->poses.size(), 3050U);
  EXPECT_EQ(flight->poses.back().t_ns, 626'280'000'000);
  EXPECT_NEAR(flight->poses.back().position.x(), -37.959205, 1e-12);
  EXPECT_NEAR(flight->poses.back().position.z(), 17.25, 1e-12);
  const RollPitchYaw last = attitude_from(R_enu_ned() * flight->poses.back().R_ned_body);
  EXPECT_NEAR(deg_from_rad(last.roll_rad), 0.04, 1e-4);
  EXPECT_NEAR(deg_from_rad(last.pitch_rad), 3.11, 1e-4);
  EXPECT_NEAR(deg_from_rad(last.yaw_rad), 189.55 - 360.0, 1e-3);
}

}  // namespace
}  // namespace overfly::flight::logs
