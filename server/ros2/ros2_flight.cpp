#include "server/ros2/ros2_flight.hpp"

#include <array>
#include <cstring>

#include "server/ros2/cdr_writer.hpp"

namespace overfly::server {
namespace {

const std::string kPoseDefinition = ros2_definition::kSeparator +
                                    "MSG: geometry_msgs/Pose\ngeometry_msgs/Point position\n"
                                    "geometry_msgs/Quaternion orientation\n" +
                                    ros2_definition::kSeparator +
                                    "MSG: geometry_msgs/Point\nfloat64 x\nfloat64 y\nfloat64 z\n" +
                                    ros2_definition::kQuaternion;

/// Of rcl_interfaces/msg/Log.
std::uint8_t level_number(const std::string& level) {
  constexpr std::uint8_t kInfo = 20;
  constexpr std::uint8_t kWarning = 30;
  constexpr std::uint8_t kError = 40;
  return level == "error" ? kError : level == "warning" ? kWarning : kInfo;
}

}  // namespace

const Ros2Type kRos2CompressedImage = {
    "sensor_msgs/msg/CompressedImage",
    "std_msgs/Header header\nstring format\nuint8[] data\n" + ros2_definition::kHeader};

const Ros2Type kRos2Path = {"nav_msgs/msg/Path",
                            "std_msgs/Header header\ngeometry_msgs/PoseStamped[] poses\n" +
                                ros2_definition::kHeader + ros2_definition::kSeparator +
                                "MSG: geometry_msgs/PoseStamped\nstd_msgs/Header header\n"
                                "geometry_msgs/Pose pose\n" +
                                kPoseDefinition};

const Ros2Type kRos2PointCloud = {
    "sensor_msgs/msg/PointCloud2",
    "std_msgs/Header header\nuint32 height\nuint32 width\nsensor_msgs/PointField[] fields\n"
    "bool is_bigendian\nuint32 point_step\nuint32 row_step\nuint8[] data\nbool is_dense\n" +
        ros2_definition::kHeader + ros2_definition::kSeparator +
        "MSG: sensor_msgs/PointField\nstring name\nuint32 offset\nuint8 datatype\nuint32 count\n"};

const Ros2Type kRos2NavSatFix = {
    "sensor_msgs/msg/NavSatFix",
    "std_msgs/Header header\nsensor_msgs/NavSatStatus status\nfloat64 latitude\n"
    "float64 longitude\nfloat64 altitude\nfloat64[9] position_covariance\n"
    "uint8 position_covariance_type\n" +
        ros2_definition::kHeader + ros2_definition::kSeparator +
        "MSG: sensor_msgs/NavSatStatus\nint8 status\nuint16 service\n"};

const Ros2Type kRos2Log = {
    "rcl_interfaces/msg/Log",
    "builtin_interfaces/Time stamp\nuint8 level\nstring name\nstring msg\nstring file\n"
    "string function\nuint32 line\n" +
        ros2_definition::kSeparator + "MSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n"};

const Ros2Type kRos2EstimateState = {
    "overfly_msgs/msg/EstimateState",
    "std_msgs/Header header\nstring state\nfloat64 latency_ms\nint32 map_id\nfloat64 error_m\n"
    "float64 error_along_m\nfloat64 error_across_m\nfloat64 error_up_m\n"
    "float64 error_rotation_deg\n" +
        ros2_definition::kHeader};

std::vector<std::uint8_t> ros2_jpeg_head(const Ros2Header& header, std::size_t jpeg_bytes) {
  CdrWriter message(header);
  message.text("jpeg");
  message.number(static_cast<std::uint32_t>(jpeg_bytes));
  return message.take();
}

std::vector<std::uint8_t> ros2_path(const Ros2Header& header,
                                    const std::vector<StampedPose>& poses) {
  CdrWriter message(header);
  message.number(static_cast<std::uint32_t>(poses.size()));
  for (const StampedPose& stamped : poses) {
    message.header({stamped.stamp_ns, header.frame_id});
    message.pose(stamped.pose);
  }
  return message.take();
}

std::vector<std::uint8_t> ros2_points(const Ros2Header& header,
                                      const std::vector<Eigen::Vector3f>& points) {
  constexpr std::uint8_t kFloat32 = 7;
  constexpr std::uint32_t kStep = 3 * sizeof(float);
  const auto count = static_cast<std::uint32_t>(points.size());
  CdrWriter message(header);
  message.number(std::uint32_t{1});
  message.number(count);
  message.number(std::uint32_t{3});
  std::uint32_t offset = 0;
  for (const char* name : {"x", "y", "z"}) {
    message.text(name);
    message.number(offset);
    message.number(kFloat32);
    message.number(std::uint32_t{1});
    offset += sizeof(float);
  }
  message.number(std::uint8_t{0});
  message.number(kStep);
  message.number(kStep * count);
  std::vector<std::uint8_t> bytes(std::size_t{kStep} * count);
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::memcpy(bytes.data() + i * kStep, points[i].data(), kStep);
  }
  message.octets(bytes);
  message.number(std::uint8_t{1});
  return message.take();
}

std::vector<std::uint8_t> ros2_fix(const Ros2Header& header, const Geodetic& place) {
  CdrWriter message(header);
  message.number(std::int8_t{0});    // fix
  message.number(std::uint16_t{1});  // GPS
  message.number(deg_from_rad(place.lat_rad));
  message.number(deg_from_rad(place.lon_rad));
  message.number(place.alt_ellipsoid_m);
  message.numbers(std::array<double, 9>{});
  message.number(std::uint8_t{0});  // covariance not known
  return message.take();
}

std::vector<std::uint8_t> ros2_log(const Ros2LogLine& line) {
  CdrWriter message(Ros2Time{line.stamp_ns});
  message.number(level_number(line.level));
  message.text(line.source);
  message.text(line.text);
  message.text("");
  message.text("");
  message.number(std::uint32_t{0});
  return message.take();
}

std::vector<std::uint8_t> ros2_estimate_state(const Ros2Header& header,
                                              const Ros2EstimateState& state) {
  CdrWriter message(header);
  message.text(state.state);
  message.number(state.latency_ms);
  message.number(state.map_id);
  message.number(state.error_m);
  message.number(state.error_along_m);
  message.number(state.error_across_m);
  message.number(state.error_up_m);
  message.number(state.error_rotation_deg);
  return message.take();
}

}  // namespace overfly::server
