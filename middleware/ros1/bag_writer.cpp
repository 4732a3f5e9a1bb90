#include "middleware/ros1/bag_writer.hpp"

#include <rosbag/bag.h>

#include <utility>

#include "middleware/ros1/messages.hpp"
#include "middleware/ros1/sensor_messages.hpp"
#include "middleware/ros1/types.hpp"

namespace overfly::ros1 {
namespace {

class BagFile final : public BagWriter {
 public:
  explicit BagFile(std::filesystem::path file) : file_(std::move(file)) {}

  Status open() {
    return guarded([&] { bag_.open(file_.string(), rosbag::bagmode::Write); });
  }

  Status add_image(const std::string& topic,
                   const std::string& frame_id,
                   std::int64_t stamp_ns,
                   const Image& image) override {
    return write(topic, frame_id, stamp_ns, message_from(image));
  }

  Status add_camera_info(const std::string& topic,
                         const std::string& frame_id,
                         std::int64_t stamp_ns,
                         const CameraModel& camera) override {
    return write(topic, frame_id, stamp_ns, message_from(camera.pinhole(), camera.distortion()));
  }

  Status add_pose(const std::string& topic,
                  const std::string& parent_frame,
                  std::int64_t stamp_ns,
                  const Pose& T_parent_child) override {
    PoseStampedMessage message;
    message.pose = pose_message_from(T_parent_child);
    return write(topic, parent_frame, stamp_ns, std::move(message));
  }

  Status add_transform(const std::string& parent_frame,
                       const std::string& child_frame,
                       std::int64_t stamp_ns,
                       const Pose& T_parent_child) override {
    const ros::Time stamp = time_from_ns(stamp_ns);
    TransformsMessage message;
    message.transforms.resize(1);
    message.transforms[0].header.stamp = stamp;
    message.transforms[0].header.frame_id = parent_frame;
    message.transforms[0].child_frame_id = child_frame;
    message.transforms[0].transform = transform_message_from(T_parent_child);
    return guarded([&] { bag_.write("/tf", stamp, message); });
  }

  Status add_samples(const SensorSamples& samples, std::int64_t epoch_utc_ns) override {
    return with_each_message(
        samples,
        [&](const char* topic, std::int64_t measured_ns, std::int64_t available_ns, auto message) {
          message.header.stamp = time_from_ns(epoch_utc_ns + measured_ns);
          const ros::Time time = time_from_ns(epoch_utc_ns + available_ns);
          return guarded([&] { bag_.write(topic, time, message); });
        });
  }

  Status close() override {
    return guarded([&] { bag_.close(); });
  }

 private:
  template <typename M>
  Status write(const std::string& topic,
               const std::string& frame_id,
               std::int64_t stamp_ns,
               M message) {
    const ros::Time stamp = time_from_ns(stamp_ns);
    message.header.stamp = stamp;
    message.header.frame_id = frame_id;
    return guarded([&] { bag_.write(topic, stamp, message); });
  }

  template <typename Action>
  Status guarded(const Action& action) const {
    try {
      action();
    } catch (const std::exception& failure) {
      return Error{ErrorCode::kIo, file_.string() + ": " + failure.what()};
    }
    return {};
  }

  std::filesystem::path file_;
  rosbag::Bag bag_;
};

}  // namespace

Result<std::unique_ptr<BagWriter>> BagWriter::create(const std::filesystem::path& file) {
  auto writer = std::make_unique<BagFile>(file);
  if (Status status = writer->open(); !status) return status.error();
  return std::unique_ptr<BagWriter>(std::move(writer));
}

}  // namespace overfly::ros1
