// Live cameras: addresses, MJPEG over HTTP, RTSP, and cameras that fail.
#include "server/imagery/live/live_images.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "server/files/jpeg.hpp"
#include "server/imagery/video_images.hpp"
#include "tests/server/imagery/raw_rtsp_server.hpp"
#include "tests/terrain/local_http_server.hpp"

namespace overfly::server {
namespace {

using overfly::testing::HttpAnswer;
using overfly::testing::LocalHttpServer;
using ::testing::HasSubstr;
using namespace std::chrono_literals;

/// A slope, so that a shifted or mirrored image differs.
Image slope(int width_px, int height_px, int from) {
  Image image(width_px, height_px, 1);
  for (int y = 0; y < height_px; ++y) {
    for (int x = 0; x < width_px; ++x) {
      image.at(x, y) = static_cast<std::uint8_t>(from + x / 4 + y / 2);
    }
  }
  return image;
}

double mean_difference(const Image& a, const Image& b) {
  if (a.width_px != b.width_px || a.height_px != b.height_px) return 255.0;
  double sum = 0.0;
  for (std::size_t i = 0; i < a.data.size(); ++i) sum += std::abs(a.data[i] - b.data[i]);
  return sum / static_cast<double>(a.data.size());
}

std::string part_of(const Image& image) {
  const auto jpeg = encode_jpeg(image, 95).value();
  return "--cut\r\nContent-Type: image/jpeg\r\nContent-Length: " + std::to_string(jpeg.size()) +
         "\r\n\r\n" + std::string(jpeg.begin(), jpeg.end()) + "\r\n";
}

/// All images of a camera until it ends.
struct Received {
  std::vector<Image> images;
  Error end{ErrorCode::kInternal, ""};
};
Received receive_all(LiveImages& camera) {
  Received received;
  for (int turns = 0; turns < 200; ++turns) {
    auto image = camera.next(100ms);
    if (!image) {
      received.end = image.error();
      return received;
    }
    if (*image) received.images.push_back(std::move(**image));
  }
  return received;
}

LiveAddress address_of(const std::string& text) {
  auto address = parse_live_address(text, "--allow-camera");
  if (!address) throw std::runtime_error(address.error().message);
  return *address;
}

TEST(LiveAddress, ReadsEveryKind) {
  EXPECT_EQ(address_of("rtsp://192.168.1.10:554/stream1").kind, LiveKind::kRtsp);
  EXPECT_EQ(address_of("http://[::1]:80/video").kind, LiveKind::kHttp);
  EXPECT_EQ(address_of("v4l2:/dev/video0").url, "/dev/video0");
  const LiveAddress lcm = address_of("lcm:CAMERA");
  EXPECT_EQ(lcm.topic, "CAMERA");
  EXPECT_EQ(lcm.url, "udpm://239.255.76.67:7667?ttl=0");
  const LiveAddress ros = address_of("ros1:/camera/image_raw@http://127.0.0.1:11312");
  EXPECT_EQ(ros.topic, "/camera/image_raw");
  EXPECT_EQ(ros.url, "http://127.0.0.1:11312");
}

TEST(LiveAddress, ShowsNoPasswordToClients) {
  const LiveAddress address = address_of("rtsp://user:p@ss@127.0.0.1/live");
  EXPECT_EQ(address.name, "rtsp://127.0.0.1/live");
  EXPECT_EQ(address.url, "rtsp://user:p@ss@127.0.0.1/live");
  const auto bad = parse_live_address("rtsp://user:secret@camera.example/live", "--allow-camera");
  ASSERT_FALSE(bad);
  EXPECT_THAT(bad.error().message, HasSubstr("--allow-camera = rtsp://...@camera.example/live"));
  EXPECT_THAT(bad.error().message, ::testing::Not(HasSubstr("secret")));
}

TEST(LiveAddress, RejectsNamesThatWouldBeLookedUpAndOtherProtocols) {
  for (const char* text : {"http://camera.example/video",
                           "https://127.0.0.1/video",
                           "rtsp://",
                           "rtsp://127.0.0.1:0/x",
                           "rtsp://127.0.0.1:99999/x",
                           "http://127.0.0.1:80:80/x",
                           "http://127.1/x",
                           "file:///etc/passwd",
                           "concat:http://127.0.0.1/a",
                           "v4l2:/etc/passwd",
                           "v4l2:/dev/../etc/passwd",
                           "v4l2:video0",
                           "lcm:",
                           "lcm:A.*",
                           "ros1:",
                           "http://127.0.0.1/ x",
                           ""}) {
    EXPECT_FALSE(parse_live_address(text, "camera")) << text;
  }
  EXPECT_FALSE(parse_live_address("http://127.0.0.1/" + std::string(2000, 'a'), "camera"));
}

class LiveVideo : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!reads_videos()) GTEST_SKIP() << "this build reads no videos";
  }
};

