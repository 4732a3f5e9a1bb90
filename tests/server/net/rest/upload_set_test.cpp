// Several files in one upload: a mapping of CSV files with its pieces.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "tests/server/net/test_client.hpp"
#include "tests/server/net/test_server.hpp"

namespace overfly::testing {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::HasSubstr;

constexpr const char* kUploads = "/api/v1/logs";

using Files = std::vector<std::pair<std::string, std::string>>;

std::string mapping_of(const std::string& gps_file) {
  const json mapping = {{"csv_mapping_version", 1},
                        {"pieces",
                         {{{"name", "GPS"},
                           {"file", gps_file},
                           {"origin", "gps"},
                           {"time", {{"column", "T"}, {"unit", "ms"}}},
                           {"columns",
                            {{"lat", {{"column", "Lat"}, {"unit", "deg"}}},
                             {"lon", {{"column", "Lng"}, {"unit", "deg"}}},
                             {"alt_msl", {{"column", "Alt"}, {"unit", "m"}}}}}},
                          {{"name", "ATT"},
                           {"file", "./att.csv"},
                           {"origin", "estimate"},
                           {"time", {{"column", "T"}, {"unit", "ms"}}},
                           {"columns",
                            {{"roll", {{"column", "R"}, {"unit", "deg"}}},
                             {"pitch", {{"column", "P"}, {"unit", "deg"}}},
                             {"yaw", {{"column", "Y"}, {"unit", "deg"}}}}}}}}};
  return mapping.dump();
}

Files flight(const std::string& gps_file = "gps.csv") {
  std::string gps = "T,Lat,Lng,Alt\n";
  std::string att = "T,R,P,Y\n";
  for (int i = 0; i < 30; ++i) {
    gps += std::to_string(1000 + 200 * i) + ",47.000" + std::to_string(100 + i) + ",8,500\n";
    att += std::to_string(1000 + 200 * i) + ",10,0,0\n";
  }
  return {{"flight.json", mapping_of(gps_file)}, {"gps.csv", gps}, {"att.csv", att}};
}

class UploadSetTest : public ::testing::Test {
 protected:
  static net::ServerLimits limits() {
    net::ServerLimits limits;
    limits.uploads.max_bytes = std::uint64_t{1} << 20U;
    limits.uploads.quota_bytes = std::uint64_t{1} << 20U;
    return limits;
  }
  Answer send(const Files& files, const std::string& cut_or_more = "") {
    std::string query;
    std::string body;
    for (const auto& [name, text] : files) {
      query += (query.empty() ? "" : ",") + name + ":" + std::to_string(text.size());
      body += text;
    }
    return ask(server_.port(), "POST", kUploads + ("?files=" + query), body + cut_or_more);
  }
  Answer get(const std::string& place) { return ask(server_.port(), "GET", kUploads + place); }
  [[nodiscard]] bool is_empty() const {
    std::error_code none;
    return fs::directory_iterator(server_.folder() / "uploads", none) == fs::directory_iterator();
  }

