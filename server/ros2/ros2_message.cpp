#include "server/ros2/ros2_message.hpp"

#include <array>

#include "server/ros2/cdr_writer.hpp"

namespace overfly::server {

const Ros2Type kRos2Image = {
    "sensor_msgs/msg/Image",
    "std_msgs/Header header\nuint32 height\nuint32 width\nstring encoding\nuint8 is_bigendian\n"
    "uint32 step\nuint8[] data\n" +
        ros2_definition::kHeader};

const Ros2Type kRos2CameraInfo = {
    "sensor_msgs/msg/CameraInfo",
    "std_msgs/Header header\nuint32 height\nuint32 width\nstring distortion_model\nfloat64[] d\n"
    "float64[9] k\nfloat64[9] r\nfloat64[12] p\nuint32 binning_x\nuint32 binning_y\n"
    "sensor_msgs/RegionOfInterest roi\n" +
        ros2_definition::kHeader + ros2_definition::kSeparator +
        "MSG: sensor_msgs/RegionOfInterest\nuint32 x_offset\nuint32 y_offset\nuint32 height\n"
        "uint32 width\nbool do_rectify\n"};

const Ros2Type kRos2PoseStamped = {
    "geometry_msgs/msg/PoseStamped",
    "std_msgs/Header header\ngeometry_msgs/Pose pose\n" + ros2_definition::kHeader +
        ros2_definition::kSeparator +
        "MSG: geometry_msgs/Pose\ngeometry_msgs/Point position\n"
        "geometry_msgs/Quaternion orientation\n" +
        ros2_definition::kSeparator +
        "MSG: geometry_msgs/Point\nfloat64 x\nfloat64 y\nfloat64 z\n" +
        ros2_definition::kQuaternion};

const Ros2Type kRos2TfMessage = {
    "tf2_msgs/msg/TFMessage",
    "geometry_msgs/TransformStamped[] transforms\n" + ros2_definition::kSeparator +
        "MSG: geometry_msgs/TransformStamped\nstd_msgs/Header header\nstring child_frame_id\n"
        "geometry_msgs/Transform transform\n" +
        ros2_definition::kHeader + ros2_definition::kSeparator +
        "MSG: geometry_msgs/Transform\ngeometry_msgs/Vector3 translation\n"
        "geometry_msgs/Quaternion rotation\n" +
        ros2_definition::kVector3 + ros2_definition::kQuaternion};

std::vector<std::uint8_t> ros2_image(const Ros2Header& header, const Image& image) {
  CdrWriter message(header);
  message.number(static_cast<std::uint32_t>(image.height_px));
  message.number(static_cast<std::uint32_t>(image.width_px));
  message.text(image.channels == 1 ? "mono8" : "rgb8");
  message.number(std::uint8_t{0});
  message.number(static_cast<std::uint32_t>(image.width_px * image.channels));
  message.octets(image.data);
  return message.take();
}

std::vector<std::uint8_t> ros2_camera_info(const Ros2Header& header, const CameraModel& camera) {
  const PinholeCamera& c = camera.pinhole();
  const Distortion& lens = camera.distortion();
  const bool radtan =
      lens.model == DistortionModel::kNone || lens.model == DistortionModel::kRadtan;
  const int count = coefficient_count(radtan ? DistortionModel::kRadtan : lens.model);
  CdrWriter message(header);
  message.number(static_cast<std::uint32_t>(c.height_px));
  message.number(static_cast<std::uint32_t>(c.width_px));
  message.text(radtan                                        ? "plumb_bob"
               : lens.model == DistortionModel::kEquidistant ? "equidistant"
                                                             : "fov");
  message.number(static_cast<std::uint32_t>(count));
  message.numbers(std::span(lens.k).first(static_cast<std::size_t>(count)));
  message.numbers(std::array{c.fx_px, 0.0, c.cx_px, 0.0, c.fy_px, c.cy_px, 0.0, 0.0, 1.0});
  message.numbers(std::array{1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0});
  message.numbers(
      std::array{c.fx_px, 0.0, c.cx_px, 0.0, 0.0, c.fy_px, c.cy_px, 0.0, 0.0, 0.0, 1.0, 0.0});
  for (int i = 0; i < 6; ++i) message.number(std::uint32_t{0});  // binning, region of interest
  message.number(std::uint8_t{0});                               // do_rectify
  return message.take();
}

std::vector<std::uint8_t> ros2_pose(const Ros2Header& header, const Pose& pose) {
  CdrWriter message(header);
  message.pose(pose);
  return message.take();
}

std::vector<std::uint8_t> ros2_transform(const Ros2Header& header,
                                         const std::string& child_frame,
                                         const Pose& T_parent_child) {
  CdrWriter message(std::uint32_t{1});
  message.header(header);
  message.text(child_frame);
  message.pose(T_parent_child);
  return message.take();
}

}  // namespace overfly::server
