// overfly play: recordings as messages on a link, whose bytes are taken apart here.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "tests/flight/logs/log_bytes.hpp"
#include "tests/flight/logs/northward_log.hpp"
#include "tests/flight/mavlink/link/peer_socket.hpp"
#include "tests/server/app/program.hpp"
#include "tests/support/support.hpp"

namespace overfly::testing {
namespace {

using flight::testing::append;
using flight::testing::Bytes;
using ::testing::HasSubstr;

/// SIM_STATE of MAVLink 2: latitude and longitude [1e-7 deg], height [m].
struct SimState {
  std::int32_t lat = 0;
  std::int32_t lon = 0;
  float alt_m = 0.0F;
};

class PlayCommand : public ::testing::Test {
 protected:
  void SetUp() override {
    port_ = socket_.bind_to(0, false);
    const int bytes = 1 << 20;
    ::setsockopt(socket_.get(), SOL_SOCKET, SO_RCVBUF, &bytes, sizeof bytes);
  }
  [[nodiscard]] std::string path(const std::string& name) const {
    return (folder_.path() / name).string();
  }
  Outcome play(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "play");
    for (const std::string& more : {std::string("--link"),
                                    "udp:127.0.0.1:" + std::to_string(port_),
                                    std::string("--speed"),
                                    std::string("1000")}) {
      arguments.push_back(more);
    }
    return overfly_program(arguments);
  }
  /// Each datagram is a frame: 10 bytes of header, then the payload.
  std::vector<SimState> received_states() {
    std::vector<SimState> states;
    while (socket_.readable(0)) {
      const std::vector<std::uint8_t> frame = socket_.receive(0);
      if (frame.size() < 10 + 92 || frame[0] != 0xFD || frame[7] != 108 || frame[8] != 0) continue;
      SimState state;
      std::memcpy(&state.alt_m, frame.data() + 10 + 60, 4);
      std::memcpy(&state.lat, frame.data() + 10 + 84, 4);
      std::memcpy(&state.lon, frame.data() + 10 + 88, 4);
      states.push_back(state);
    }
    return states;
  }

