// The truth of a run as the flight of another one.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/record/run_folder.hpp"
#include "server/scenario/document/scenario_file.hpp"
#include "tests/server/support/server_fixture.hpp"

namespace overfly::server {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using overfly::testing::read_text;
using ::testing::HasSubstr;

Result<RunResult> fly_into(const fs::path& folder, const Json& document) {
  const auto scenario = resolve_scenario(document, {}, "/");
  if (!scenario) return scenario.error();
  return run_scenario(*scenario, testing::options_for(folder));
}

Json again_document(const fs::path& flown) {
  Json document = testing::small_document();
  document["flight"] = {{"run", {{"folder", flown.string()}}}};
  document.erase("duration_s");
  return document;
}

TEST(RunAgain, FliesTheRecordedTruthBitByBit) {
  const overfly::testing::TemporaryFolder folder;
  const fs::path first = folder.path() / "first";
  const fs::path second = folder.path() / "second";
  ASSERT_TRUE(fly_into(first, testing::small_document()).ok());
  const auto again = fly_into(second, again_document(first));
  ASSERT_TRUE(again.ok()) << again.error().message;
  EXPECT_EQ(read_text(second / "frames.jsonl"), read_text(first / "frames.jsonl"));
  EXPECT_EQ(read_text(truth_samples_file(second)), read_text(truth_samples_file(first)));
  EXPECT_THAT(read_text(manifest_file(second)), HasSubstr("run first: course"));
}

TEST(RunAgain, FliesWhatAKilledRunHasRecorded) {
  const overfly::testing::TemporaryFolder folder;
  const fs::path first = folder.path() / "first";
  ASSERT_TRUE(fly_into(first, testing::small_document()).ok());
  // The last sample is cut off in the middle.
  fs::resize_file(truth_samples_file(first), 200 * 120 + 57);
  const auto again = fly_into(folder.path() / "second", again_document(first));
  ASSERT_TRUE(again.ok()) << again.error().message;
  const std::string frames = read_text(folder.path() / "second" / "frames.jsonl");
  EXPECT_FALSE(frames.empty());
  EXPECT_EQ(read_text(first / "frames.jsonl").substr(0, frames.size()), frames);
}

TEST(RunAgain, ReportsTheEventsOfTheRecordedFlight) {
  const overfly::testing::TemporaryFolder folder;
  const fs::path first = folder.path() / "first";
  ASSERT_TRUE(fly_into(first, testing::small_document()).ok());
  const std::string events =
      R"({"t_ns":500000000,"level":"info","text":"RTL","kind":"mode"}
{"t_ns":0,"level":"info","text":"AUTO","kind":"mode"}
{"t_ns":700000000,"level":"info","text":"disarmed","kind":"event"}
)";
  overfly::testing::write_text(log_file(first), read_text(log_file(first)) + events);
  ASSERT_TRUE(fly_into(folder.path() / "second", again_document(first)).ok());
  const std::string log = read_text(log_file(folder.path() / "second"));
  const std::size_t mode = log.find("\"AUTO\"");
  ASSERT_NE(mode, std::string::npos);
  EXPECT_GT(log.find("\"RTL\""), mode);
  EXPECT_THAT(log, HasSubstr("\"disarmed\""));
  // Events that cannot be read do not keep the flight from being flown.
  overfly::testing::write_text(log_file(first), "{\"t_ns\":-1}\n");
  const fs::path third = folder.path() / "third";
  ASSERT_TRUE(fly_into(third, again_document(first)).ok());
  EXPECT_THAT(read_text(manifest_file(third)), HasSubstr("the flight's events are not known"));
}

TEST(RunAgain, NeedsAWorldWithTheSameOrigin) {
  const overfly::testing::TemporaryFolder folder;
  const fs::path first = folder.path() / "first";
  ASSERT_TRUE(fly_into(first, testing::small_document()).ok());
  Json manifest = Json::parse(read_text(manifest_file(first)));
  manifest["world"]["origin"]["lat_deg"] =
      manifest["world"]["origin"]["lat_deg"].get<double>() + 1e-5;
  overfly::testing::write_text(manifest_file(first), manifest.dump());
  const auto again = fly_into(folder.path() / "second", again_document(first));
  ASSERT_FALSE(again.ok());
  EXPECT_THAT(again.error().message, HasSubstr("flight.run"));
  EXPECT_THAT(again.error().message, HasSubstr("has its origin 1.1"));
}

TEST(RunAgain, NamesAFolderThatIsNoRun) {
  const overfly::testing::TemporaryFolder folder;
  const auto again = fly_into(folder.path() / "second", again_document(folder.path() / "none"));
  ASSERT_FALSE(again.ok());
  EXPECT_THAT(again.error().message, HasSubstr("none"));
}

}  // namespace
}  // namespace overfly::server
