// Frames exchanged with an independent implementation of MAVLink, node-mavlink.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/measure/sha256.hpp"
#include "flight/mavlink/frame_finder.hpp"
#include "flight/mavlink/link/signing.hpp"
#include "flight/mavlink/messages.hpp"
#include "flight/mavlink/vehicle/commands.hpp"
#include "flight/mavlink/vehicle/mission.hpp"
#include "flight/mavlink/vehicle/parameters.hpp"
#include "tests/flight/mavlink/peer/peer_script.hpp"
#include "tests/flight/mavlink/vehicle/fake_vehicle.hpp"
#include "tests/support/support.hpp"

namespace overfly::flight::mavlink {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::StartsWith;

/// The lines that the peer prints; empty if it is not installed.
std::vector<std::string> ask_peer(const std::string& arguments) {
  return testing::lines_of_script("peer.cjs", arguments);
}

SigningKey peer_key() {
  SigningKey key{};
  for (std::size_t i = 0; i < key.size(); ++i) key[i] = static_cast<std::uint8_t>(7 * i);
  return key;
}

/// Keeps what is sent to a vehicle, as frames.
class FrameKeeper final : public Exchange {
 public:
  explicit FrameKeeper(Exchange& vehicle) : vehicle_(vehicle) {}
  [[nodiscard]] Target target() const override { return vehicle_.target(); }
  [[nodiscard]] Status send(MessageId id, const PayloadWriter& payload) override {
    const Frame frame{Version::kTwo,
                      sequence_++,
                      255,
                      190,
                      static_cast<std::uint32_t>(id),
                      false,
                      payload.bytes()};
    const auto bytes =
        sequence_ % 2 == 0 ? encode_frame(frame) : encode_signed_frame(frame, peer_key(), 1, 1000);
    if (!bytes) return bytes.error();
    frames += hex_text(*bytes) + " ";
    return vehicle_.send(id, payload);
  }
  [[nodiscard]] Result<std::optional<HeldMessage>> next(TimePoint deadline) override {
    return vehicle_.next(deadline);
  }
  [[nodiscard]] TimePoint now() const override { return vehicle_.now(); }

  std::string frames;

 private:
  Exchange& vehicle_;
  std::uint8_t sequence_ = 0;
};

TEST(MavlinkPeer, ReadsWhatIsSent) {
  testing::FakeVehicle vehicle;
  vehicle.parameters["AIRSPEED_CRUISE"] = {"AIRSPEED_CRUISE", 22.0, 9};
  FrameKeeper exchange(vehicle);
  ASSERT_TRUE(arm(exchange, std::chrono::seconds(1)).ok());
  ASSERT_TRUE(set_parameter(exchange, "AIRSPEED_CRUISE", 25.5).ok());
  std::vector<MissionItem> items(2);
  items[1].command = 178;
  items[1].parameters = {0, 25, -1, 0};
  items[1].x = -35.363262;
  items[1].y = 149.165237;
  items[1].z = 300;
  ASSERT_TRUE(upload_mission(exchange, items).ok());
  const std::vector<std::string> lines =
      ask_peer("read " + hex_text(peer_key()) + " " + exchange.frames);
  if (lines.empty()) GTEST_SKIP() << testing::kPeerNotInstalled;
  EXPECT_EQ(lines.size(), 6U);
  EXPECT_THAT(lines, ::testing::Each(::testing::Not(HasSubstr("forged"))));
  EXPECT_THAT(lines[0],
              AllOf(StartsWith("COMMAND_LONG seq=0 signed"),
                    HasSubstr("target_system=1 "),
                    HasSubstr("command=400 "),
                    HasSubstr("param1=1 ")));
  EXPECT_THAT(lines[1],
              AllOf(StartsWith("PARAM_REQUEST_READ seq=1 unsigned"),
                    HasSubstr("param_id=AIRSPEED_CRUISE"),
                    HasSubstr("param_index=-1")));
  EXPECT_THAT(lines[2],
              AllOf(StartsWith("PARAM_SET seq=2 signed"),
                    HasSubstr("param_id=AIRSPEED_CRUISE"),
                    HasSubstr("param_value=25.5"),
                    HasSubstr("param_type=9")));
  EXPECT_THAT(lines[3], AllOf(StartsWith("MISSION_COUNT"), HasSubstr("count=2")));
  EXPECT_THAT(lines[5],
              AllOf(StartsWith("MISSION_ITEM_INT"),
                    HasSubstr("seq=1 "),
                    HasSubstr("command=178"),
                    HasSubstr("param2=25"),
                    HasSubstr("x=-353632620"),
                    HasSubstr("y=1491652370"),
                    HasSubstr("z=300")));
}

TEST(MavlinkPeer, IsRead) {
  const std::vector<std::string> lines = ask_peer("write " + hex_text(peer_key()));
  if (lines.empty()) GTEST_SKIP() << testing::kPeerNotInstalled;
  ASSERT_EQ(lines.size(), 4U);
  std::vector<std::uint8_t> bytes;
  for (const std::string& line : lines) {
    for (std::size_t i = 0; i + 1 < line.size(); i += 2) {
      bytes.push_back(static_cast<std::uint8_t>(std::stoi(line.substr(i, 2), nullptr, 16)));
    }
  }
  FrameFinder finder;
  std::span<const std::uint8_t> rest = bytes;
  std::vector<FrameFinder::Found> found;
  for (int i = 0; i < 4; ++i) {
    found.push_back(finder.next(rest, true));
    ASSERT_TRUE(found.back().frame);
    rest = rest.subspan(found.back().consumed_bytes);
  }
  EXPECT_EQ(finder.counts().skipped_bytes, 0U);
  EXPECT_EQ(found[0].frame->version, Version::kOne);
  EXPECT_TRUE(decode_heartbeat(*found[0].frame).armed());
  EXPECT_EQ(decode_heartbeat(*found[0].frame).custom_mode, 10U);
  const GlobalPositionVelocity position = decode_global_position(*found[1].frame);
  EXPECT_EQ(boot_time_ns(*found[1].frame), 123456 * std::int64_t{1'000'000});
  EXPECT_NEAR(position.position.lat_deg, -35.363262, 1e-9);
  EXPECT_EQ(position.position.alt_msl_m, 584.0);
  EXPECT_EQ(position.velocity_ned_m_s, Eigen::Vector3d(25.0, -1.0, 0.07));
  const SimulatedState sim = decode_sim_state(*found[2].frame);
  EXPECT_NEAR(sim.position.lon_deg, 149.165237, 1e-9);
  EXPECT_EQ(sim.velocity_ned_m_s, Eigen::Vector3d(25.0, 1.0, -2.0));
  EXPECT_EQ(sim.rate_rad_s, Eigen::Vector3d(0.0, 0.0, 0.25));
  SignatureCheck signatures(peer_key(), 0);
  EXPECT_FALSE(signatures.accepts(*found[2].frame, found[2].bytes));
  EXPECT_TRUE(signatures.accepts(*found[3].frame, found[3].bytes));
  EXPECT_EQ(signatures.timestamp(),
            signing_time(std::chrono::system_clock::from_time_t(1'767'225'600)));
}

}  // namespace
}  // namespace overfly::flight::mavlink
