// Which graphics device draws: what can be asked for, what is tried, and what is said of it.
#include "renderer/device_choice.hpp"

#include <gtest/gtest.h>

#include "renderer/renderer.hpp"
#include "tests/renderer/procedural_ground.hpp"

namespace overfly::renderer {
namespace {

using Order = std::vector<std::size_t>;

std::string quoted(const std::string& text) {
  std::string result(1, '"');
  result += text;
  result += '"';
  return result;
}

/// Two GPUs, one software device, the surfaceless platform.
std::vector<OfferedDevice> workstation() {
  return {{0, "0000:01:00.0", false}, {1, "", true}, {2, "0000:82:00.0", false}, {-1, "", false}};
}

Order order(const std::string& request) {
  return devices_to_try(DeviceRequest::parse(request).value(), workstation());
}

TEST(DeviceChoice, ReadsIndexAddressAndSoftware) {
  EXPECT_TRUE(DeviceRequest::parse("").value().any());
  EXPECT_EQ(DeviceRequest::parse("12").value().index, 12);
  EXPECT_EQ(DeviceRequest::parse("0000:3B:00.1").value().pci_address, "0000:3b:00.1");
  EXPECT_EQ(DeviceRequest::parse("3b:00.0").value().pci_address, "0000:3b:00.0");
  EXPECT_EQ(DeviceRequest::parse("00000000:01:00.0").value().pci_address, "0000:01:00.0");
  EXPECT_EQ(DeviceRequest::parse("00010000:01:00.0").value().pci_address, "10000:01:00.0");
  EXPECT_TRUE(DeviceRequest::parse("software").value().software);
}

TEST(DeviceChoice, RefusesWhatIsNoDevice) {
  for (const char* text : {"gpu", "-1", "0000:01:00", "1.5", "01:00.9", "Software", "0 "}) {
    const auto request = DeviceRequest::parse(text);
    ASSERT_FALSE(request.ok()) << text;
    EXPECT_EQ(request.error().code, ErrorCode::kInvalidArgument);
    EXPECT_NE(request.error().message.find(quoted(text)), std::string::npos);
  }
}

TEST(DeviceChoice, TriesGpusFirstAndSoftwareLast) { EXPECT_EQ(order(""), (Order{0, 2, 3, 1})); }

TEST(DeviceChoice, TriesTheDeviceAskedForThenSoftware) {
  EXPECT_EQ(order("2"), (Order{2, 1, 3}));
  EXPECT_EQ(order("82:00.0"), (Order{2, 1, 3}));
  EXPECT_EQ(order("00000000:82:00.0"), (Order{2, 1, 3})) << "as nvidia-smi writes it";
  EXPECT_EQ(order("7"), (Order{1, 3})) << "no such device";
  EXPECT_EQ(order("software"), (Order{1, 3})) << "never a GPU";
}

class DrawingDevice : public ::testing::Test {
 protected:
  void SetUp() override {
    if (const auto egl = probe_egl(); !egl.ok()) GTEST_SKIP() << egl.error().message;
  }
  static Result<RendererInfo> info_of(const std::string& device) {
    RendererOptions options;
    options.device = device;
    options.camera_backend = CameraBackend::kEgl;
    const auto renderer = create_renderer(overfly::testing::natural_ground(), options);
    if (!renderer.ok()) return renderer.error();
    return (*renderer)->info();
  }
};

TEST_F(DrawingDevice, FallsBackToSoftwareAndSaysSo) {
  for (const char* device : {"99", "ffff:ff:1f.7"}) {
    const auto info = info_of(device);
    ASSERT_TRUE(info.ok()) << info.error().message;
    EXPECT_TRUE(info->software);
    EXPECT_NE(info->device_note.find(quoted(device)), std::string::npos) << info->device_note;
    EXPECT_NE(info->device_note.find("no such device"), std::string::npos) << info->device_note;
  }
}

TEST_F(DrawingDevice, SoftwareDrawsWhenItIsAskedFor) {
  const auto info = info_of("software");
  ASSERT_TRUE(info.ok()) << info.error().message;
  EXPECT_TRUE(info->software);
  EXPECT_EQ(info->device_note.find(" instead"), std::string::npos) << info->device_note;
}

TEST_F(DrawingDevice, EveryListedDeviceCanBeAskedForByItsIndex) {
  const auto devices = list_graphics_devices();
  if (devices.empty()) GTEST_SKIP() << "EGL lists no devices here";
  for (const GraphicsDevice& device : devices) {
    const auto info = info_of(std::to_string(device.index));
    ASSERT_TRUE(info.ok()) << info.error().message;
    if (device.fault.empty()) {
      EXPECT_EQ(info->device, device.info.device);
      EXPECT_EQ(info->device_note.find(" instead"), std::string::npos) << info->device_note;
    } else {
      EXPECT_TRUE(info->software);
    }
  }
}

TEST_F(DrawingDevice, NonsenseIsRefused) {
  const auto info = info_of("fastest");
  ASSERT_FALSE(info.ok());
  EXPECT_EQ(info.error().code, ErrorCode::kInvalidArgument);
}

}  // namespace
}  // namespace overfly::renderer
