// The ASL layout of the EuRoC data set (Burri et al. 2016, IJRR 35(10)): mav0/ with cam0, cam1,
// ..., imu0, state_groundtruth_estimate0. Body = the aircraft's (forward-right-down); the IMU is at
// its origin. Reference = the world frame (east-north-up).
#include <array>
#include <span>

#include "server/export/dataset_writer.hpp"
#include "server/files/number_text.hpp"
#include "server/files/png_file.hpp"
#include "server/files/whole_file.hpp"

namespace overfly::server {
namespace {

namespace fs = std::filesystem;

/// data.csv of cameras and IMUs ends its lines as in the published data set: readers rely on both
/// characters.
constexpr const char* kLineEnd = "\r\n";

std::string transform_text(const Pose& T_body_sensor) {
  const Eigen::Matrix<double, 4, 4, Eigen::RowMajor> T = T_body_sensor.matrix();
  return "T_BS:\n  cols: 4\n  rows: 4\n  data: " + yaml_list(std::span(T.data(), 16)) + "\n";
}

std::string distortion_text(const Distortion& lens) {
  const std::string key = "\ndistortion_coefficients: ";
  const std::span k(lens.k);
  switch (lens.model) {
    case DistortionModel::kEquidistant:
      return "distortion_model: equidistant" + key + yaml_list(k.first(4)) + "\n";
    case DistortionModel::kFov:
      return "distortion_model: fov" + key + yaml_list(k.first(1)) + "\n";
    case DistortionModel::kNone:
    case DistortionModel::kRadtan:
      break;
  }
  // k1 k2 p1 p2; k3 only if it is not 0, since readers of the format expect four coefficients.
  const std::size_t count = k[4] == 0.0 ? 4 : 5;
  return "distortion_model: radial-tangential" + key + yaml_list(k.first(count)) + "\n";
}

std::string sensor_text(const CameraSpec& camera, const FrameRate& rate) {
  const PinholeCamera& c = camera.model.pinhole();
  return "# Camera " + camera.name +
         " of an Overfly flight.\nsensor_type: camera\ncomment: " + camera.name + "\n\n" +
         transform_text(camera.T_body_camera) + "\nrate_hz: " + number_text(rate.hz()) +
         "\nresolution: [" + std::to_string(c.width_px) + ", " + std::to_string(c.height_px) +
         "]\ncamera_model: pinhole\n" +
         "# fu, fv, cu, cv; pixel centres at integers\nintrinsics: " +
         yaml_list(std::array{c.fx_px, c.fy_px, c.cx_px, c.cy_px}) + "\n" +
         distortion_text(camera.model.distortion());
}

/// @param of_vehicle  recorded from a vehicle, instead of made
std::string imu_text(const flight::ImuModel& imu, bool of_vehicle, double gravity_m_s2) {
  const char* const about =
      of_vehicle
          ? "# The vehicle's own IMU, as recorded; rate_hz is measured, the noise below is not.\n"
            "sensor_type: imu\ncomment: recorded\n\n"
          : "# Synthetic IMU in the aircraft's body origin.\nsensor_type: imu\ncomment: "
            "synthetic\n\n";
  return about + transform_text({}) + "\nrate_hz: " + number_text(imu.rate_hz) +
         "\n\ngyroscope_noise_density: " + yaml_number(imu.gyroscope_noise_rad_s_sqrt_hz) +
         "     # [ rad / s / sqrt(Hz) ]\ngyroscope_random_walk: " +
         yaml_number(imu.gyroscope_walk_rad_s2_sqrt_hz) +
         "     # [ rad / s^2 / sqrt(Hz) ]\naccelerometer_noise_density: " +
         yaml_number(imu.accelerometer_noise_m_s2_sqrt_hz) +
         "     # [ m / s^2 / sqrt(Hz) ]\naccelerometer_random_walk: " +
         yaml_number(imu.accelerometer_walk_m_s3_sqrt_hz) +
         "     # [ m / s^3 / sqrt(Hz) ]\n\n# Time stamps are in the middle of the samples' "
         "intervals.\n"
         "gravity_magnitude: " +
         yaml_number(gravity_m_s2) + "     # [ m / s^2 ]\n";
}

constexpr const char* kImuHeader =
    "#timestamp [ns],w_RS_S_x [rad s^-1],w_RS_S_y [rad s^-1],w_RS_S_z [rad s^-1],"
    "a_RS_S_x [m s^-2],a_RS_S_y [m s^-2],a_RS_S_z [m s^-2]";
constexpr const char* kStateHeader =
    "#timestamp [ns],p_RS_R_x [m],p_RS_R_y [m],p_RS_R_z [m],q_RS_w [],q_RS_x [],q_RS_y [],"
    "q_RS_z [],v_RS_R_x [m s^-1],v_RS_R_y [m s^-1],v_RS_R_z [m s^-1],b_w_RS_S_x [rad s^-1],"
    "b_w_RS_S_y [rad s^-1],b_w_RS_S_z [rad s^-1],b_a_RS_S_x [m s^-2],b_a_RS_S_y [m s^-2],"
    "b_a_RS_S_z [m s^-2]\n";

std::string list_of(const Eigen::Vector3d& v) { return number_list({v.x(), v.y(), v.z()}, ","); }

class EurocWriter final : public DatasetWriter {
 public:
  explicit EurocWriter(const DatasetPlan& plan)
      : root_(plan.folder / "mav0"), epoch_ns_(plan.epoch_utc_ns), lists_(plan.cameras.size()) {}

