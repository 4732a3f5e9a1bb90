#include "server/ros2/ros2_samples.hpp"

#include <array>
#include <cmath>
#include <limits>

#include "middleware/ros1/frame_names.hpp"
#include "server/ros2/cdr_writer.hpp"
#include "server/ros2/ros2_flight.hpp"

namespace overfly::server {
namespace {

const Ros2Type kImu = {
    "sensor_msgs/msg/Imu",
    "std_msgs/Header header\ngeometry_msgs/Quaternion orientation\n"
    "float64[9] orientation_covariance\ngeometry_msgs/Vector3 angular_velocity\n"
    "float64[9] angular_velocity_covariance\ngeometry_msgs/Vector3 linear_acceleration\n"
    "float64[9] linear_acceleration_covariance\n" +
        ros2_definition::kHeader + ros2_definition::kQuaternion + ros2_definition::kVector3};
const Ros2Type kFluidPressure = {
    "sensor_msgs/msg/FluidPressure",
    "std_msgs/Header header\nfloat64 fluid_pressure\nfloat64 variance\n" +
        ros2_definition::kHeader};
const Ros2Type kTemperature = {
    "sensor_msgs/msg/Temperature",
    "std_msgs/Header header\nfloat64 temperature\nfloat64 variance\n" + ros2_definition::kHeader};
const Ros2Type kTwistStamped = {"geometry_msgs/msg/TwistStamped",
                                "std_msgs/Header header\ngeometry_msgs/Twist twist\n" +
                                    ros2_definition::kHeader + ros2_definition::kSeparator +
                                    "MSG: geometry_msgs/Twist\ngeometry_msgs/Vector3 linear\n"
                                    "geometry_msgs/Vector3 angular\n" +
                                    ros2_definition::kVector3};
const Ros2Type kMagneticField = {"sensor_msgs/msg/MagneticField",
                                 "std_msgs/Header header\ngeometry_msgs/Vector3 magnetic_field\n"
                                 "float64[9] magnetic_field_covariance\n" +
                                     ros2_definition::kHeader + ros2_definition::kVector3};
const Ros2Type kRange = {
    "sensor_msgs/msg/Range",
    "std_msgs/Header header\nuint8 radiation_type\nfloat32 field_of_view\nfloat32 min_range\n"
    "float32 max_range\nfloat32 range\nfloat32 variance\n" +
        ros2_definition::kHeader};

constexpr std::array<double, 9> kUnknown{};

/// Forward-right-down to forward-left-up.
std::array<double, 3> flu(const Eigen::Vector3d& frd) { return {frd.x(), -frd.y(), -frd.z()}; }

void put_sample(CdrWriter& message, const ImuSample& sample) {
  message.numbers(std::array{0.0, 0.0, 0.0, 1.0});
  std::array<double, 9> no_orientation{};
  no_orientation[0] = -1.0;
  message.numbers(no_orientation);
  message.numbers(flu(sample.angular_rate_rad_s));
  message.numbers(kUnknown);
  message.numbers(flu(sample.acceleration_m_s2));
  message.numbers(kUnknown);
}

void write_pressure(CdrWriter& message, const BarometerSample& sample) {
  message.numbers(std::array{sample.pressure_pa, 0.0});
}

void write_temperature(CdrWriter& message, const BarometerSample& sample) {
  constexpr double kZeroCelsiusK = 273.15;
  message.numbers(std::array{sample.temperature_k - kZeroCelsiusK, 0.0});
}

void write_fix(CdrWriter& message, const GpsSample& sample) {
  constexpr std::int8_t kNoFix = -1;
  constexpr std::int8_t kFix = 0;
  constexpr std::uint16_t kServiceGps = 1;
  constexpr std::uint8_t kDiagonalKnown = 2;
  const bool fix = sample.fix != GpsFixType::kNone;
  message.number(fix ? kFix : kNoFix);
  message.number(kServiceGps);
  message.numbers(std::array{deg_from_rad(sample.place.lat_rad),
                             deg_from_rad(sample.place.lon_rad),
                             sample.place.alt_ellipsoid_m});
  std::array<double, 9> covariance{};
  const bool known =
      fix && !std::isnan(sample.horizontal_accuracy_m) && !std::isnan(sample.vertical_accuracy_m);
  if (known) {
    covariance[0] = covariance[4] = sample.horizontal_accuracy_m * sample.horizontal_accuracy_m;
    covariance[8] = sample.vertical_accuracy_m * sample.vertical_accuracy_m;
  }
  message.numbers(covariance);
  message.number(known ? kDiagonalKnown : std::uint8_t{0});
}

void write_velocity(CdrWriter& message, const GpsSample& sample) {
  const Eigen::Vector3d& ned = sample.velocity_ned_m_s;
  message.numbers(std::array{ned.y(), ned.x(), -ned.z(), 0.0, 0.0, 0.0});
}

void put_sample(CdrWriter& message, const AirspeedSample& sample) {
  message.numbers(std::array{sample.differential_pressure_pa, 0.0});
}

void put_sample(CdrWriter& message, const MagnetometerSample& sample) {
  constexpr double kTeslaPerUt = 1e-6;
  message.numbers(flu(kTeslaPerUt * sample.field_ut));
  message.numbers(kUnknown);
}

/// The limits of the sensor are not known: 0 and infinity. No echo is infinity (REP 117).
void put_sample(CdrWriter& message, const RangeSample& sample) {
  constexpr std::uint8_t kInfrared = 1;
  message.number(kInfrared);
  message.number(0.0F);
  message.number(0.0F);
  message.number(std::numeric_limits<float>::infinity());
  message.number(static_cast<float>(sample.range_m));
  message.number(0.0F);  // variance, since ROS 2 Iron: not known
}

}  // namespace

Status with_each_ros2_sample(const SensorSamples& samples,
                             std::int64_t epoch_utc_ns,
                             const std::function<Status(const Ros2SampleMessage&)>& take) {
  Status status;
  const auto with_all = [&](const char* topic,
                            const char* frame,
                            const Ros2Type& type,
                            const auto& list,
                            const auto& write_sample) {
    for (auto sample = list.begin(); status && sample != list.end(); ++sample) {
      CdrWriter message(Ros2Header{epoch_utc_ns + sample->t_ns, frame});
      write_sample(message, *sample);
      status = take({topic, &type, epoch_utc_ns + available_ns(*sample), message.take()});
    }
  };
  const auto as_message = [](CdrWriter& message, const auto& sample) {
    put_sample(message, sample);
  };
  using ros1::kBodyFrame;
  with_all("/sensors/imu", kBodyFrame, kImu, samples.imu, as_message);
  with_all("/sensors/pressure", kBodyFrame, kFluidPressure, samples.barometer, write_pressure);
  with_all("/sensors/temperature", kBodyFrame, kTemperature, samples.barometer, write_temperature);
  with_all("/sensors/gps/fix", kBodyFrame, kRos2NavSatFix, samples.gps, write_fix);
  with_all("/sensors/gps/velocity", ros1::kWorldFrame, kTwistStamped, samples.gps, write_velocity);
  with_all("/sensors/airspeed/differential_pressure",
           kBodyFrame,
           kFluidPressure,
           samples.airspeed,
           as_message);
  with_all("/sensors/magnetic_field", kBodyFrame, kMagneticField, samples.magnetometer, as_message);
  with_all("/sensors/range", ros1::kRangeFrame, kRange, samples.range, as_message);
  return status;
}

}  // namespace overfly::server
