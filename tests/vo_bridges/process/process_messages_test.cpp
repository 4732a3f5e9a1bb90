// The messages, byte by byte, as docs/VO_PROTOCOL.md prints them.
#include "core/measure/crc32.hpp"
#include "vo_bridges/process/link/messages.hpp"

#include <gmock/gmock.h>

#include <limits>
#include <sstream>

#include "tests/support/support.hpp"
#include "vo_bridges/client/overfly_vo.hpp"

namespace overfly::process {
namespace {

using ::testing::HasSubstr;

/// The bytes of a block "```hex NAME" of the document.
std::string documented(const std::string& name) {
  const std::string text = testing::read_text(testing::source_file("docs/VO_PROTOCOL.md"));
  const std::string mark = "```hex " + name + "\n";
  const std::size_t begin = text.find(mark);
  EXPECT_NE(begin, std::string::npos) << "docs/VO_PROTOCOL.md has no block " << name;
  if (begin == std::string::npos) return "";
  std::istringstream block(
      text.substr(begin + mark.size(), text.find("```", begin + 3) - begin - mark.size()));
  std::string bytes;
  for (int byte = 0; block >> std::hex >> byte;) bytes.push_back(static_cast<char>(byte));
  return bytes;
}

VoFrame small_frame() {
  VoFrame frame;
  frame.index = 7;
  frame.t_ns = 250'000'000;
  frame.exposure_ns = 2'000'000;
  Image image(2, 2, 1);
  image.data = {1, 2, 3, 4};
  frame.image = std::make_shared<const Image>(std::move(image));
  frame.intrinsics = PinholeCamera::from_fov(2, 2, 1.0, FovAxis::kHorizontal).value();
  return frame;
}

std::string payload_of_document(const std::string& name) {
  return documented(name).substr(kHeaderBytes);
}

/// The documented answer with some of its bytes replaced.
std::string answer_with(std::size_t offset, const std::string& bytes) {
  std::string payload = payload_of_document("answer");
  payload.replace(offset, bytes.size(), bytes);
  return payload;
}

std::string f64(double value) { return std::move(ByteWriter().f64(value).bytes()); }
std::string u32(std::uint32_t value) { return std::move(ByteWriter().u32(value).bytes()); }

TEST(ProcessMessages, AreThoseOfTheDocument) {
  EXPECT_EQ(message_of(MessageType::kStop), documented("stop"));
  EXPECT_EQ(message_of(MessageType::kReady, u32(3)), documented("ready"));
  const VoFrame frame = small_frame();
  FrameSending sending;
  sending.crc32 = crc32_of(*frame.image);
  sending.debug_wanted = true;
  std::string bytes = frame_message(frame, sending);
  for (const std::uint8_t pixel : frame.image->data) bytes.push_back(static_cast<char>(pixel));
  EXPECT_EQ(bytes, documented("frame"));
}

VoFrame frame_with_samples() {
  VoFrame frame = small_frame();
  frame.sensors.barometer = {{240'000'000, 98765.5, 281.25}, {245'000'000, 98765.75, 281.5}};
  GpsSample fix;
  fix.t_ns = 100'000'000;
  fix.delivered_ns = 200'000'000;
  fix.place = geodetic_from_deg(39.5, -86.25, 210.5);
  fix.velocity_ned_m_s = {20.0, -3.0, 0.5};
  fix.horizontal_accuracy_m = 4.75;
  fix.vertical_accuracy_m = 9.25;
  fix.speed_accuracy_m_s = 0.0625;
  GpsSample none = fix;
  none.fix = GpsFixType::kNone;
  frame.sensors.gps = {fix, none};
  frame.sensors.airspeed = {{230'000'000, 350.5, 23.75}};
  frame.sensors.magnetometer = {{220'000'000, {19.5, -1.25, 48.0}}};
  frame.sensors.range = {{210'000'000, std::numeric_limits<double>::infinity()}};
  return frame;
}

TEST(ProcessMessages, SamplesOfSensorsReachTheClient) {
  const std::string message = sensors_message(frame_with_samples());
  EXPECT_EQ(message.size(), kHeaderBytes + 32 + 2 * 24 + 2 * 96 + 24 + 32 + 16);
  overfly_vo::Frame frame;
  overfly_vo::detail::add_samples(message.substr(kHeaderBytes), &frame);
  ASSERT_EQ(frame.barometer.size(), 2U);
  EXPECT_EQ(frame.barometer[1].t_ns, 245'000'000);
  EXPECT_EQ(frame.barometer[1].pressure_pa, 98765.75);
  EXPECT_EQ(frame.barometer[1].temperature_k, 281.5);
  ASSERT_EQ(frame.gps.size(), 2U);
  EXPECT_TRUE(frame.gps[0].has_fix);
  EXPECT_FALSE(frame.gps[1].has_fix);
  EXPECT_EQ(frame.gps[0].delivered_ns, 200'000'000);
  EXPECT_NEAR(frame.gps[0].lat_deg, 39.5, 1e-12);
  EXPECT_NEAR(frame.gps[0].lon_deg, -86.25, 1e-12);
  EXPECT_EQ(frame.gps[0].alt_ellipsoid_m, 210.5);
  EXPECT_EQ(frame.gps[0].velocity_ned_m_s, (std::array<double, 3>{20.0, -3.0, 0.5}));
  EXPECT_EQ(frame.gps[0].horizontal_accuracy_m, 4.75);
  EXPECT_EQ(frame.gps[0].vertical_accuracy_m, 9.25);
  EXPECT_EQ(frame.gps[0].speed_accuracy_m_s, 0.0625);
  ASSERT_EQ(frame.airspeed.size(), 1U);
  EXPECT_EQ(frame.airspeed[0].differential_pressure_pa, 350.5);
  EXPECT_EQ(frame.airspeed[0].indicated_airspeed_m_s, 23.75);
  ASSERT_EQ(frame.magnetometer.size(), 1U);
  EXPECT_EQ(frame.magnetometer[0].field_ut, (std::array<double, 3>{19.5, -1.25, 48.0}));
  ASSERT_EQ(frame.range.size(), 1U);
  EXPECT_EQ(frame.range[0].range_m, std::numeric_limits<double>::infinity());
  // A server that announces more than it sends.
  std::string short_by_one = message.substr(kHeaderBytes);
  short_by_one.pop_back();
  EXPECT_THROW(overfly_vo::detail::add_samples(short_by_one, &frame), std::runtime_error);
  EXPECT_EQ(sensors_message(small_frame()), "") << "nothing to send";
}

TEST(ProcessMessages, OfTheClientAreThoseOfTheDocument) {
  overfly_vo::Answer answer;
  answer.state = overfly_vo::State::kTracking;
  answer.map_id = 1;
  answer.position = {1.0, -2.0, 0.5};
  answer.scene_depth = 2.0;
  answer.counters = {{"features", 90.0}};
  std::string not_finite;
  const std::string payload = overfly_vo::detail::payload_of(answer, 7, 0xB63CFBCD, &not_finite);
  EXPECT_EQ(message_of(MessageType::kAnswer, payload), documented("answer"));
  EXPECT_EQ(overfly_vo::detail::crc32_of(small_frame().image->data.data(), 4), 0xB63CFBCDU);
}

TEST(ProcessMessages, ReadTheAnswerOfTheDocument) {
  FigureIntake figures;
  const VoEstimate estimate =
      answer_from(payload_of_document("answer"), small_frame(), &figures).value();
  EXPECT_EQ(estimate.sample.frame, 7);
  EXPECT_EQ(estimate.sample.t_ns, 250'000'000);
  EXPECT_EQ(estimate.sample.state, TrackingState::kTracking);
  EXPECT_EQ(estimate.sample.map_id, 1);
  EXPECT_EQ(estimate.sample.T_vo_camera.translation, Eigen::Vector3d(1.0, -2.0, 0.5));
  EXPECT_EQ(estimate.sample.T_vo_camera.rotation.coeffs(), Eigen::Vector4d(0.0, 0.0, 0.0, 1.0));
  EXPECT_EQ(estimate.sample.scene_depth, 2.0);
  EXPECT_EQ(estimate.image_crc32, 0xB63CFBCDU);
  EXPECT_EQ(estimate.counters, (std::map<std::string, double>{{"features", 90.0}}));
}

TEST(ProcessMessages, RefuseAnAnswerWithABadField) {
  const auto refused = [](const std::string& payload) {
    FigureIntake figures;
    const Result<VoEstimate> estimate = answer_from(payload, small_frame(), &figures);
    return estimate.ok() ? "taken" : estimate.error().message;
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(refused(answer_with(0, u32(8))), HasSubstr("frame 8: frame 7 is expected"));
  EXPECT_THAT(refused(answer_with(8, u32(3))), HasSubstr("state = 3"));
  EXPECT_THAT(refused(answer_with(12, u32(0xFFFFFFFF))), HasSubstr("map_id = 4294967295"));
  EXPECT_EQ(refused(answer_with(24, f64(nan))), "taken") << "PoseIntake judges poses";
  EXPECT_THAT(refused(answer_with(88, "counter f\xFF")), HasSubstr("'counter f?"));
  EXPECT_THAT(refused(answer_with(106, "x")), HasSubstr("must be a name and a number"));
  EXPECT_THAT(refused(payload_of_document("answer").substr(0, 87)), HasSubstr("has 87 bytes"));
  EXPECT_THAT(refused(""), HasSubstr("has 0 bytes"));
}

TEST(ProcessMessages, LeaveOutFiguresThatAreNotFiniteAndNoteTheFirst) {
  const std::string payload = payload_of_document("answer") +
                              "counter a nan\ncounter b -inf\ntiming_ms c 1e999\ntiming_ms d 2\n";
  FigureIntake figures;
  const Result<VoEstimate> estimate = answer_from(payload, small_frame(), &figures);
  ASSERT_TRUE(estimate.ok()) << estimate.error().message;
  EXPECT_EQ(estimate->counters, (std::map<std::string, double>{{"features", 90.0}}));
  EXPECT_EQ(estimate->timing_ms, (std::map<std::string, double>{{"d", 2.0}}));
  EXPECT_EQ(figures.take_notes(),
            (std::vector<std::string>{"warning: counter a is not finite: this and later such "
                                      "values are ignored"}));
  ASSERT_TRUE(answer_from(payload, small_frame(), &figures).ok());
  EXPECT_TRUE(figures.take_notes().empty()) << "it is said once";
}

TEST(ProcessMessages, CarryTheCovarianceThatTheClientStates) {
  overfly_vo::Answer answer;
  answer.state = overfly_vo::State::kTracking;
  answer.counters = {{"features", 90.0}};
  for (int i = 0; i < 36; ++i) answer.covariance.push_back(i % 7 == 0 ? 1.0 / 3.0 : -1e-7 * i);
  std::string not_finite;
  const std::string payload = overfly_vo::detail::payload_of(answer, 7, 0xB63CFBCD, &not_finite);
  FigureIntake figures;
  const Result<VoEstimate> estimate = answer_from(payload, small_frame(), &figures);
  ASSERT_TRUE(estimate.ok()) << estimate.error().message;
  EXPECT_EQ(estimate->covariance, answer.covariance) << "as stated: PoseIntake judges it";
  EXPECT_EQ(estimate->counters, answer.counters);
}

TEST(ProcessMessages, TakeNumbersAsACovarianceAndNothingElse) {
  const auto with = [](const std::string& line) {
    FigureIntake figures;
    return answer_from(payload_of_document("answer") + line, small_frame(), &figures);
  };
  EXPECT_TRUE(with("").value().covariance.empty());
  const Result<VoEstimate> odd = with("covariance 1 nan 1e999\n");
  ASSERT_TRUE(odd.ok()) << odd.error().message;
  ASSERT_EQ(odd->covariance.size(), 3U);
  EXPECT_TRUE(std::isnan(odd->covariance[1]));
  EXPECT_TRUE(std::isinf(odd->covariance[2]));
  EXPECT_THAT(with("covariance 1 x2 3\n").error().message,
              HasSubstr("'covariance' has 'x2': must be numbers"));
  EXPECT_THAT(with("covariance 1  3\n").error().message, HasSubstr("has ''"));
}

TEST(ProcessMessages, PassOverThePoseOfALostFrame) {
  const std::string lost = answer_with(8, u32(2)).replace(24, 8, f64(1e300 * 1e300));
  FigureIntake figures;
  const VoEstimate estimate = answer_from(lost, small_frame(), &figures).value();
  EXPECT_EQ(estimate.sample.state, TrackingState::kLost);
  EXPECT_EQ(estimate.sample.T_vo_camera.translation, Eigen::Vector3d::Zero());
  EXPECT_FALSE(estimate.sample.scene_depth.has_value());
}

TEST(ProcessMessages, ReadGreyAndColourDebugImages) {
  const auto payload = [](std::uint32_t width, std::uint32_t channels, const std::string& pixels) {
    return std::move(
        ByteWriter().i64(7).u32(width).u32(1).u32(channels).u32(0).text(pixels).bytes());
  };
  EXPECT_EQ(debug_image_from(payload(2, 1, "ab"), small_frame())->data,
            (std::vector<std::uint8_t>{'a', 'a', 'a', 'b', 'b', 'b'}));
  EXPECT_EQ(debug_image_from(payload(1, 3, "rgb"), small_frame())->data,
            (std::vector<std::uint8_t>{'r', 'g', 'b'}));
  EXPECT_THAT(debug_image_from(payload(3, 1, "abc"), small_frame()).error().message,
              HasSubstr("3 x 1 px of 1 channels: must be at most 2 x 2 px"));
  EXPECT_THAT(debug_image_from(payload(2, 2, "abcd"), small_frame()).error().message,
              HasSubstr("2 channels"));
  EXPECT_THAT(debug_image_from(payload(2, 3, "abc"), small_frame()).error().message,
              HasSubstr("must be 30"));
  EXPECT_THAT(debug_image_from("abc", small_frame()).error().message, HasSubstr("24 or more"));
}

TEST(ProcessMessages, ReadMapPointsOfTheAnnouncedNumber) {
  // 1.0F and -2.0F, as their bits.
  const auto payload = [](std::uint32_t count) {
    ByteWriter writer;
    writer.i64(7).u32(count).u32(0).u32(0x3F800000).u32(0xC0000000).u32(0);
    return std::move(writer.bytes());
  };
  const auto points = map_points_from(payload(1), small_frame());
  ASSERT_TRUE(points.ok());
  EXPECT_EQ(points->at(0), Eigen::Vector3f(1.0F, -2.0F, 0.0F));
  std::string infinite = payload(1);
  infinite.replace(infinite.size() - 4, 4, std::string("\0\0\x80\x7F", 4));
  EXPECT_TRUE(map_points_from(infinite, small_frame()).ok()) << "PoseIntake leaves it out";
  EXPECT_THAT(map_points_from(payload(0xFFFFFFFF), small_frame()).error().message,
              HasSubstr("must be 51539607556"));
}

TEST(ProcessMessages, TellTheCamera) {
  VoFrame frame = small_frame();
  frame.intrinsics = {1280, 960, 700.006, 700.006, 639.5, 479.5};
  frame.distortion = {DistortionModel::kEquidistant, {0.1, -0.02, 0.003, 0.0, 0.0}};
  const std::string bytes = calibration_message(frame, 31.0, {2, 1228800});
  EXPECT_EQ(bytes.substr(kHeaderBytes),
            "camera camera0\nwidth_px 1280\nheight_px 960\nfx_px 700.006\nfy_px 700.006\n"
            "cx_px 639.5\ncy_px 479.5\ndistortion equidistant\n"
            "distortion_coefficients 0.1 -0.02 0.003 0\nrate_hz 31\nframe_slots 2\n"
            "frame_slot_bytes 1228800\n");
}

TEST(ProcessMessages, SayHelloWithTheParametersWanted) {
  const std::string bytes = server_hello(
      false, {{"loop", ParameterValue(true)}, {"n", 7.0}, {"path", std::string("a b")}});
  EXPECT_EQ(bytes.substr(kHeaderBytes),
            "protocol 1\nserver overfly\nlockstep false\nparameter loop true\nparameter n 7\n"
            "parameter path a b\n");
}

TEST(ProcessMessages, RefuseABadHello) {
  EXPECT_THAT(hello_from("name x\n").error().message, HasSubstr("lacks 'protocol'"));
  EXPECT_THAT(hello_from("protocol 1\n").error().message, HasSubstr("lacks 'name'"));
  EXPECT_THAT(hello_from("protocol 3\nname x\n").error().message,
              HasSubstr("protocol version '3': must be 1"));
  EXPECT_EQ(hello_from("protocol 1\nname x\nnews 5\nshared_memory true")->takes_shared_memory,
            true);
}

TEST(ProcessMessages, QuoteInvalidBytes) {
  EXPECT_EQ(shown("GET / HTTP/1.1 and so on").substr(0, 12), "47 45 54 20 ");
}

}  // namespace
}  // namespace overfly::process