  TemporaryFolder folder_;
  flight::testing::PeerSocket socket_{SOCK_DGRAM};
  std::uint16_t port_ = 0;
};

TEST_F(PlayCommand, FliesTheTruthOfALog) {
  write_text(path("flight.bin"), northward_log());
  const Outcome played = play({path("flight.bin"), "--rate-hz", "25"});
  ASSERT_EQ(played.exit_code, 0) << played.err;
  // 50 positions in steps of 40 ms; a heartbeat and a time each second.
  EXPECT_THAT(played.out,
              HasSubstr("log: flight.bin, SIM with the attitude of SIM: 204 messages, 1.96 s"));
  EXPECT_THAT(played.out, HasSubstr("204 messages sent"));
  const std::vector<SimState> states = received_states();
  ASSERT_EQ(states.size(), 50U);
  for (std::size_t i = 0; i < states.size(); ++i) {
    EXPECT_NEAR(states[i].lat, 470000000 + 90 * static_cast<std::int32_t>(i), 1);
    EXPECT_EQ(states[i].lon, 80000000);
    EXPECT_NEAR(states[i].alt_m, 500.0, 1e-3);
  }
}

TEST_F(PlayCommand, PlacesPositionsWithoutAnOrigin) {
  Bytes log;
  for (int i = 0; i < 20; ++i) {
    append(log,
           flight::testing::lcm_event(
               i,
               1'700'000'000'000'000 + 100'000 * i,
               "OVERFLY_TRUTH",
               flight::testing::lcm_truth(
                   i * 100'000'000LL,
                   {0.0, 2.5 * i, 100.0},
                   Eigen::Quaterniond(Eigen::AngleAxisd(EIGEN_PI, Eigen::Vector3d::UnitX())))));
  }
  flight::testing::write_bytes(path("flight.lcm"), log);
  const Outcome lost = play({path("flight.lcm")});
  EXPECT_NE(lost.exit_code, 0);
  EXPECT_THAT(lost.err, HasSubstr("count from an origin that the log does not state"));
  const Outcome played = play({path("flight.lcm"), "--origin", "47,8,400", "--rate-hz", "10"});
  ASSERT_EQ(played.exit_code, 0) << played.err;
  const std::vector<SimState> states = received_states();
  ASSERT_EQ(states.size(), 20U);
  EXPECT_EQ(states[0].lat, 470000000);
  EXPECT_EQ(states[0].lon, 80000000);
  EXPECT_NEAR(states[19].alt_m, 500.0, 1e-3);
  // 47.5 m over the radius of the meridian at 47 deg N and 500 m: 6369.7 km.
  EXPECT_NEAR(states[19].lat - 470000000, 47.5 / 6'369'700.0 * 180.0 / EIGEN_PI * 1e7, 2.0);
}

TEST_F(PlayCommand, SaysWhatDoesNotGoTogether) {
  write_text(path("flight.bin"), northward_log());
  EXPECT_THAT(play({path("flight.bin"), "--origin", "47,8,400"}).err,
              HasSubstr("an origin was given, but the positions of SIM have their place"));
  EXPECT_THAT(play({path("flight.bin"), "--origin", "47,8"}).err,
              HasSubstr("--origin 47,8: must be LAT,LON,HEIGHT"));
  EXPECT_THAT(play({path("flight.bin"), "--source", "GPS"}).err, HasSubstr("GPS"));
  EXPECT_THAT(play({path("flight.bin"), "--rate-hz", "0"}).err,
              HasSubstr("rate = 0 Hz: must be in [1, 1000]"));
  write_text(path("a.tum"), "0 0 0 100 0 0 0 1\n1 0 25 100 0 0 0 1\n");
  EXPECT_THAT(play({path("a.tum")}).err, HasSubstr("must be given as --origin"));
  EXPECT_EQ(play({path("a.tum"), "--origin", "47,8,400"}).exit_code, 0);
  EXPECT_THAT(play({path("none.bin")}).err, HasSubstr("none.bin"));
  // A live run that has heard nothing leaves a recording without a frame.
  std::filesystem::create_directory(path("live"));
  write_text(path("live/vehicle.tlog"), "");
  EXPECT_THAT(play({path("live")}).err, HasSubstr("vehicle.tlog: holds no poses"));
  write_text(path("empty.tum"), "");
  EXPECT_THAT(play({path("empty.tum")}).err, HasSubstr("empty.tum: holds no poses"));
  EXPECT_NE(play({folder_.path().string()}).exit_code, 0);
}

TEST_F(PlayCommand, PlaysOntoLcmAndRosOnlyOneAtATime) {
  write_text(path("flight.bin"), northward_log());
  EXPECT_THAT(overfly_program({"play", path("flight.bin"), "--ros", "--lcm", "memq://"}).err,
              HasSubstr("--link, --lcm, --ros: give one of them"));
  EXPECT_THAT(overfly_program({"play", path("flight.bin"), "--ros-master", "somewhere"}).err,
              HasSubstr("somewhere"));
  const std::string url = "file://" + path("played.lcm") + "?mode=w";
  const Outcome played = overfly_program(
      {"play", path("flight.bin"), "--lcm", url, "--speed", "1000", "--rate-hz", "25"});
  if (played.err.find("no LCM support") != std::string::npos) GTEST_SKIP() << played.err;
  ASSERT_EQ(played.exit_code, 0) << played.err;
  EXPECT_THAT(played.out, HasSubstr("map at 47,8,500: 150 messages, 1.96 s, on file://"));
  EXPECT_THAT(played.out, HasSubstr("150 messages sent"));
  const Outcome info = overfly_program({"log", "info", path("played.lcm")});
  EXPECT_THAT(info.out, HasSubstr("OVERFLY_TRUTH"));
  EXPECT_THAT(info.out, HasSubstr("OVERFLY_GPS"));
}

}  // namespace
}  // namespace overfly::testing