  Status begin(const DatasetPlan& plan) {
    for (std::size_t i = 0; i < plan.cameras.size(); ++i) {
      if (Status status = make_folder(camera_folder(i) / "data"); !status) return status;
      Status status =
          write_whole(camera_folder(i) / "sensor.yaml", sensor_text(plan.cameras[i], plan.rate));
      if (!status) return status;
    }
    if (Status status = write_imu(plan); !status) return status;
    if (Status status = write_states(plan); !status) return status;
    return write_whole(root_ / "body.yaml",
                       std::string("comment: Overfly, aircraft body forward-right-down\n"));
  }

  Result<std::vector<std::string>> add(const MadeFrame& frame) override {
    std::vector<std::string> names(frame.shots.size());
    for (std::size_t i = 0; i < frame.shots.size(); ++i) {
      const CameraShot& shot = frame.shots[i];
      if (!shot.delivered) continue;
      names[i] = std::to_string(epoch_ns_ + shot.stamp_ns);
      lists_[i] += names[i] + "," + names[i] + ".png" + kLineEnd;
      const Status status =
          write_png_file(camera_folder(i) / "data" / (names[i] + ".png"), shot.image);
      if (!status) return status.error();
    }
    return names;
  }

  Status finish() override {
    for (std::size_t i = 0; i < lists_.size(); ++i) {
      Status status = write_whole(camera_folder(i) / "data.csv",
                                  std::string("#timestamp [ns],filename") + kLineEnd + lists_[i]);
      if (!status) return status;
    }
    return {};
  }

 private:
  [[nodiscard]] fs::path camera_folder(std::size_t i) const {
    return root_ / ("cam" + std::to_string(i));
  }

  Status write_imu(const DatasetPlan& plan) const {
    if (Status status = make_folder(root_ / "imu0"); !status) return status;
    std::string rows = kImuHeader + std::string(kLineEnd);
    for (const flight::ImuReading& reading : plan.imu) {
      const ImuSample& sample = reading.sample;
      rows += std::to_string(epoch_ns_ + sample.t_ns) + "," + list_of(sample.angular_rate_rad_s) +
              "," + list_of(sample.acceleration_m_s2) + kLineEnd;
    }
    if (Status status = write_whole(root_ / "imu0" / "data.csv", rows); !status) return status;
    return write_whole(root_ / "imu0" / "sensor.yaml",
                       imu_text(plan.imu_model, plan.imu_of_vehicle, plan.gravity_m_s2));
  }

  Status write_states(const DatasetPlan& plan) const {
    const fs::path folder = root_ / "state_groundtruth_estimate0";
    if (Status status = make_folder(folder); !status) return status;
    std::string rows = kStateHeader;
    for (std::size_t i = 0; i < plan.states.size(); ++i) {
      const AircraftState& state = plan.states[i];
      const Eigen::Quaterniond& q = state.T_world_body.rotation;
      rows += std::to_string(epoch_ns_ + state.t_ns) + "," +
              list_of(state.T_world_body.translation) + "," +
              number_list({q.w(), q.x(), q.y(), q.z()}, ",") + "," +
              list_of(state.v_body_world_m_s) + "," + list_of(plan.imu[i].gyroscope_bias_rad_s) +
              "," + list_of(plan.imu[i].accelerometer_bias_m_s2) + "\n";
    }
    if (Status status = write_whole(folder / "data.csv", rows); !status) return status;
    return write_whole(
        folder / "sensor.yaml",
        "sensor_type: visual-inertial\ncomment: the flight itself\n\n" + transform_text({}));
  }

  fs::path root_;
  std::int64_t epoch_ns_;
  std::vector<std::string> lists_;  ///< rows of data.csv, one text for each camera
};

}  // namespace

Result<std::unique_ptr<DatasetWriter>> create_euroc_writer(const DatasetPlan& plan) {
  auto writer = std::make_unique<EurocWriter>(plan);
  if (Status status = writer->begin(plan); !status) return status.error();
  return std::unique_ptr<DatasetWriter>(std::move(writer));
}

}  // namespace overfly::server
