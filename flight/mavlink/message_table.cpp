// Ids, lengths and CRC_EXTRA of MAVLink's message sets minimal, standard, common and ardupilotmega
// (definitions of July 2026).
#include "flight/mavlink/message_table.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

namespace overfly::flight::mavlink {
namespace {

/// Ordered by id.
constexpr auto kMessages = std::to_array<MessageFacts>({
    {0, "HEARTBEAT", 50, 9, 9},
    {1, "SYS_STATUS", 124, 31, 43},
    {2, "SYSTEM_TIME", 137, 12, 12},
    {4, "PING", 237, 14, 14},
    {11, "SET_MODE", 89, 6, 6},
    {20, "PARAM_REQUEST_READ", 214, 20, 20},
    {21, "PARAM_REQUEST_LIST", 159, 2, 2},
    {22, "PARAM_VALUE", 220, 25, 25},
    {23, "PARAM_SET", 168, 23, 23},
    {24, "GPS_RAW_INT", 24, 30, 52},
    {26, "SCALED_IMU", 170, 22, 24},
    {27, "RAW_IMU", 144, 26, 29},
    {29, "SCALED_PRESSURE", 115, 14, 16},
    {30, "ATTITUDE", 39, 28, 28},
    {31, "ATTITUDE_QUATERNION", 246, 32, 48},
    {32, "LOCAL_POSITION_NED", 185, 28, 28},
    {33, "GLOBAL_POSITION_INT", 104, 28, 28},
    {35, "RC_CHANNELS_RAW", 244, 22, 22},
    {36, "SERVO_OUTPUT_RAW", 222, 21, 37},
    {39, "MISSION_ITEM", 254, 37, 38},
    {40, "MISSION_REQUEST", 230, 4, 5},
    {41, "MISSION_SET_CURRENT", 28, 4, 4},
    {42, "MISSION_CURRENT", 28, 2, 18},
    {43, "MISSION_REQUEST_LIST", 132, 2, 3},
    {44, "MISSION_COUNT", 221, 4, 9},
    {45, "MISSION_CLEAR_ALL", 232, 2, 3},
    {46, "MISSION_ITEM_REACHED", 11, 2, 2},
    {47, "MISSION_ACK", 153, 3, 8},
    {48, "SET_GPS_GLOBAL_ORIGIN", 41, 13, 21},
    {49, "GPS_GLOBAL_ORIGIN", 39, 12, 20},
    {51, "MISSION_REQUEST_INT", 196, 4, 5},
    {62, "NAV_CONTROLLER_OUTPUT", 183, 26, 26},
    {65, "RC_CHANNELS", 118, 42, 42},
    {66, "REQUEST_DATA_STREAM", 148, 6, 6},
    {73, "MISSION_ITEM_INT", 38, 37, 38},
    {74, "VFR_HUD", 20, 20, 20},
    {75, "COMMAND_INT", 158, 35, 35},
    {76, "COMMAND_LONG", 152, 33, 33},
    {77, "COMMAND_ACK", 143, 3, 10},
    {87, "POSITION_TARGET_GLOBAL_INT", 150, 51, 51},
    {102, "VISION_POSITION_ESTIMATE", 158, 32, 117},
    {103, "VISION_SPEED_ESTIMATE", 208, 20, 57},
    {105, "HIGHRES_IMU", 93, 62, 63},
    {108, "SIM_STATE", 32, 84, 92},
    {109, "RADIO_STATUS", 185, 9, 9},
    {111, "TIMESYNC", 34, 16, 18},
    {112, "CAMERA_TRIGGER", 174, 12, 12},
    {115, "HIL_STATE_QUATERNION", 4, 64, 64},
    {116, "SCALED_IMU2", 76, 22, 24},
    {124, "GPS2_RAW", 87, 35, 57},
    {125, "POWER_STATUS", 203, 6, 6},
    {129, "SCALED_IMU3", 46, 22, 24},
    {132, "DISTANCE_SENSOR", 85, 14, 39},
    {133, "TERRAIN_REQUEST", 6, 18, 18},
    {136, "TERRAIN_REPORT", 1, 22, 22},
    {137, "SCALED_PRESSURE2", 195, 14, 16},
    {147, "BATTERY_STATUS", 154, 36, 54},
    {148, "AUTOPILOT_VERSION", 178, 60, 78},
    {150, "SENSOR_OFFSETS", 134, 42, 42},
    {152, "MEMINFO", 208, 4, 8},
    {158, "MOUNT_STATUS", 134, 14, 15},
    {162, "FENCE_STATUS", 189, 8, 9},
    {163, "AHRS", 127, 28, 28},
    {164, "SIMSTATE", 154, 44, 44},
    {165, "HWSTATUS", 21, 3, 3},
    {166, "RADIO", 21, 9, 9},
    {168, "WIND", 1, 12, 12},
    {173, "RANGEFINDER", 83, 8, 8},
    {174, "AIRSPEED_AUTOCAL", 167, 48, 48},
    {178, "AHRS2", 47, 24, 24},
    {180, "CAMERA_FEEDBACK", 52, 45, 47},
    {182, "AHRS3", 229, 40, 40},
    {193, "EKF_STATUS_REPORT", 71, 22, 26},
    {232, "GPS_INPUT", 151, 63, 65},
    {241, "VIBRATION", 90, 32, 32},
    {242, "HOME_POSITION", 104, 52, 60},
    {244, "MESSAGE_INTERVAL", 95, 6, 6},
    {245, "EXTENDED_SYS_STATE", 130, 2, 2},
    {253, "STATUSTEXT", 83, 51, 54},
    {295, "AIRSPEED", 234, 12, 12},
    {331, "ODOMETRY", 91, 230, 233},
    {11011, "VISION_POSITION_DELTA", 106, 44, 44},
    {11020, "AOA_SSA", 205, 16, 16},
});

constexpr std::size_t kIndexedIds = 512;
constexpr std::uint8_t kUnlisted = 0xFF;

/// Index in kMessages of the small ids, which most messages have.
constexpr std::array<std::uint8_t, kIndexedIds> small_ids() {
  std::array<std::uint8_t, kIndexedIds> index{};
  index.fill(kUnlisted);
  for (std::size_t i = 0; i < kMessages.size(); ++i) {
    if (kMessages[i].id < kIndexedIds) index[kMessages[i].id] = static_cast<std::uint8_t>(i);
  }
  return index;
}

constexpr std::array<std::uint8_t, kIndexedIds> kSmallIds = small_ids();
static_assert(kMessages.size() < kUnlisted);

}  // namespace

const MessageFacts* message_facts(std::uint32_t id) {
  if (id < kIndexedIds) {
    const std::uint8_t index = kSmallIds[id];
    return index == kUnlisted ? nullptr : &kMessages[index];
  }
  const auto* const found = std::lower_bound(
      kMessages.begin(), kMessages.end(), id, [](const MessageFacts& facts, std::uint32_t wanted) {
        return facts.id < wanted;
      });
  return found != kMessages.end() && found->id == id ? &*found : nullptr;
}

}  // namespace overfly::flight::mavlink