  TestServer server_{limits()};
};

/// Also one that has the name of the mapping.
TEST_F(UploadSetTest, IsNotDeletedWithOneOfItsPieces) {
  Files files = flight("flight.csv");
  for (auto& [name, text] : files) {
    if (name == "gps.csv") name = "flight.csv";
  }
  ASSERT_EQ(send(files).status, 201);
  const Answer refused =
      ask(server_.port(), "DELETE", "/api/v1/trajectories/file:uploads%2Fflight%2Fflight.csv");
  EXPECT_NE(refused.status, 204);
  EXPECT_EQ(get("").json().at("logs").size(), 1U);
}

/// Saved calibrations are in the same folder as uploads.
TEST_F(UploadSetTest, DoesNotMixWithSavedCalibrations) {
  Files files = flight();
  files[0].first = "calibrations.json";
  EXPECT_EQ(send(files).status, 400);
  const fs::path saved = server_.folder() / "uploads" / "calibrations";
  fs::create_directories(saved);
  write_text(saved / "calibrations.json", "{}");
  write_text(saved / "front.json", "{}");
  EXPECT_NE(ask(server_.port(), "DELETE", "/api/v1/logs/uploads%2Fcalibrations%2Fcalibrations.json")
                .status,
            204);
  EXPECT_TRUE(fs::exists(saved / "front.json"));
}

TEST_F(UploadSetTest, IsOneLog) {
  const Answer sent = send(flight());
  ASSERT_EQ(sent.status, 201) << sent.body;
  EXPECT_EQ(sent.headers.at("location"), "/api/v1/logs/uploads%2Fflight%2Fflight.json");
  const json entry = sent.json();
  EXPECT_EQ(entry.at("name"), "uploads/flight/flight.json");
  EXPECT_EQ(entry.at("format"), "csv");
  const json list = get("").json();
  ASSERT_EQ(list.at("logs").size(), 1U) << list;
  EXPECT_EQ(list.at("logs").at(0), entry);
  std::size_t bytes = 0;
  for (const auto& [name, text] : flight()) bytes += text.size();
  EXPECT_EQ(list.at("uploads").at("used_bytes"), bytes);
  const json series = get("/uploads%2Fflight%2Fflight.json/series").json();
  EXPECT_EQ(series.at("position_count"), 30);
  EXPECT_EQ(series.at("attitudes").at("roll_deg").at(0), 10.0);
  EXPECT_EQ(send(flight()).status, 409);
  // The pieces are no logs of their own, and go with the mapping.
  EXPECT_EQ(ask(server_.port(), "DELETE", "/api/v1/logs/uploads%2Fflight%2Fgps.csv").status, 404);
  EXPECT_EQ(ask(server_.port(), "DELETE", "/api/v1/logs/uploads%2Fflight%2Fflight.json").status,
            204);
  EXPECT_TRUE(is_empty());
  EXPECT_EQ(send(flight()).status, 201);
}

TEST_F(UploadSetTest, HasPlainNamesOfTheRightKinds) {
  const Files good = flight();
  for (const char* name :
       {"../flight.json", ".flight.json", "flight.csv", "a b.json", "f.JSON/x"}) {
    Files files = good;
    files[0].first = name;
    EXPECT_EQ(send(files).status, 400) << name;
  }
  for (const char* name : {"../gps.csv", "gps.bin", "", "att.csv", "gps.json", "sub%2Fgps.csv"}) {
    Files files = good;
    files[1].first = name;
    EXPECT_EQ(send(files).status, 400) << name;
  }
  EXPECT_EQ(send({good[0]}).status, 400);
  Files many = good;
  for (int i = 0; i < 40; ++i) many.emplace_back("p" + std::to_string(i) + ".csv", "x");
  EXPECT_EQ(send(many).status, 400);
  for (const char* query : {"?files=",
                            "?files=a.json",
                            "?files=a.json:-1,b.csv:1",
                            "?files=a.json:99999999999999999999,b.csv:1",
                            "?files=a.json:1,b.csv:1&name=a.bin"}) {
    EXPECT_EQ(ask(server_.port(), "POST", kUploads + std::string(query), "xx").status, 400)
        << query;
  }
  EXPECT_TRUE(is_empty());
}

TEST_F(UploadSetTest, NamesOnlyWhatCameWithIt) {
  write_text(server_.folder() / "logs" / "gps.csv", flight()[1].second);
  for (const char* file : {"../../logs/gps.csv", "../gps.csv", "other.csv", "sub/gps.csv"}) {
    const Answer refused = send(flight(file));
    EXPECT_EQ(refused.status, 422) << file;
    EXPECT_THAT(refused.body, HasSubstr("flight.json: names \\\""));
    EXPECT_THAT(refused.body, ::testing::Not(HasSubstr(server_.folder().string())));
  }
  EXPECT_EQ(send(flight((server_.folder() / "logs" / "gps.csv").string())).status, 422);
  Files more = flight();
  more.emplace_back("unused.csv", "T\n");
  EXPECT_THAT(send(more).body, HasSubstr("does not name unused.csv"));
  Files other = flight();
  other[0].second = "{\"csv_mapping_version\": 1, \"pieces\": 7}";
  EXPECT_EQ(send(other).status, 422);
  other[0].second = "{}";
  EXPECT_EQ(send(other).status, 422);
  EXPECT_TRUE(is_empty());
}

TEST_F(UploadSetTest, HasTheAnnouncedLengthWithinTheLimits) {
  EXPECT_EQ(send(flight(), "more").status, 400);
  Files longer = flight();
  std::string query = "?files=";
  std::string body;
  for (const auto& [name, text] : longer) {
    query += (body.empty() ? "" : ",") + name + ":" + std::to_string(text.size() + 1);
    body += text;
  }
  EXPECT_EQ(ask(server_.port(), "POST", kUploads + query, body).status, 400);
  Files large = flight();
  large[1].second.resize(std::size_t{1} << 20U, '\n');
  EXPECT_EQ(send(large).status, 413);
  large[1].second.resize((std::size_t{1} << 20U) + 1, '\n');
  EXPECT_EQ(send(large).status, 400);
  EXPECT_TRUE(is_empty());
  EXPECT_EQ(get("").json().at("uploads").at("used_bytes"), 0);
}

}  // namespace
}  // namespace overfly::testing