TEST_F(LiveVideo, ReceivesMjpegOverHttp) {
  const std::vector<Image> sent = {slope(160, 120, 20), slope(160, 120, 60), slope(160, 120, 100)};
  const LocalHttpServer server([&](const overfly::testing::HttpRequest&) {
    HttpAnswer answer;
    answer.content_type = "multipart/x-mixed-replace;boundary=cut";
    for (const Image& image : sent) answer.body += part_of(image);
    answer.body += "--cut--\r\n";
    return answer;
  });
  auto camera = open_live_images(address_of(server.address() + "/video"), nullptr);
  ASSERT_TRUE(camera) << camera.error().message;
  const Received received = receive_all(**camera);
  EXPECT_EQ(received.end.code, ErrorCode::kIo);
  EXPECT_THAT(received.end.message, HasSubstr("the camera has ended"));
  // Only the newest image is kept: the last one is always received.
  ASSERT_FALSE(received.images.empty());
  EXPECT_LT(mean_difference(received.images.back(), sent.back()), 1.5);
}

TEST_F(LiveVideo, ReceivesRtspOverTheConnectionItself) {
  const Image sent = slope(160, 120, 30);
  overfly::testing::RawRtspServer server(sent);
  auto camera = open_live_images(address_of(server.address()), nullptr);
  ASSERT_TRUE(camera) << camera.error().message;
  std::optional<Image> received;
  for (int turns = 0; turns < 100 && !received; ++turns) {
    auto image = (*camera)->next(100ms);
    ASSERT_TRUE(image) << image.error().message;
    received = std::move(*image);
  }
  ASSERT_TRUE(received);
  // Video's luma of 16 to 235 is stretched to 0 to 255.
  Image stretched = sent;
  for (std::uint8_t& value : stretched.data) {
    value = static_cast<std::uint8_t>(std::lround((value - 16) * 255.0 / 219.0));
  }
  EXPECT_LT(mean_difference(*received, stretched), 1.5);
  EXPECT_THAT(server.requests(), HasSubstr("interleaved"));
}

TEST_F(LiveVideo, NamesTheCameraThatDoesNotAnswer) {
  const LocalHttpServer text([](const overfly::testing::HttpRequest&) {
    HttpAnswer answer;
    answer.content_type = "text/html";
    answer.body = "<html>no camera</html>";
    return answer;
  });
  const LocalHttpServer none([](const overfly::testing::HttpRequest&) {
    HttpAnswer answer;
    answer.status = 404;
    return answer;
  });
  for (const std::string& url : {text.address() + "/a",
                                 none.address() + "/a",
                                 std::string("rtsp://127.0.0.1:1/a"),
                                 std::string("http://127.0.0.1:1/")}) {
    const auto camera = open_live_images(address_of(url), nullptr);
    ASSERT_FALSE(camera) << url;
    EXPECT_THAT(camera.error().message, HasSubstr(url));
  }
}

TEST_F(LiveVideo, RefusesACameraThatRefersToAnotherAddress) {
  std::string elsewhere;
  const LocalHttpServer other([&](const overfly::testing::HttpRequest&) {
    HttpAnswer answer;
    answer.content_type = "multipart/x-mixed-replace;boundary=cut";
    answer.body = part_of(slope(160, 120, 20)) + "--cut--\r\n";
    return answer;
  });
  const LocalHttpServer server([&](const overfly::testing::HttpRequest&) {
    HttpAnswer answer;
    answer.status = 302;
    answer.headers.push_back("Location: " + other.address() + "/video");
    return answer;
  });
  const auto camera = open_live_images(address_of(server.address() + "/video"), nullptr);
  ASSERT_FALSE(camera);
  EXPECT_THAT(camera.error().message, HasSubstr("refers to another address"));
}

TEST_F(LiveVideo, RefusesAnRtspCameraThatRefersToAnotherAddress) {
  const Image image = slope(160, 120, 30);
  const overfly::testing::RawRtspServer other(image);
  const overfly::testing::RawRtspServer server(image, /*silent=*/false, other.address());
  const auto camera = open_live_images(address_of(server.address()), nullptr);
  ASSERT_FALSE(camera);
  EXPECT_THAT(camera.error().message, HasSubstr("refers to another address"));
}

TEST_F(LiveVideo, IsCancelledWhileItWaits) {
  overfly::testing::RawRtspServer server(slope(160, 120, 30), /*silent=*/true);
  std::atomic<bool> cancel{false};
  std::thread soon([&] {
    server.wait_for_client();
    cancel = true;
  });
  const auto camera = open_live_images(address_of(server.address()), &cancel);
  soon.join();
  ASSERT_FALSE(camera);
  EXPECT_EQ(camera.error().code, ErrorCode::kCancelled);
}

TEST_F(LiveVideo, NamesTheDeviceThatIsNone) {
  const auto none = open_live_images(address_of("v4l2:/dev/video-none"), nullptr);
  ASSERT_FALSE(none);
  EXPECT_THAT(none.error().message, HasSubstr("/dev/video-none"));
  // kUnsupported would mean that FFmpeg's library of devices was not loaded.
  EXPECT_EQ(none.error().code, ErrorCode::kIo) << none.error().message;
  // A device, but no camera.
  const auto other = open_live_images(address_of("v4l2:/dev/null"), nullptr);
  ASSERT_FALSE(other);
  EXPECT_THAT(other.error().message, HasSubstr("/dev/null"));
}

}  // namespace
}  // namespace overfly::server
