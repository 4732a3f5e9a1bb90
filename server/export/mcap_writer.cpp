// An MCAP file with messages of ROS 2: for each camera the images as given to estimators, the
// calibration with each image, the truth of every frame, and the samples of the aircraft's sensors;
// of a run also its estimates.
#include <limits>
#include <map>
#include <system_error>

#include "server/export/dataset_writer.hpp"
#include "server/export/mcap/mcap_file.hpp"
#include "server/export/ros_topics.hpp"
#include "server/ros2/ros2_message.hpp"
#include "server/ros2/ros2_samples.hpp"

namespace overfly::server {
namespace {

namespace fs = std::filesystem;

class McapWriter final : public DatasetWriter {
 public:
  McapWriter(const DatasetPlan& plan, McapFile file, fs::path unfinished)
      : plan_(plan),
        names_(ros_camera_topics(plan.cameras)),
        file_(std::move(file)),
        unfinished_(std::move(unfinished)) {
    add_channel("/tf", kRos2TfMessage);
    for (const RosCameraTopics& camera : names_) {
      add_channel(camera.truth, kRos2PoseStamped);
      add_channel(camera.info, kRos2CameraInfo);
      add_channel(camera.image, kRos2Image);
    }
    for (const std::string& topic : estimates_.topics()) add_channel(topic, kRos2PoseStamped);
  }

  Result<std::vector<std::string>> add(const MadeFrame& frame) override {
    if (Status status = add_mounts_and_samples(frame); !status) return status.error();
    std::vector<std::string> names(frame.shots.size());
    for (std::size_t i = 0; i < frame.shots.size(); ++i) {
      const CameraShot& shot = frame.shots[i];
      Status status = add_truth(frame, shot, names_[i]);
      if (status && shot.delivered) {
        names[i] = std::to_string(plan_.epoch_utc_ns + shot.stamp_ns);
        status = add_image(shot, plan_.cameras[i], names_[i]);
      }
      if (!status) return status.error();
    }
    for (const RosEstimate& estimate : estimates_.of(frame.frame)) {
      const Ros2Header header{plan_.epoch_utc_ns + estimate.t_ns, estimate.frame_id};
      Status status = write(estimate.topic, header, ros2_pose(header, estimate.pose));
      if (!status) return status.error();
    }
    return names;
  }

  Status finish() override {
    if (Status status = file_.close(); !status) return status;
    std::error_code failure;
    fs::rename(unfinished_, plan_.folder / "flight.mcap", failure);
    if (!failure) return {};
    return Error{ErrorCode::kIo,
                 unfinished_.string() + ": cannot be renamed: " + failure.message()};
  }

 private:
  void add_channel(const std::string& topic, const Ros2Type& type) {
    channels_[topic] = file_.add_channel(topic, type.name, type.definition);
  }

  Status write(const std::string& topic,
               const Ros2Header& header,
               const std::vector<std::uint8_t>& message) {
    return file_.add_message(
        channels_.at(topic), static_cast<std::uint64_t>(header.stamp_ns), message);
  }

  Status add_image(const CameraShot& shot, const CameraSpec& camera, const RosCameraTopics& names) {
    const Ros2Header header{plan_.epoch_utc_ns + shot.stamp_ns, names.frame};
    Status status = write(names.info, header, ros2_camera_info(header, camera.model));
    return status ? write(names.image, header, ros2_image(header, grey_of(shot.image))) : status;
  }

  Status add_mounts_and_samples(const MadeFrame& frame) {
    sampled_ = sampled_ || !frame.sensors.empty();
    for (const RosMount& mount :
         ros_mounts(plan_.cameras.front().T_body_camera, names_.front().frame, sampled_)) {
      const Ros2Header header{plan_.epoch_utc_ns + frame.t_ns, mount.parent_frame};
      Status status =
          write("/tf", header, ros2_transform(header, mount.child_frame, mount.T_parent_child));
      if (!status) return status;
    }
    return with_each_ros2_sample(
        frame.sensors, plan_.epoch_utc_ns, [this](const Ros2SampleMessage& message) {
          if (!channels_.contains(message.topic)) add_channel(message.topic, *message.type);
          return file_.add_message(channels_.at(message.topic),
                                   static_cast<std::uint64_t>(message.available_ns),
                                   message.data);
        });
  }

  Status add_truth(const MadeFrame& frame, const CameraShot& shot, const RosCameraTopics& names) {
    const Ros2Header header{plan_.epoch_utc_ns + frame.t_ns, ros1::kWorldFrame};
    const Pose& T_world_camera = shot.drawn.T_world_camera;
    Status status = write("/tf", header, ros2_transform(header, names.frame, T_world_camera));
    return status ? write(names.truth, header, ros2_pose(header, T_world_camera)) : status;
  }

  DatasetPlan plan_;
  std::vector<RosCameraTopics> names_;
  RosEstimates estimates_{plan_.estimates};
  McapFile file_;
  fs::path unfinished_;  ///< name until it is complete
  std::map<std::string, McapFile::ChannelId> channels_;
  bool sampled_ = false;  ///< the aircraft has sensors
};

}  // namespace

Result<std::unique_ptr<DatasetWriter>> create_mcap_writer(const DatasetPlan& plan) {
  constexpr std::int64_t kLatestNs = std::numeric_limits<std::int32_t>::max() * kNsPerS;
  if (plan.epoch_utc_ns < 0 || plan.epoch_utc_ns > kLatestNs) {
    return Error{ErrorCode::kUnsupported,
                 "epoch_utc_ns = " + std::to_string(plan.epoch_utc_ns) +
                     ": messages of ROS 2 hold only times from 1970 to 2038"};
  }
  const fs::path unfinished = plan.folder / "flight.mcap.active";
  Result<McapFile> file = McapFile::create(unfinished, "ros2");
  if (!file) return file.error();
  return std::unique_ptr<DatasetWriter>(
      std::make_unique<McapWriter>(plan, std::move(*file), unfinished));
}

}  // namespace overfly::server
