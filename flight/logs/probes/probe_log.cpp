#include "flight/logs/probes/probe_log.hpp"

#include <libdeflate.h>

#include <algorithm>
#include <cassert>
#include <chrono>
#include <fstream>
#include <limits>
#include <system_error>

#include "flight/logs/probes/log_bytes.hpp"
#include "flight/logs/probes/ros_bytes.hpp"

namespace overfly::flight::logs {
namespace {

using namespace probes;

constexpr std::size_t kBlockBytes = std::size_t{1} << 20U;

/// Records of 20 ms of a simulated flight, with the rates of a log at 400 Hz.
Bytes probe_dataflash_step(std::uint64_t time_us, std::int32_t lat) {
  Bytes bytes;
  for (std::uint64_t i = 0; i < 16; ++i) {
    Bytes imu = record_header(10);
    put(imu, time_us + 2500 * (i / 2));
    imu.push_back(static_cast<std::uint8_t>(i % 2));
    imu.resize(54, 1);
    append(bytes, imu);
    if (i % 4 != 0) continue;
    Bytes sim2 = record_header(11);
    put(sim2, time_us + 1250 * i);
    for (const double value : {1.0 * lat, 2.0, -300.0}) put(sim2, value);
    sim2.resize(55, 0);
    append(bytes, sim2);
    Bytes xkf1 = record_header(12);
    put(xkf1, time_us + 1250 * i);
    xkf1.push_back(0);
    xkf1.resize(56, 0);
    append(bytes, xkf1);
  }
  Bytes sim = record_header(13);
  put(sim, time_us);
  for (const std::int16_t value : {100, 200, 9000}) put(sim, value);
  put(sim, 500.0F);
  put(sim, lat);
  put(sim, std::int32_t{80000000});
  for (const float value : {1.0F, 0.0F, 0.0F, 0.0F}) put(sim, value);
  append(bytes, sim);
  return bytes;
}

Bytes probe_dataflash_declarations() {
  Bytes bytes = format_record(0x80, 89, "FMT", "BBnNZ", "Type,Length,Name,Format,Columns");
  append(bytes,
         format_record(10,
                       54,
                       "IMU",
                       "QBffffffIIfBBHH",
                       "TimeUS,I,GyrX,GyrY,GyrZ,AccX,AccY,AccZ,EG,EA,T,GH,AH,GHz"));
  append(bytes, format_record(11, 55, "SIM2", "Qdddfffff", "TimeUS,PN,PE,PD,VN,VE,VD,As,ASpdU"));
  append(bytes,
         format_record(12,
                       56,
                       "XKF1",
                       "QBccCfffffffccce",
                       "TimeUS,C,Roll,Pitch,Yaw,VN,VE,VD,dPD,PN,PE,PD,GX,GY,GZ,OH"));
  append(
      bytes,
      format_record(13, 45, "SIM", "QccCfLLffff", "TimeUS,Roll,Pitch,Yaw,Alt,Lat,Lng,Q1,Q2,Q3,Q4"));
  return bytes;
}

/// Messages of 20 ms: attitude and inertial data at 100 Hz, the simulator's state at 50 Hz.
Bytes probe_tlog_step(std::uint64_t time_us, std::int32_t lat) {
  Bytes bytes;
  // Eight frames a step.
  auto sequence = static_cast<std::uint8_t>(time_us / 20'000 * 8);
  const auto boot_ms = static_cast<std::uint32_t>(time_us / 1000);
  const auto add = [&](std::uint32_t id, const Bytes& payload) {
    append(bytes,
           tlog_record(1'700'000'000'000'000 + time_us, frame_bytes(id, payload, sequence++)));
  };
  for (std::uint32_t i = 0; i < 2; ++i) {
    add(30, attitude_payload(boot_ms + 10 * i, 0.1F, 0.2F, 0.3F));
    Bytes local;
    put(local, boot_ms + 10 * i);
    for (int k = 0; k < 6; ++k) put(local, 1.5F);
    add(32, local);
    Bytes imu;
    put(imu, std::uint64_t{1000} * (boot_ms + 10 * i));
    for (int k = 0; k < 9; ++k) put(imu, static_cast<std::int16_t>(100 + k));
    add(27, imu);
  }
  add(33, global_position_payload(boot_ms, lat, 80000000, 500000));
  Bytes sim;
  for (int i = 0; i < 21; ++i) put(sim, i == 0 ? 1.0F : 0.25F);
  const Eigen::Vector3f rotation = Eigen::Vector3f::Zero();
  std::memcpy(sim.data() + 4, rotation.data(), 12);
  const float alt_m = 500.0F;
  std::memcpy(sim.data() + 60, &alt_m, sizeof alt_m);
  put(sim, lat);
  put(sim, std::int32_t{80000000});
  add(108, sim);
  return bytes;
}

Bytes probe_ulog_declarations() {
  Bytes bytes = ulog_header();
  append(bytes,
         ulog_text('F',
                   "vehicle_attitude:uint64_t timestamp;uint64_t sample;"
                   "float[4] q;float[4] delta;uint8_t counter;"));
  append(bytes,
         ulog_text('F',
                   "vehicle_global_position:uint64_t timestamp;double lat;"
                   "double lon;float alt;float[6] more;"));
  append(bytes,
         ulog_text('F',
                   "sensor_combined:uint64_t timestamp;float[3] gyro_rad;"
                   "float[3] accelerometer_m_s2;uint8_t[12] more;"));
  append(bytes, ulog_subscription(0, 1, "vehicle_attitude"));
  append(bytes, ulog_subscription(0, 2, "vehicle_global_position"));
  append(bytes, ulog_subscription(0, 3, "sensor_combined"));
  return bytes;
}

/// Topics of 20 ms: attitude at 100 Hz, inertial data at 200 Hz, position at 50 Hz.
Bytes probe_ulog_step(std::uint64_t time_us, std::int32_t lat) {
  Bytes bytes;
  for (std::uint64_t i = 0; i < 4; ++i) {
    Bytes inertial;
    put(inertial, time_us + 5000 * i);
    inertial.resize(44, 0);
    append(bytes, ulog_data(3, inertial));
    if (i % 2 != 0) continue;
    Bytes attitude;
    put(attitude, time_us + 5000 * i);
    put(attitude, time_us);
    for (const float value : {1.0F, 0.0F, 0.0F, 0.0F}) put(attitude, value);
    attitude.resize(49, 0);
    append(bytes, ulog_data(1, attitude));
  }
  Bytes position;
  put(position, time_us);
  put(position, lat * 1e-7);
  put(position, 8.0);
  put(position, 500.0F);
  position.resize(52, 0);
  append(bytes, ulog_data(2, position));
  return bytes;
}

Bytes probe_mcap_declarations() {
  Bytes bytes = mcap_schema(1, "nav_msgs/msg/Odometry");
  append(bytes, mcap_schema(2, "sensor_msgs/msg/Imu"));
  append(bytes, mcap_channel(1, 1, "/odometry", "cdr"));
  append(bytes, mcap_channel(2, 2, "/imu", "cdr"));
  return bytes;
}

/// Messages of 20 ms: odometry at 50 Hz, inertial data at 200 Hz.
Bytes probe_mcap_step(std::uint64_t time_us, std::int32_t lat) {
  const auto t_ns = static_cast<std::int64_t>(time_us) * 1000;
  const Eigen::Quaterniond level = Eigen::Quaterniond::Identity();
  const Eigen::Vector3d position_m(0.0, 0.01 * lat, 300.0);
  Bytes bytes =
      mcap_message(1, time_us * 1000, odometry(Wire::kCdrLittle, t_ns, position_m, level));
  for (int i = 0; i < 4; ++i) {
    const std::int64_t imu_ns = t_ns + 5'000'000 * i;
    append(
        bytes,
        mcap_message(
            2, static_cast<std::uint64_t>(imu_ns), imu_message(Wire::kCdrLittle, imu_ns, level)));
  }
  return bytes;
}

Bytes probe_mcap_chunk(const Bytes& records) {
  return mcap_chunk(
      records, records.size(), libdeflate_crc32(0, records.data(), records.size()), "");
}

struct ProbeFormat {
  LogFormat format;
  Bytes (*start)();
  Bytes (*declarations)();
  Bytes (*step)(std::uint64_t, std::int32_t);
  /// A block of declarations and steps as it is stored.
  Bytes (*stored)(const Bytes&);
  Bytes (*end)();
};

Bytes nothing() { return {}; }
Bytes as_it_is(const Bytes& block) { return block; }
Bytes probe_mcap_start() { return mcap_start("ros2"); }
Bytes probe_mcap_end() { return mcap_end(); }

constexpr ProbeFormat kFormats[] = {
    {LogFormat::kDataFlash,
     nothing,
     probe_dataflash_declarations,
     probe_dataflash_step,
     as_it_is,
     nothing},
    {LogFormat::kTlog, nothing, nothing, probe_tlog_step, as_it_is, nothing},
    {LogFormat::kUlog, nothing, probe_ulog_declarations, probe_ulog_step, as_it_is, nothing},
    {LogFormat::kMcap,
     probe_mcap_start,
     probe_mcap_declarations,
     probe_mcap_step,
     probe_mcap_chunk,
     probe_mcap_end},
};

}  // namespace

Status write_probe_log(const std::filesystem::path& file,
                       LogFormat format,
                       std::uint64_t size_bytes) {
  const auto* const made = std::find_if(
      std::begin(kFormats), std::end(kFormats), [&](const auto& f) { return f.format == format; });
  assert(made != std::end(kFormats));
  std::ofstream out(file, std::ios::binary | std::ios::trunc);
  std::uint64_t written = 0;
  const auto write = [&](const Bytes& bytes) {
    out.write(reinterpret_cast<const char*>(bytes.data()),
              static_cast<std::streamsize>(bytes.size()));
    written += bytes.size();
  };
  write(made->start());
  Bytes block = made->declarations();
  for (std::uint64_t i = 0; written < size_bytes && out; ++i) {
    const auto lat = 470'000'000 + static_cast<std::int32_t>(i % 100'000);
    append(block, made->step(1'000'000 + 20'000 * i, lat));
    if (block.size() < kBlockBytes) continue;
    write(made->stored(block));
    block.clear();
  }
  write(made->end());
  if (out.flush()) return {};
  return Error{ErrorCode::kIo, file.string() + ": cannot be written; is the disk full?"};
}

Result<double> log_opening_mb_per_s(const std::filesystem::path& folder,
                                    LogFormat format,
                                    std::uint64_t size_bytes,
                                    const std::atomic<bool>* cancel) {
  constexpr int kTimes = 3;
  const std::filesystem::path file = folder / (std::string("probe.") + to_string(format));
  Status status = write_probe_log(file, format, size_bytes);
  double megabytes = 0.0;
  double fastest_s = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kTimes && status; ++i) {
    const auto start = std::chrono::steady_clock::now();
    const Result<OpenedLog> log = open_log(file, cancel);
    const std::chrono::duration<double> elapsed_s = std::chrono::steady_clock::now() - start;
    if (!log) status = log.error();
    if (log) megabytes = static_cast<double>(log->size_bytes) * 1e-6;
    fastest_s = std::min(fastest_s, elapsed_s.count());
  }
  std::error_code ignored;
  std::filesystem::remove(file, ignored);
  if (!status) return status.error();
  return megabytes / fastest_s;
}

}  // namespace overfly::flight::logs
