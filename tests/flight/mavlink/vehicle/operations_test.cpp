// Commands, parameters and missions against a vehicle that loses messages and refuses.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "flight/mavlink/vehicle/commands.hpp"
#include "flight/mavlink/vehicle/message_rates.hpp"
#include "flight/mavlink/vehicle/mission.hpp"
#include "flight/mavlink/vehicle/parameters.hpp"
#include "tests/flight/mavlink/vehicle/fake_vehicle.hpp"
#include "tests/support/support.hpp"

namespace overfly::flight::mavlink {
namespace {

using ::testing::ElementsAre;
using testing::FakeVehicle;
using ::testing::HasSubstr;

using std::chrono::milliseconds;

FakeVehicle vehicle_with_parameters() {
  FakeVehicle vehicle;
  vehicle.parameters["AIRSPEED_CRUISE"] = {"AIRSPEED_CRUISE", 22.0, 9};
  vehicle.parameters["SERIAL1_BAUD"] = {"SERIAL1_BAUD", 57, 4};
  for (int i = 0; i < 50; ++i) {
    const std::string name = "P" + std::to_string(1000 + i);
    vehicle.parameters[name] = {name, i * 0.5, 9};
  }
  return vehicle;
}

TEST(VehicleParameters, AreReadAndSetWithConfirmation) {
  for (const double loss : {0.0, 0.2}) {
    FakeVehicle vehicle = vehicle_with_parameters();
    vehicle.loss = loss;
    const Status set = set_parameter(vehicle, "AIRSPEED_CRUISE", 25.1);
    ASSERT_TRUE(set.ok()) << set.error().message;
    EXPECT_EQ(vehicle.parameters["AIRSPEED_CRUISE"].value, static_cast<double>(25.1F));
    const Result<Parameter> read = read_parameter(vehicle, "SERIAL1_BAUD");
    ASSERT_TRUE(read.ok()) << read.error().message;
    EXPECT_EQ(read->value, 57.0);
  }
}

TEST(VehicleParameters, HoldIntegersAsBytesWithPx4) {
  FakeVehicle vehicle;
  vehicle.autopilot = 12;
  vehicle.parameters["COM_RC"] = {"COM_RC", -3, 6};
  ASSERT_TRUE(set_parameter(vehicle, "COM_RC", 2000000001).ok());
  EXPECT_EQ(vehicle.parameters["COM_RC"].value, 2000000001.0);
  EXPECT_EQ(read_parameter(vehicle, "COM_RC")->value, 2000000001.0);
}

TEST(VehicleParameters, AreAllReadDespiteLosses) {
  for (const double loss : {0.0, 0.1, 0.5}) {
    FakeVehicle vehicle = vehicle_with_parameters();
    vehicle.loss = loss;
    const Result<std::vector<Parameter>> all = read_all_parameters(vehicle);
    ASSERT_TRUE(all.ok()) << all.error().message;
    ASSERT_EQ(all->size(), 52U);
    for (const Parameter& parameter : *all) {
      EXPECT_EQ(parameter.value, vehicle.parameters[parameter.name].value) << parameter.name;
    }
  }
}

TEST(VehicleParameters, ThatCannotBeSetAreNamed) {
  FakeVehicle vehicle = vehicle_with_parameters();
  const Status unknown = set_parameter(vehicle, "AIRSPEED_CRUISER", 1);
  EXPECT_EQ(unknown.error().code, ErrorCode::kNotFound);
  EXPECT_THAT(unknown.error().message, HasSubstr("AIRSPEED_CRUISER: vehicle 1.1 did not answer 5"));
  EXPECT_THAT(set_parameter(vehicle, "SERIAL1_BAUD", 40000).error().message,
              HasSubstr("SERIAL1_BAUD = 40000: must be a whole number in [-32768, 32767]"));
  EXPECT_THAT(set_parameter(vehicle, "SERIAL1_BAUD", 1.5).error().message, HasSubstr("whole"));
  EXPECT_THAT(set_parameter(vehicle, "P1000", 1e300).error().message, HasSubstr("finite"));
  EXPECT_THAT(set_parameter(vehicle, "A_NAME_TOO_LONG_X", 1).error().message,
              HasSubstr("1 to 16 characters"));
  vehicle.keeps_parameters = true;
  const Status kept = set_parameter(vehicle, "P1002", 5);
  EXPECT_EQ(kept.error().code, ErrorCode::kConflict);
  EXPECT_THAT(kept.error().message, HasSubstr("P1002 = 5: vehicle 1.1 keeps 1"));
  vehicle.cancelled = true;
  EXPECT_EQ(set_parameter(vehicle, "P1002", 5).error().code, ErrorCode::kCancelled);
}

TEST(VehicleCommands, AreRepeatedUntilTheyAreAcknowledged) {
  FakeVehicle vehicle;
  vehicle.is_mute = true;
  EXPECT_THAT(start_mission(vehicle).error().message,
              HasSubstr("starting the mission: vehicle 1.1 did not answer 5 requests within 1 s"));
  EXPECT_EQ(vehicle.commands.size(), 5U);
  EXPECT_EQ(PayloadReader(vehicle.commands[4]).at<std::uint8_t>(32), 4);  // confirmation
  vehicle.is_mute = false;
  vehicle.loss = 0.3;
  EXPECT_TRUE(start_mission(vehicle).ok());
}

TEST(VehicleCommands, AreWaitedForNoLongerWhileOtherMessagesKeepComing) {
  FakeVehicle vehicle;
  vehicle.is_mute = true;
  vehicle.flood = 100'000;
  const auto start = vehicle.time;
  EXPECT_THAT(start_mission(vehicle).error().message, HasSubstr("did not answer 5 requests"));
  EXPECT_EQ(vehicle.commands.size(), 5U);
  EXPECT_LT(vehicle.time - start, std::chrono::seconds(20));
}

TEST(VehicleCommands, AreNotAnsweredByMessagesThatCameBefore) {
  FakeVehicle vehicle;
  vehicle.answer(MessageId::kCommandAck, PayloadWriter(10).put(0, std::uint16_t{300}));
  vehicle.command_results = {2};
  EXPECT_THAT(start_mission(vehicle).error().message, HasSubstr("'denied'"));
}

/// Two cameras, or a companion computer, answer as the same system.
TEST(VehicleAnswers, OfOtherComponentsAreNotTaken) {
  FakeVehicle vehicle = vehicle_with_parameters();
  vehicle.has_impostor = true;
  EXPECT_TRUE(start_mission(vehicle).ok());
  EXPECT_TRUE(arm(vehicle, std::chrono::seconds(1)).ok());
  const Status set = set_parameter(vehicle, "AIRSPEED_CRUISE", 25.0);
  EXPECT_TRUE(set.ok()) << set.error().message;
  const Result<std::vector<Parameter>> all = read_all_parameters(vehicle);
  ASSERT_TRUE(all.ok()) << all.error().message;
  EXPECT_EQ(all->size(), vehicle.parameters.size());
  for (const Parameter& parameter : *all) {
    EXPECT_EQ(parameter.value, vehicle.parameters[parameter.name].value) << parameter.name;
  }
  std::vector<MissionItem> items(5);
  for (MissionItem& item : items) item.parameters[0] = 7.0F;
  const Status uploaded = upload_mission(vehicle, items);
  ASSERT_TRUE(uploaded.ok()) << uploaded.error().message;
  const Result<std::vector<MissionItem>> downloaded = download_mission(vehicle);
  ASSERT_TRUE(downloaded.ok()) << downloaded.error().message;
  EXPECT_EQ(*downloaded, items);
}

TEST(VehicleAnswers, NameWhomTheyAnswer) {
  const std::pair<MessageId, std::size_t> messages[] = {{MessageId::kMissionAck, 0},
                                                        {MessageId::kMissionRequest, 2},
                                                        {MessageId::kMissionRequestInt, 2},
                                                        {MessageId::kMissionCount, 2},
                                                        {MessageId::kCommandAck, 8},
                                                        {MessageId::kMissionItem, 32},
                                                        {MessageId::kMissionItemInt, 32}};
  for (const auto& message : messages) {
    const MessageId id = message.first;
    const std::size_t at = message.second;
    const auto is_ours = [&](std::uint8_t system, std::uint8_t component) {
      const auto payload = PayloadWriter(40).put(at, system).put(at + 1, component).bytes();
      const auto number = static_cast<std::uint32_t>(id);
      return is_addressed_to({Version::kTwo, 0, 1, 1, number, false, payload}, 255, 190);
    };
    EXPECT_TRUE(is_ours(255, 190)) << at;
    EXPECT_TRUE(is_ours(255, 0)) << at;
    EXPECT_TRUE(is_ours(0, 0)) << at;
    EXPECT_FALSE(is_ours(254, 190)) << at;
    EXPECT_FALSE(is_ours(254, 0)) << at;
    EXPECT_FALSE(is_ours(255, 230)) << at;
  }
  // Of MAVLink 1, and cut after its last byte that is not zero.
  const std::vector<std::uint8_t> short_answer = {400 % 256, 400 / 256, 0};
  EXPECT_TRUE(is_addressed_to({Version::kOne, 0, 1, 1, 77, false, short_answer}, 255, 190));
  EXPECT_TRUE(is_addressed_to({Version::kTwo, 0, 1, 1, 22, false, short_answer}, 255, 190));
}

TEST(VehicleCommands, ReportWhyTheVehicleRefuses) {
  FakeVehicle vehicle;
  vehicle.command_results = {2};
  vehicle.refusal_text = "Mode change failed: no position";
  const Status refused = change_mode(vehicle, 10);
  EXPECT_EQ(refused.error().code, ErrorCode::kConflict);
  EXPECT_EQ(refused.error().message,
            "changing to mode 10: vehicle 1.1 answers 'denied': Mode change failed: no position");
  ASSERT_TRUE(change_mode(vehicle, 10).ok());
  EXPECT_EQ(vehicle.mode, 10U);
  vehicle.command_results = {5};  // in progress, then accepted
  EXPECT_TRUE(take_off(vehicle, 50.0).ok());
  EXPECT_EQ(PayloadReader(vehicle.commands.back()).at<float>(24), 50.0F);
}

TEST(VehicleCommands, ArmingIsTriedAgainUntilItsLimit) {
  FakeVehicle vehicle;
  vehicle.command_results = {4, 1, 4, 0};
  vehicle.refusal_text = "PreArm: EKF starting";
  const auto start = vehicle.time;
  ASSERT_TRUE(arm(vehicle, std::chrono::seconds(60)).ok());
  EXPECT_TRUE(vehicle.armed);
  EXPECT_GE(vehicle.time - start, std::chrono::seconds(3));
  ASSERT_TRUE(disarm(vehicle).ok());
  EXPECT_FALSE(vehicle.armed);
  vehicle.command_results.assign(100, 4);
  const Status never = arm(vehicle, std::chrono::seconds(10));
  EXPECT_EQ(never.error().message, "arming: vehicle 1.1 answers 'failed': PreArm: EKF starting");
  vehicle.command_results = {3};
  EXPECT_THAT(arm(vehicle, std::chrono::seconds(10)).error().message, HasSubstr("unsupported"));
}

TEST(MessageRates, AskForLowerRatesThanTheVehicleDenies) {
  FakeVehicle vehicle;
  vehicle.command_results = {2, 2, 0};
  Result<RateRequest> asked = request_message_rate(vehicle, MessageId::kSimState, 50.0);
  ASSERT_TRUE(asked.ok());
  EXPECT_EQ(*asked, RateRequest::kInterval);
  ASSERT_EQ(vehicle.commands.size(), 3U);
  EXPECT_EQ(PayloadReader(vehicle.commands[1]).at<float>(4), 25000.0F);  // us
  EXPECT_EQ(PayloadReader(vehicle.commands[2]).at<float>(4), 31250.0F);
  vehicle.command_results.assign(100, 2);
  asked = request_message_rate(vehicle, MessageId::kTimesync, 10.0);
  ASSERT_TRUE(asked.ok());
  EXPECT_EQ(*asked, RateRequest::kNone);
  EXPECT_EQ(vehicle.commands.size(), 13U);
}

/// Longer than an answer is waited for: each request is sent again, and answered as often.
TEST(MessageRates, AreThoseOfTheirMessageHoweverLateTheAnswersAre) {
  for (const int latency_ms : {900, 1500, 2000, 2500}) {
    FakeVehicle vehicle;
    vehicle.latency = milliseconds(latency_ms);
    vehicle.unknown_messages = {105, 295};
    const std::pair<MessageId, RateRequest> requests[] = {
        {MessageId::kHighresImu, RateRequest::kNone},
        {MessageId::kRawImu, RateRequest::kInterval},
        {MessageId::kScaledPressure, RateRequest::kInterval},
        {MessageId::kAirspeed, RateRequest::kNone},
        {MessageId::kVfrHud, RateRequest::kInterval}};
    for (const auto& [message, expected] : requests) {
      const Result<RateRequest> asked = request_message_rate(vehicle, message, 10.0);
      ASSERT_TRUE(asked.ok()) << asked.error().message;
      EXPECT_EQ(*asked, expected) << latency_ms << " ms, message " << static_cast<int>(message);
    }
  }
}

TEST(MessageRates, FallBackToStreamsOfOldFirmware) {
  FakeVehicle vehicle;
  Result<RateRequest> asked = request_message_rate(vehicle, MessageId::kSimState, 50.0);
  ASSERT_TRUE(asked.ok());
  EXPECT_EQ(*asked, RateRequest::kInterval);
  const PayloadReader command(vehicle.commands.back());
  EXPECT_EQ(command.at<std::uint16_t>(28), 511);
  EXPECT_EQ(command.at<float>(0), 108.0F);
  EXPECT_EQ(command.at<float>(4), 20000.0F);  // us
  vehicle.command_results = {3};
  asked = request_message_rate(vehicle, MessageId::kAttitude, 50.0);
  EXPECT_EQ(*asked, RateRequest::kStream);
  vehicle.ignores_commands = true;
  asked = request_message_rate(vehicle, MessageId::kGlobalPositionInt, 33.3);
  EXPECT_EQ(*asked, RateRequest::kStream);
  EXPECT_EQ(vehicle.received[66], 2);
  asked = request_message_rate(vehicle, MessageId::kTimesync, 1.0);
  EXPECT_EQ(*asked, RateRequest::kNone);
  EXPECT_THAT(request_message_rate(vehicle, MessageId::kAttitude, 0.0).error().message,
              HasSubstr("rate of ATTITUDE = 0 Hz: must be in (0, 1000]"));
}

std::vector<MissionItem> some_items(std::size_t count) {
  std::vector<MissionItem> items(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto n = static_cast<double>(i);
    items[i].x = (-353632620.0 + 1234.0 * n) / 1e7;
    items[i].y = (1491652370.0 + 987.0 * n) / 1e7;
    items[i].z = 300.0F;
  }
  return items;
}

TEST(Mission, RoundTripsDespiteLosses) {
  const std::vector<MissionItem> items = some_items(30);
  for (const bool old_requests : {false, true}) {
    for (const double loss : {0.0, 0.05, 0.1}) {
      FakeVehicle vehicle;
      vehicle.loss = loss;
      vehicle.old_mission_requests = old_requests;
      const Status uploaded = upload_mission(vehicle, items);
      ASSERT_TRUE(uploaded.ok()) << uploaded.error().message;
      ASSERT_EQ(vehicle.mission.size(), 30U);
      const Result<std::vector<MissionItem>> downloaded = download_mission(vehicle);
      ASSERT_TRUE(downloaded.ok()) << downloaded.error().message;
      EXPECT_EQ(*downloaded, items);
    }
  }
}

TEST(Mission, ReportsRefusalsAndSilence) {
  FakeVehicle vehicle;
  vehicle.mission_result = 4;
  EXPECT_EQ(upload_mission(vehicle, some_items(3)).error().message,
            "uploading the mission: vehicle 1.1 answers 'no space'");
  EXPECT_THAT(upload_mission(vehicle, {}).error().message, HasSubstr("0 items: must be in [1,"));
  vehicle.is_mute = true;
  EXPECT_THAT(upload_mission(vehicle, some_items(3)).error().message,
              HasSubstr("did not answer 5 requests within 1.5 s each"));
  EXPECT_THAT(download_mission(vehicle).error().message, HasSubstr("did not answer"));
  vehicle.is_mute = false;
  vehicle.mission.resize(6000);
  EXPECT_THAT(download_mission(vehicle).error().message,
              HasSubstr("has 6000 items: must be at most 5000"));
}

TEST(Mission, IsNotHeldUpByAVehicleThatAsksForever) {
  FakeVehicle vehicle;
  // Asks for the first item again and again.
  for (int i = 0; i < 1000; ++i) {
    vehicle.answer(MessageId::kMissionRequestInt, PayloadWriter(5));
  }
  const Status status = upload_mission(vehicle, some_items(3));
  ASSERT_FALSE(status.ok());
  EXPECT_THAT(status.error().message, HasSubstr("more than 20 times the number of items"));
  FakeVehicle odd;
  odd.answer(MessageId::kMissionRequestInt, PayloadWriter(5).put(0, std::uint16_t{9}));
  EXPECT_THAT(upload_mission(odd, some_items(3)).error().message,
              HasSubstr("asks for item 9 of 3"));
}

TEST(MissionFile, IsReadAsAGroundStationWroteIt) {
  OVERFLY_DATA_OR_SKIP(file, "sitl/plane25_mission.waypoints");
  const Result<StoredMission> mission = read_mission_file(file);
  ASSERT_TRUE(mission.ok()) << mission.error().message;
  EXPECT_TRUE(mission->warnings.empty());
  const std::vector<MissionItem>* const items = &mission->items;
  ASSERT_EQ(items->size(), 21U);
  EXPECT_EQ((*items)[0].frame, 0);
  EXPECT_TRUE((*items)[0].current);
  EXPECT_EQ((*items)[0].z, 584.0F);
  EXPECT_EQ((*items)[1].command, 22);
  EXPECT_EQ((*items)[1].parameters[0], 15.0F);
  EXPECT_EQ((*items)[2].command, 178);
  EXPECT_EQ((*items)[2].parameters[1], 25.0F);
  EXPECT_EQ((*items)[8].x, -35.38574503);
  EXPECT_EQ((*items)[8].y, 149.16523700);
  EXPECT_EQ((*items)[20].command, 20);
  FakeVehicle vehicle;
  ASSERT_TRUE(upload_mission(vehicle, *items).ok());
  const Result<std::vector<MissionItem>> back = download_mission(vehicle);
  ASSERT_TRUE(back.ok());
  for (std::size_t i = 0; i < items->size(); ++i) {
    EXPECT_NEAR((*back)[i].x, (*items)[i].x, 0.51e-7);
    EXPECT_NEAR((*back)[i].y, (*items)[i].y, 0.51e-7);
  }
}

TEST(MissionFile, NamesFileLineColumnValueAndLimit) {
  overfly::testing::TemporaryFolder folder;
  const auto file = folder.path() / "mission.waypoints";
  const auto message_of = [&](const std::string& text) {
    overfly::testing::write_text(file, text);
    const Result<StoredMission> items = read_mission_file(file);
    return items.ok() ? std::string() : items.error().message;
  };
  const std::string head = "QGC WPL 110\n";
  EXPECT_THAT(message_of(""), HasSubstr("must be 'QGC WPL 110'"));
  EXPECT_THAT(message_of("QGC WPL 120\n"), HasSubstr("must be 'QGC WPL 110'"));
  EXPECT_THAT(message_of(head), HasSubstr("0 mission items: must be in [1, 5000]"));
  EXPECT_THAT(message_of(head + "0 1 0 16 0 0 0 0 91 0 0 1\n"),
              HasSubstr("mission.waypoints:2: column 9 = '91': must be in [-90, 90]"));
  EXPECT_THAT(message_of(head + "1 1 0 16 0 0 0 0 0 0 0 1\n"), HasSubstr("column 1 = '1'"));
  EXPECT_THAT(message_of(head + "0 1 0 16 0 0 0 0 0 0 0\n"), HasSubstr("11 columns: must be 12"));
  EXPECT_THAT(message_of(head + "0 1 0 70000 0 0 0 0 0 0 0 1\n"), HasSubstr("[0, 65535]"));
  EXPECT_EQ(message_of(head + "0 1 0 16 0 0 0 0 -35.5 149 584 1\r\n"), "");
}

}  // namespace
}  // namespace overfly::flight::mavlink
