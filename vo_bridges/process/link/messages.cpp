#include "vo_bridges/process/link/messages.hpp"

#include "core/motion/pose.hpp"
#include "vo_bridges/estimator_text.hpp"

namespace overfly::process {

namespace {

constexpr std::size_t kFrameFieldBytes = 48;  ///< in front of the samples
constexpr std::size_t kImuBytes = 56;

std::string flag(bool value) { return value ? "true" : "false"; }

}  // namespace

std::string server_hello(bool lockstep, const VoParameters& wanted) {
  std::string text = "protocol " + std::to_string(kProtocolVersion) + "\nserver overfly\nlockstep ";
  text += flag(lockstep) + "\n";
  for (const auto& [name, value] : wanted) {
    text += "parameter " + name + " " + text_of(value) + "\n";
  }
  return message_of(MessageType::kHello, text);
}

std::string calibration_message(const VoFrame& frame, double rate_hz, const FrameSlots& slots) {
  const PinholeCamera& pinhole = frame.intrinsics;
  std::string text;
  const auto line = [&](const std::string& key, const ParameterValue& value) {
    text += key + " " + text_of(value) + "\n";
  };
  line("camera", printable(frame.camera_id));
  line("width_px", static_cast<double>(pinhole.width_px));
  line("height_px", static_cast<double>(pinhole.height_px));
  line("fx_px", pinhole.fx_px);
  line("fy_px", pinhole.fy_px);
  line("cx_px", pinhole.cx_px);
  line("cy_px", pinhole.cy_px);
  line("distortion", std::string(to_string(frame.distortion.model)));
  if (!frame.distortion.none()) {
    std::string coefficients;
    for (int i = 0; i < coefficient_count(frame.distortion.model); ++i) {
      if (i > 0) coefficients += " ";
      coefficients += text_of(frame.distortion.k.at(static_cast<std::size_t>(i)));
    }
    line("distortion_coefficients", coefficients);
  }
  line("rate_hz", rate_hz);
  if (slots.count > 0) {
    line("frame_slots", static_cast<double>(slots.count));
    text += "frame_slot_bytes " + std::to_string(slots.bytes_each) + "\n";
  }
  return message_of(MessageType::kCalibration, text);
}

std::size_t most_imu_samples(const VoFrame& frame, bool in_shared_memory) {
  const std::size_t others = kFrameFieldBytes + (in_shared_memory ? 0 : frame.image->data.size());
  return others < kFrameLimitBytes ? (kFrameLimitBytes - others) / kImuBytes : 0;
}

std::string frame_message(const VoFrame& frame, const FrameSending& sending) {
  const std::size_t bytes = kFrameFieldBytes + kImuBytes * frame.sensors.imu.size() +
                            (sending.in_shared_memory ? 0 : frame.image->data.size());
  ByteWriter writer;
  writer.text(header_of(MessageType::kFrame, bytes));
  writer.i64(frame.index).i64(frame.t_ns).i64(frame.exposure_ns);
  writer.u32(static_cast<std::uint32_t>(frame.image->width_px));
  writer.u32(static_cast<std::uint32_t>(frame.image->height_px));
  writer.u32(sending.crc32);
  writer.u32((sending.debug_wanted ? 1U : 0U) | (sending.in_shared_memory ? 2U : 0U));
  writer.u32(sending.slot).u32(static_cast<std::uint32_t>(frame.sensors.imu.size()));
  for (const ImuSample& sample : frame.sensors.imu) {
    writer.i64(sample.t_ns);
    for (const double value : sample.acceleration_m_s2) writer.f64(value);
    for (const double value : sample.angular_rate_rad_s) writer.f64(value);
  }
  return std::move(writer.bytes());
}

std::string sensors_message(const VoFrame& frame) {
  const SensorSamples& samples = frame.sensors;
  ByteWriter writer;
  writer.i64(frame.index);
  std::size_t count = 0;
  for (const std::size_t size : {samples.barometer.size(),
                                 samples.gps.size(),
                                 samples.airspeed.size(),
                                 samples.magnetometer.size(),
                                 samples.range.size()}) {
    writer.u32(static_cast<std::uint32_t>(size));
    count += size;
  }
  if (count == 0) return {};
  writer.u32(0);
  for (const BarometerSample& s : samples.barometer) {
    writer.i64(s.t_ns).f64(s.pressure_pa).f64(s.temperature_k);
  }
  for (const GpsSample& s : samples.gps) {
    writer.i64(s.t_ns).i64(s.delivered_ns).u32(s.fix == GpsFixType::k3d ? 3 : 0).u32(0);
    writer.f64(deg_from_rad(s.place.lat_rad)).f64(deg_from_rad(s.place.lon_rad));
    writer.f64(s.place.alt_ellipsoid_m);
    for (const double value : s.velocity_ned_m_s) writer.f64(value);
    writer.f64(s.horizontal_accuracy_m).f64(s.vertical_accuracy_m).f64(s.speed_accuracy_m_s);
  }
  for (const AirspeedSample& s : samples.airspeed) {
    writer.i64(s.t_ns).f64(s.differential_pressure_pa).f64(s.indicated_airspeed_m_s);
  }
  for (const MagnetometerSample& s : samples.magnetometer) {
    writer.i64(s.t_ns);
    for (const double value : s.field_ut) writer.f64(value);
  }
  for (const RangeSample& s : samples.range) writer.i64(s.t_ns).f64(s.range_m);
  return message_of(MessageType::kSensors, writer.bytes());
}

}  // namespace overfly::process
