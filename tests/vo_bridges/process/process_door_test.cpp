// What goes through the process door arrives whole, whichever way it goes.
#include <gmock/gmock.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <thread>

#include "core/measure/crc32.hpp"
#include "tests/support/support.hpp"
#include "tests/vo_bridges/process/process_fixture.hpp"

namespace overfly {
namespace {

using ::testing::Contains;
using testing::ground_frames;
using ::testing::HasSubstr;
using ::testing::IsSupersetOf;
using ::testing::Pair;
using testing::scripted;
using testing::started;

/// Flies over the ground and checks that each image arrived as it was sent.
void expect_whole_images(VoPort& estimator, const std::string& transport) {
  for (const VoFrame& frame : ground_frames(5, 3.0, 2.0, 640, 480)) {
    const VoEstimate estimate = estimator.track(frame).value();
    ASSERT_TRUE(estimate.image_crc32.has_value()) << transport;
    EXPECT_EQ(*estimate.image_crc32, crc32_of(*frame.image)) << transport;
    EXPECT_EQ(estimate.counters.at("first_pixel"), frame.image->data[0]) << transport;
  }
  EXPECT_THAT(estimator.take_log(), Contains("frames go through " + transport));
}

TEST(ProcessDoor, ImagesArriveWholeByEachTransport) {
  expect_whole_images(*started(scripted("good")), "shared memory");
  expect_whole_images(*started(scripted("by_socket")), "the socket");
  ProcessEstimatorOptions tcp = scripted("good");
  tcp.listen = "tcp:127.0.0.1:0";
  expect_whole_images(*started(tcp), "the socket");
}

TEST(ProcessDoor, TellsWhatTheEstimatorAnswers) {
  const auto estimator = started(scripted("good"));
  estimator->set_debug(true);
  std::vector<VoFrame> frames = ground_frames(2, 1.0, 1.0);
  frames[1].exposure_ns = 2'000'000;
  frames[1].sensors.imu = {{frames[0].t_ns, {0.0, 0.0, -9.81}, {0.0, 0.0, 0.5}},
                           {frames[1].t_ns, {0.0, 0.0, -9.81}, {0.0, 0.0, 0.25}}};
  EXPECT_EQ(estimator->track(frames[0])->sample.state, TrackingState::kInitialising);
  const VoEstimate estimate = estimator->track(frames[1]).value();
  EXPECT_EQ(estimate.sample.state, TrackingState::kTracking);
  EXPECT_EQ(estimate.sample.T_vo_camera.translation, Eigen::Vector3d(1.0, -2.0, 0.5));
  EXPECT_EQ(estimate.sample.T_vo_camera.rotation.coeffs(), Eigen::Vector4d(0.0, 0.0, 0.6, 0.8));
  EXPECT_EQ(estimate.sample.scene_depth, 2.5);
  EXPECT_EQ(estimate.counters.at("exposure_ns"), 2e6);
  EXPECT_EQ(estimate.counters.at("turn_z"), 0.25);
  EXPECT_EQ(estimate.timing_ms.at("match"), 1.5);
  ASSERT_TRUE(estimate.debug_image.has_value());
  EXPECT_EQ(estimate.debug_image->data[3], frames[1].image->data[1]);
  EXPECT_EQ(estimate.map_points_vo,
            (std::vector<Eigen::Vector3f>{{1.0F, 2.0F, 3.0F}, {-1.0F, 0.0F, 8.5F}}));
}

TEST(ProcessDoor, SamplesOfSensorsComeWithTheirFrame) {
  const testing::TemporaryFolder folder;
  const auto python = testing::python_estimator(
      "    def track(self, frame):\n"
      "        counters = {}\n"
      "        if frame.range:\n"
      "            counters['last_range_m'] = frame.range[-1].range_m\n"
      "        if frame.gps:\n"
      "            counters['fix'] = int(frame.gps[0].has_fix)\n"
      "            counters['lat_deg'] = frame.gps[0].lat_deg\n"
      "            counters['v_down_m_s'] = frame.gps[0].v_down_m_s\n"
      "        if frame.magnetometer:\n"
      "            counters['z_ut'] = frame.magnetometer[0].z_ut\n"
      "        return overfly_vo.Answer(counters=counters)\n",
      folder.path());
  for (const bool in_python : {false, true}) {
    const auto estimator = started(in_python ? python : scripted("good"));
    std::vector<VoFrame> frames = ground_frames(3, 1.0, 1.0);
    frames[1].sensors.range = {{frames[0].t_ns + 1, 55.5}, {frames[1].t_ns, 56.25}};
    GpsSample fix;
    fix.place = geodetic_from_deg(40.0, -86.0, 200.0);
    fix.velocity_ned_m_s = {20.0, 1.0, -0.5};
    frames[1].sensors.gps = {fix};
    frames[1].sensors.magnetometer = {{frames[1].t_ns, {1.0, 2.0, 47.5}}};
    EXPECT_EQ(estimator->track(frames[0])->counters.count("last_range_m"), 0U);
    const VoEstimate estimate = estimator->track(frames[1]).value();
    EXPECT_EQ(estimate.counters.at("last_range_m"), 56.25) << in_python;
    EXPECT_EQ(estimator->track(frames[2])->counters.count("last_range_m"), 0U) << in_python;
    if (!in_python) continue;
    EXPECT_EQ(estimate.counters.at("fix"), 1.0);
    EXPECT_NEAR(estimate.counters.at("lat_deg"), 40.0, 1e-12);
    EXPECT_EQ(estimate.counters.at("v_down_m_s"), -0.5);
    EXPECT_EQ(estimate.counters.at("z_ut"), 47.5);
  }
}

TEST(ProcessDoor, TellsTheCameraAndItsLens) {
  ProcessEstimatorOptions options = scripted("good");
  options.rate_hz = 31.0;
  const auto estimator = started(options);
  VoFrame frame = ground_frames(1, 1.0, 1.0)[0];
  frame.camera_id = "nadir left";
  frame.intrinsics = {160, 120, 100.5, 101.25, 79.5, 59.5};
  frame.distortion = {DistortionModel::kRadtan, {-0.25, 0.125, 0.0, 0.0, 0.0}};
  ASSERT_TRUE(estimator->track(frame).ok());
  EXPECT_THAT(estimator->take_log(),
              IsSupersetOf({"nadir left 160x120 radtan -0.250000 0.125000 0.000000 0.000000 "
                            "0.000000 at 31.000000",
                            "100.500000 101.250000 79.500000 59.500000"}));
}

TEST(ProcessDoor, TellsTheParametersWantedAndHearsThoseInForce) {
  ProcessEstimatorOptions options = scripted("good");
  options.parameters = {{"features", 1250.5}, {"loop_closing", true}, {"path", std::string("a b")}};
  const auto estimator = started(options);
  EXPECT_EQ(estimator->type(), "process");
  const std::map<std::string, std::string> expected = {{"estimator.name", "scripted"},
                                                       {"estimator.version", "1.2 (test)"},
                                                       {"features", "1250.5"},
                                                       {"loop_closing", "true"},
                                                       {"path", "a b"}};
  EXPECT_EQ(estimator->effective_parameters(), expected);
  ASSERT_TRUE(estimator->track(ground_frames(1, 1.0, 1.0)[0]).ok());
  EXPECT_THAT(estimator->effective_parameters(), Contains(Pair("read_back", "ORB 7")));
}

TEST(ProcessDoor, TellsTheCameraBeforeTheFirstFrameWhenItIsPrepared) {
  const auto estimator = started(scripted("good"));
  const VoFrame frame = ground_frames(1, 1.0, 1.0)[0];
  VoFrame first = frame;
  first.image = nullptr;
  ASSERT_TRUE(estimator->prepare(first).ok());
  EXPECT_THAT(estimator->effective_parameters(), Contains(Pair("read_back", "ORB 7")));
  EXPECT_EQ(estimator->track(frame)->counters.at("calibrations"), 1.0) << "it is told once";
}

TEST(ProcessDoor, TellsTheCameraOfTheFirstFrameWhenAnotherWasPrepared) {
  const auto estimator = started(scripted("good"));
  ASSERT_TRUE(estimator->prepare(ground_frames(1, 1.0, 1.0, 64, 48)[0]).ok());
  const VoFrame larger = ground_frames(1, 1.0, 1.0)[0];
  const VoEstimate estimate = estimator->track(larger).value();
  EXPECT_EQ(estimate.counters.at("calibrations"), 2.0);
  EXPECT_EQ(estimate.image_crc32, crc32_of(*larger.image));
}

TEST(ProcessDoor, PreparesNoBadCamera) {
  const auto estimator = started(scripted("good"));
  VoFrame first = ground_frames(1, 1.0, 1.0)[0];
  first.intrinsics.fx_px = -3.0;
  const Status status = estimator->prepare(first);
  ASSERT_FALSE(status.ok());
  EXPECT_EQ(status.error().code, ErrorCode::kInvalidArgument);
  EXPECT_THAT(status.error().message, HasSubstr("frame 0: fx_px = -3"));
}

TEST(ProcessDoor, FramesGoThroughTheSocketUpToTheSizeOfTheProtocol) {
  const auto estimator = started(scripted("by_socket"));
  VoFrame frame = ground_frames(1, 1.0, 1.0)[0];
  frame.intrinsics = {8193, 8192, 6000.0, 6000.0, 4096.0, 4095.5};
  const Status refused = estimator->prepare(frame);
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().code, ErrorCode::kInvalidArgument);
  EXPECT_THAT(refused.error().message,
              HasSubstr("8193 x 8192 = 67117056 pixels: a frame through the socket must have at "
                        "most 67108864"));
  frame.intrinsics.width_px = 8192;
  frame.image = std::make_shared<const Image>(8192, 8192, 1);
  // Samples for which there is no room do not cost the frame: the newest are sent.
  frame.sensors.imu.resize(20'000);
  const Result<VoEstimate> estimate = estimator->track(frame);
  ASSERT_TRUE(estimate.ok()) << estimate.error().message;
  EXPECT_EQ(estimate->image_crc32, crc32_of(*frame.image));
  // 65 MiB less 64 MiB of pixels and 48 bytes, in pieces of 56 bytes.
  EXPECT_THAT(estimator->take_log(),
              Contains("frame 0: of 20000 inertial samples FRAME has room for the last 18723"));
}

TEST(ProcessDoor, WaitsForAnEstimatorThatSomebodyElseStarts) {
  const testing::TemporaryFolder folder;
  const std::string path = (folder.path() / "socket").string();
  ProcessEstimatorOptions options;
  options.listen = "unix:" + path;
  pid_t pid = 0;
  std::thread somebody([&] {
    while (!std::filesystem::exists(path)) std::this_thread::yield();
    // The file is there a moment before the door listens.
    std::string shell = "/bin/sh";
    std::string option = "-c";
    std::string script = "for i in 1 2 3 4 5; do \"$0\" && exit 0; sleep 0.2; done; exit 1";
    std::string program = OVERFLY_SCRIPTED_ESTIMATOR;
    std::string variable = "OVERFLY_VO_ADDRESS=unix:" + path;
    std::array<char*, 5> argv = {
        shell.data(), option.data(), script.data(), program.data(), nullptr};
    std::array<char*, 2> envp = {variable.data(), nullptr};
    ASSERT_EQ(::posix_spawn(&pid, shell.c_str(), nullptr, nullptr, argv.data(), envp.data()), 0);
  });
  {
    const auto estimator = started(options);
    somebody.join();
    ASSERT_NE(estimator, nullptr);
    EXPECT_FALSE(std::filesystem::exists(path)) << "one estimator, then the door is shut";
    expect_whole_images(*estimator, "shared memory");
    ASSERT_TRUE(estimator->resource_use().has_value());
    EXPECT_GT(estimator->resource_use()->peak_memory_mb, 1.0);
  }
  int status = -1;
  EXPECT_EQ(::waitpid(pid, &status, 0), pid);
  EXPECT_EQ(status, 0) << "it ended by itself after the stop";
}

TEST(ProcessDoor, SaysWhenNobodyConnects) {
  const testing::TemporaryFolder folder;
  ProcessEstimatorOptions options;
  options.listen = "unix:" + (folder.path() / "socket").string();
  options.start_timeout_s = 0.2;
  const Error error = create_process_estimator(options).error();
  EXPECT_EQ(error.code, ErrorCode::kInternal);
  EXPECT_THAT(error.message, HasSubstr("no estimator connected to " + options.listen));
}

TEST(ProcessDoor, RefusesAnAddressInUse) {
  const testing::TemporaryFolder folder;
  ProcessEstimatorOptions options;
  options.listen = "unix:" + (folder.path() / "socket").string();
  options.start_timeout_s = 1.0;
  Error first;
  std::thread listening([&] { first = create_process_estimator(options).error(); });
  while (!std::filesystem::exists(folder.path() / "socket")) std::this_thread::yield();
  EXPECT_EQ(create_process_estimator(options).error().code, ErrorCode::kConflict);
  listening.join();
  EXPECT_THAT(first.message, HasSubstr("no estimator connected")) << "it was not disturbed";
}

TEST(ProcessDoor, TakesOverTheSocketFileOfADeadProgram) {
  const testing::TemporaryFolder folder;
  const std::string path = (folder.path() / "socket").string();
  sockaddr_un name{};
  name.sun_family = AF_UNIX;
  path.copy(name.sun_path, sizeof(name.sun_path) - 1);
  const int dead = ::socket(AF_UNIX, SOCK_STREAM, 0);
  ASSERT_EQ(::bind(dead, reinterpret_cast<const sockaddr*>(&name), sizeof(name)), 0);
  ::close(dead);
  ProcessEstimatorOptions options = scripted("good");
  options.listen = "unix:" + path;
  expect_whole_images(*started(options), "shared memory");
}

TEST(ProcessDoor, LeavesAFileThatIsNoSocketAlone) {
  const testing::TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "notes.txt";
  const std::filesystem::path link = folder.path() / "link";
  const std::filesystem::path dangling = folder.path() / "dangling";
  testing::write_text(file, "of the user\n");
  std::filesystem::create_symlink(file, link);
  std::filesystem::create_symlink(folder.path() / "absent", dangling);
  ProcessEstimatorOptions options = scripted("good");
  const auto refusal = [&](const std::filesystem::path& path) {
    options.listen = "unix:" + path.string();
    const auto estimator = create_process_estimator(options);
    EXPECT_FALSE(estimator.ok());
    EXPECT_TRUE(std::filesystem::exists(std::filesystem::symlink_status(path))) << path;
    return estimator.ok() ? "taken" : estimator.error().message;
  };
  EXPECT_EQ(refusal(file), "listen = 'unix:" + file.string() + "': is a file, not a socket");
  EXPECT_THAT(refusal(link), HasSubstr("': is a link, not a socket"));
  EXPECT_THAT(refusal(dangling), HasSubstr("': is a link, not a socket"));
  EXPECT_THAT(refusal(folder.path()), HasSubstr("': is a folder, not a socket"));
  EXPECT_EQ(testing::read_text(file), "of the user\n");
}

TEST(ProcessDoor, KeepsWhatTheChildWrites) {
  const testing::TemporaryFolder folder;
  ProcessEstimatorOptions options = scripted("shout");
  options.command = {"/bin/sh",
                     "-c",
                     "echo first; echo second >&2; pwd; exec \"$0\" good",
                     OVERFLY_SCRIPTED_ESTIMATOR};
  options.output_file = folder.path() / "output.log";
  options.working_folder = folder.path();
  {
    const auto estimator = started(options);
    EXPECT_THAT(estimator->take_log(), IsSupersetOf({std::string("first"), std::string("second")}));
    EXPECT_THAT(estimator->take_log(), ::testing::IsEmpty());
  }
  EXPECT_EQ(testing::read_text(options.output_file),
            "first\nsecond\n" + std::filesystem::canonical(folder.path()).string() + "\n");
}

TEST(ProcessDoor, TellsWhatTheChildUses) {
  const auto estimator = started(scripted("eat", "120"));
  const ResourceUse before = estimator->resource_use().value();
  for (const VoFrame& frame : ground_frames(4, 1.0, 1.0)) ASSERT_TRUE(estimator->track(frame).ok());
  const ResourceUse after = estimator->resource_use().value();
  // It is busy for 0.3 s of wall time, of which a loaded machine may give it little.
  EXPECT_GT(after.cpu_s, before.cpu_s + 0.05);
  EXPECT_LT(after.cpu_s, 5.0);
  EXPECT_GT(after.peak_memory_mb, 120.0);
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // which need their own memory
  EXPECT_LT(after.peak_memory_mb, 160.0);
  EXPECT_LT(before.peak_memory_mb, 40.0) << "the fork's own memory does not count";
#endif
}

TEST(ProcessDoor, BindsTheChildToItsCpus) {
  ProcessEstimatorOptions options = scripted("good");
  options.cpus = {testing::first_cpu()};
  const auto estimator = started(options);
  EXPECT_EQ(estimator->track(ground_frames(1, 1.0, 1.0)[0])->counters.at("cpus"), 1.0);
}

TEST(ProcessDoor, LimitsTheMemoryOfTheChild) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "the sanitizer reserves more than any limit";
#endif
  ProcessEstimatorOptions options = scripted("eat", "300");
  options.memory_limit_mb = 200.0;
  const auto estimator = started(options);
  const auto frames = ground_frames(3, 1.0, 1.0);
  ASSERT_TRUE(estimator->track(frames[0]).ok());
  ASSERT_TRUE(estimator->track(frames[1]).ok());
  const Result<VoEstimate> estimate = estimator->track(frames[2]);
  ASSERT_FALSE(estimate.ok());
  EXPECT_THAT(estimate.error().message, HasSubstr("bad_alloc"));
}

}  // namespace
}  // namespace overfly
