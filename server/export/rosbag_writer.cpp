// A ROS 1 bag: for each camera the images as given to estimators, the calibration with each image,
// and the truth of every frame; of a run also its estimates.
#include <system_error>

#include "middleware/ros1/bag_writer.hpp"
#include "server/export/dataset_writer.hpp"
#include "server/export/ros_topics.hpp"

namespace overfly::server {
namespace {

namespace fs = std::filesystem;

class RosbagWriter final : public DatasetWriter {
 public:
  RosbagWriter(const DatasetPlan& plan, std::unique_ptr<ros1::BagWriter> bag, fs::path unfinished)
      : plan_(plan),
        names_(ros_camera_topics(plan.cameras)),
        bag_(std::move(bag)),
        unfinished_(std::move(unfinished)) {}

  Result<std::vector<std::string>> add(const MadeFrame& frame) override {
    Status sampled = add_mounts_and_samples(frame);
    if (!sampled) return sampled.error();
    std::vector<std::string> names(frame.shots.size());
    for (std::size_t i = 0; i < frame.shots.size(); ++i) {
      const CameraShot& shot = frame.shots[i];
      if (shot.delivered) names[i] = std::to_string(plan_.epoch_utc_ns + shot.stamp_ns);
      Status status = add_truth(frame, shot, names_[i]);
      if (status && shot.delivered) status = add_image(shot, plan_.cameras[i], names_[i]);
      if (!status) return status.error();
    }
    if (Status status = add_estimates(frame.frame); !status) return status.error();
    return names;
  }

  Status finish() override {
    if (Status status = bag_->close(); !status) return status;
    std::error_code failure;
    fs::rename(unfinished_, plan_.folder / "flight.bag", failure);
    if (!failure) return {};
    return Error{ErrorCode::kIo,
                 unfinished_.string() + ": cannot be renamed: " + failure.message()};
  }

 private:
  Status add_image(const CameraShot& shot, const CameraSpec& camera, const RosCameraTopics& names) {
    const std::int64_t stamp_ns = plan_.epoch_utc_ns + shot.stamp_ns;
    Status status = bag_->add_camera_info(names.info, names.frame, stamp_ns, camera.model);
    return status ? bag_->add_image(names.image, names.frame, stamp_ns, grey_of(shot.image))
                  : status;
  }

  Status add_mounts_and_samples(const MadeFrame& frame) {
    sampled_ = sampled_ || !frame.sensors.empty();
    for (const RosMount& mount :
         ros_mounts(plan_.cameras.front().T_body_camera, names_.front().frame, sampled_)) {
      Status status = bag_->add_transform(mount.parent_frame,
                                          mount.child_frame,
                                          plan_.epoch_utc_ns + frame.t_ns,
                                          mount.T_parent_child);
      if (!status) return status;
    }
    return bag_->add_samples(frame.sensors, plan_.epoch_utc_ns);
  }

  Status add_estimates(std::int64_t frame) {
    for (const RosEstimate& estimate : estimates_.of(frame)) {
      Status status = bag_->add_pose(
          estimate.topic, estimate.frame_id, plan_.epoch_utc_ns + estimate.t_ns, estimate.pose);
      if (!status) return status;
    }
    return {};
  }

  Status add_truth(const MadeFrame& frame, const CameraShot& shot, const RosCameraTopics& names) {
    const std::int64_t stamp_ns = plan_.epoch_utc_ns + frame.t_ns;
    const Pose& T_world_camera = shot.drawn.T_world_camera;
    Status status = bag_->add_transform(ros1::kWorldFrame, names.frame, stamp_ns, T_world_camera);
    return status ? bag_->add_pose(names.truth, ros1::kWorldFrame, stamp_ns, T_world_camera)
                  : status;
  }

  DatasetPlan plan_;
  std::vector<RosCameraTopics> names_;
  RosEstimates estimates_{plan_.estimates};
  std::unique_ptr<ros1::BagWriter> bag_;
  fs::path unfinished_;   ///< name until it is complete, as used by rosbag
  bool sampled_ = false;  ///< the aircraft has sensors
};

}  // namespace

Result<std::unique_ptr<DatasetWriter>> create_rosbag_writer(const DatasetPlan& plan) {
  if (plan.epoch_utc_ns <= 0) {
    return Error{ErrorCode::kUnsupported,
                 "epoch_utc_ns = " + std::to_string(plan.epoch_utc_ns) +
                     ": a bag can hold only times after 1970"};
  }
  const fs::path unfinished = plan.folder / "flight.bag.active";
  auto bag = ros1::BagWriter::create(unfinished);
  if (!bag) return bag.error();
  return std::unique_ptr<DatasetWriter>(
      std::make_unique<RosbagWriter>(plan, std::move(*bag), unfinished));
}

}  // namespace overfly::server
