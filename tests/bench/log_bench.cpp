// Speed and memory of reading flight logs: makes a log of each format and opens and converts it.
// Usage: log_bench [MEGABYTES] [FOLDER]     default: 1000, the system's folder for temporary files
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "core/measure/process_memory.hpp"
#include "core/outside/forward_reader.hpp"
#include "flight/logs/log_trajectory.hpp"
#include "tests/flight/logs/log_bytes.hpp"

namespace overfly::flight {
namespace {

using testing::append;
using testing::Bytes;
using testing::put;

/// Records of 20 ms of a simulated flight, with the rates of a log at 400 Hz.
Bytes dataflash_step(std::uint64_t time_us, std::int32_t lat) {
  Bytes bytes;
  for (std::uint64_t i = 0; i < 16; ++i) {
    Bytes imu = testing::record_header(10);
    put(imu, time_us + 2500 * (i / 2));
    imu.push_back(static_cast<std::uint8_t>(i % 2));
    imu.resize(54, 1);
    append(bytes, imu);
    if (i % 4 != 0) continue;
    Bytes sim2 = testing::record_header(11);
    put(sim2, time_us + 1250 * i);
    for (const double value : {1.0 * lat, 2.0, -300.0}) put(sim2, value);
    sim2.resize(55, 0);
    append(bytes, sim2);
    Bytes xkf1 = testing::record_header(12);
    put(xkf1, time_us + 1250 * i);
    xkf1.push_back(0);
    xkf1.resize(56, 0);
    append(bytes, xkf1);
  }
  Bytes sim = testing::record_header(13);
  put(sim, time_us);
  for (const std::int16_t value : {100, 200, 9000}) put(sim, value);
  put(sim, 500.0F);
  put(sim, lat);
  put(sim, std::int32_t{80000000});
  for (const float value : {1.0F, 0.0F, 0.0F, 0.0F}) put(sim, value);
  append(bytes, sim);
  return bytes;
}

Bytes dataflash_declarations() {
  Bytes bytes = testing::format_record(0x80, 89, "FMT", "BBnNZ", "Type,Length,Name,Format,Columns");
  append(bytes,
         testing::format_record(10,
                                54,
                                "IMU",
                                "QBffffffIIfBBHH",
                                "TimeUS,I,GyrX,GyrY,GyrZ,AccX,AccY,AccZ,EG,EA,T,GH,AH,GHz"));
  append(bytes,
         testing::format_record(11, 55, "SIM2", "Qdddfffff", "TimeUS,PN,PE,PD,VN,VE,VD,As,ASpdU"));
  append(bytes,
         testing::format_record(12,
                                56,
                                "XKF1",
                                "QBccCfffffffccce",
                                "TimeUS,C,Roll,Pitch,Yaw,VN,VE,VD,dPD,PN,PE,PD,GX,GY,GZ,OH"));
  append(bytes,
         testing::format_record(
             13, 45, "SIM", "QccCfLLffff", "TimeUS,Roll,Pitch,Yaw,Alt,Lat,Lng,Q1,Q2,Q3,Q4"));
  return bytes;
}

/// Messages of 20 ms: attitude and inertial data at 100 Hz, the simulator's state at 50 Hz.
Bytes tlog_step(std::uint64_t time_us, std::int32_t lat) {
  Bytes bytes;
  static std::uint8_t sequence = 0;
  const auto boot_ms = static_cast<std::uint32_t>(time_us / 1000);
  const auto add = [&](std::uint32_t id, const Bytes& payload) {
    append(bytes,
           testing::tlog_record(1'700'000'000'000'000 + time_us,
                                testing::frame_bytes(id, payload, sequence++)));
  };
  for (std::uint32_t i = 0; i < 2; ++i) {
    add(30, testing::attitude_payload(boot_ms + 10 * i, 0.1F, 0.2F, 0.3F));
    Bytes local;
    put(local, boot_ms + 10 * i);
    for (int k = 0; k < 6; ++k) put(local, 1.5F);
    add(32, local);
    Bytes imu;
    put(imu, std::uint64_t{1000} * (boot_ms + 10 * i));
    for (int k = 0; k < 9; ++k) put(imu, static_cast<std::int16_t>(100 + k));
    add(27, imu);
  }
  add(33, testing::global_position_payload(boot_ms, lat, 80000000, 500000));
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

Bytes ulog_declarations() {
  Bytes bytes = testing::ulog_header();
  append(bytes,
         testing::ulog_text('F',
                            "vehicle_attitude:uint64_t timestamp;uint64_t sample;"
                            "float[4] q;float[4] delta;uint8_t counter;"));
  append(bytes,
         testing::ulog_text('F',
                            "vehicle_global_position:uint64_t timestamp;double lat;"
                            "double lon;float alt;float[6] more;"));
  append(bytes,
         testing::ulog_text('F',
                            "sensor_combined:uint64_t timestamp;float[3] gyro_rad;"
                            "float[3] accelerometer_m_s2;uint8_t[12] more;"));
  append(bytes, testing::ulog_subscription(0, 1, "vehicle_attitude"));
  append(bytes, testing::ulog_subscription(0, 2, "vehicle_global_position"));
  append(bytes, testing::ulog_subscription(0, 3, "sensor_combined"));
  return bytes;
}

/// Topics of 20 ms: attitude at 100 Hz, inertial data at 200 Hz, position at 50 Hz.
Bytes ulog_step(std::uint64_t time_us, std::int32_t lat) {
  Bytes bytes;
  for (std::uint64_t i = 0; i < 4; ++i) {
    Bytes inertial;
    put(inertial, time_us + 5000 * i);
    inertial.resize(44, 0);
    append(bytes, testing::ulog_data(3, inertial));
    if (i % 2 != 0) continue;
    Bytes attitude;
    put(attitude, time_us + 5000 * i);
    put(attitude, time_us);
    for (const float value : {1.0F, 0.0F, 0.0F, 0.0F}) put(attitude, value);
    attitude.resize(49, 0);
    append(bytes, testing::ulog_data(1, attitude));
  }
  Bytes position;
  put(position, time_us);
  put(position, lat * 1e-7);
  put(position, 8.0);
  put(position, 500.0F);
  position.resize(52, 0);
  append(bytes, testing::ulog_data(2, position));
  return bytes;
}

void write_log(const std::filesystem::path& file,
               std::uint64_t size_bytes,
               const Bytes& start,
               Bytes (*step)(std::uint64_t, std::int32_t)) {
  std::ofstream out(file, std::ios::binary);
  std::uint64_t written = 0;
  Bytes block = start;
  for (std::uint64_t i = 0; written < size_bytes; ++i) {
    append(block, step(1'000'000 + 20'000 * i, 470000000 + static_cast<std::int32_t>(i % 100000)));
    if (block.size() < (std::size_t{1} << 20U)) continue;
    out.write(reinterpret_cast<const char*>(block.data()),
              static_cast<std::streamsize>(block.size()));
    written += block.size();
    block.clear();
  }
}

template <typename Work>
double elapsed_s(const Work& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Reads the file once without parsing, so that it is in the system's cache.
double read_seconds(const std::filesystem::path& file) {
  return elapsed_s([&] {
    auto reader = ForwardReader::open(file);
    while (reader.ok()) {
      const auto bytes = reader->ahead(ForwardReader::kBufferBytes);
      if (!bytes.ok() || bytes->empty()) break;
      reader->skip(bytes->size());
    }
  });
}

int measure_opening(const char* name, const std::filesystem::path& file) {
  const double megabytes = static_cast<double>(std::filesystem::file_size(file)) * 1e-6;
  (void)read_seconds(file);
  const double reading_s = read_seconds(file);
  Result<logs::OpenedLog> log = Error{};
  const double opening_s = elapsed_s([&] { log = logs::open_log(file); });
  if (!log.ok()) return 1;
  std::printf("%-9s %5.0f MB: only reading %5.0f MB/s, opening %5.0f MB/s, %4.0f MB of memory\n",
              name,
              megabytes,
              megabytes / reading_s,
              megabytes / opening_s,
              peak_memory_mb());
  return 0;
}

int measure_converting(const char* name, const std::filesystem::path& file) {
  const double megabytes = static_cast<double>(std::filesystem::file_size(file)) * 1e-6;
  const auto log = logs::open_log(file);
  if (!log.ok()) return 1;
  std::size_t poses = 0;
  const double converting_s = elapsed_s([&] {
    const auto trajectory = logs::read_log_trajectory(*log, {});
    if (trajectory.ok()) poses = trajectory->poses.size();
  });
  std::printf("%-9s converting %5.0f MB/s to %zu poses, %4.0f MB of memory\n",
              name,
              megabytes / converting_s,
              poses,
              peak_memory_mb());
  return poses > 0 ? 0 : 1;
}

/// Runs a measurement in a process of its own, because peak memory never falls.
int apart(int (*measure)(const char*, const std::filesystem::path&),
          const char* name,
          const std::filesystem::path& file) {
  const pid_t child = ::fork();
  if (child == 0) {
    const int failed = measure(name, file);
    std::fflush(stdout);
    ::_exit(failed);
  }
  int status = 1;
  ::waitpid(child, &status, 0);
  return status == 0 ? 0 : 1;
}

}  // namespace
}  // namespace overfly::flight

int main(int count, char** arguments) {
  using namespace overfly::flight;
  const double megabytes = count > 1 ? std::strtod(arguments[1], nullptr) : 1000.0;
  const std::filesystem::path folder =
      count > 2 ? std::filesystem::path(arguments[2]) : std::filesystem::temp_directory_path();
  const auto size_bytes = static_cast<std::uint64_t>(megabytes * 1e6);
  struct Format {
    const char* name;
    Bytes start;
    Bytes (*step)(std::uint64_t, std::int32_t);
  };
  const Format formats[] = {{"dataflash", dataflash_declarations(), dataflash_step},
                            {"tlog", {}, tlog_step},
                            {"ulog", ulog_declarations(), ulog_step}};
  int failures = 0;
  for (const Format& format : formats) {
    const std::filesystem::path file = folder / (std::string("log_bench.") + format.name);
    write_log(file, size_bytes, format.start, format.step);
    failures += apart(measure_opening, format.name, file);
    failures += apart(measure_converting, format.name, file);
    std::filesystem::remove(file);
  }
  return failures == 0 ? 0 : 1;
}
