// The exported calibration must undo what the sensor does, by the formula of those who load it.
#include "sensor/photometric_calibration.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "tests/sensor/flat_field.hpp"
#include "tests/support/support.hpp"

namespace overfly::sensor {
namespace {

using testing::flat_field;
using testing::sensor_of;
using testing::small_camera;

SensorModel photographing_sensor(int bits) {
  SensorModel model;
  model.enabled = true;
  model.bits = bits;
  model.vignette = Vignette{{-0.35, 0.1, -0.05}};
  return model;
}

TEST(PhotometricCalibration, UndoesResponseVignetteAndExposure) {
  // Engel, Usenko, Cremers 2016, eq. 1: I = G(t V B), so that B = G^-1(I) / (t V).
  const CameraModel camera = small_camera(320, 240);
  for (const int bits : {8, 12}) {
    for (const ResponseCurve& response :
         {ResponseCurve{},
          ResponseCurve{ResponseShape::kGamma, 2.2, {}},
          ResponseCurve{ResponseShape::kTable, 1.0, {0.0, 0.4, 0.7, 0.9, 1.0}},
          ResponseCurve::linear()}) {
      SensorModel model = photographing_sensor(bits);
      model.response = response;
      // One gain for all exposures.
      model.gain_dn_per_e = model.effective_gain_dn_per_e();
      const auto inverse = inverse_response(model);
      const Image16 vignette = vignette_map(model, camera);
      for (const double exposure_s : {0.5e-3, 1e-3, 2e-3}) {
        model.exposure_s = exposure_s;
        const auto sensor = sensor_of(model, camera);
        const SensorImage made = sensor->expose(flat_field(320, 240, 0.6F), 0);
        for (const auto& [x, y] : {std::pair{0, 0}, {160, 120}, {319, 10}, {80, 200}}) {
          const int value = made.image.at(x, y);
          const double t = exposure_s / 2e-3;
          const double radiance = inverse[value] / 255.0 / (t * vignette.at(x, y) / 65535.0);
          // An 8-bit value stands for a range of irradiance: half of it, and half more where the
          // lowest bits of a deeper sensor were cut off.
          const double range = inverse[std::min(value + 1, 255)] - inverse[std::max(value - 1, 0)];
          const double tolerance = 0.6 * 0.5 * range / inverse[value] + 1e-3;
          EXPECT_NEAR(radiance, 0.6, tolerance)
              << bits << " bit, " << to_string(response.shape) << ", " << exposure_s << " s, " << x;
        }
      }
    }
  }
}

TEST(PhotometricCalibration, InverseResponseGrowsFromZeroTo255) {
  for (const int bits : {8, 10, 16}) {
    const auto inverse = inverse_response(photographing_sensor(bits));
    EXPECT_DOUBLE_EQ(inverse[255], 255.0);
    EXPECT_LT(inverse[0], 0.05);
    for (std::size_t i = 1; i < 256; ++i) ASSERT_GT(inverse[i], inverse[i - 1]);
  }
  const auto eight_bits = inverse_response(photographing_sensor(8));
  EXPECT_EQ(eight_bits[0], 0.0);
  // IEC 61966-2-1: the middle value stands for 21.6 % of the light.
  EXPECT_NEAR(eight_bits[128] / 255.0, 0.2159, 1e-4);
}

TEST(PhotometricCalibration, VignetteIsFlatWithoutOneAndWhiteAtItsBrightest) {
  const CameraModel camera = small_camera(160, 120);
  SensorModel model = photographing_sensor(8);
  const Image16 map = vignette_map(model, camera);
  EXPECT_EQ(*std::max_element(map.data.begin(), map.data.end()), 65535);
  EXPECT_NEAR(map.at(0, 0) / 65535.0, 1.0 - 0.35 + 0.1 - 0.05, 0.01) << "half the diagonal off";
  model.vignette.reset();
  for (const std::uint16_t value : vignette_map(model, camera).data) ASSERT_EQ(value, 65535);
}

TEST(PhotometricCalibration, PcalibHoldsOneLineOf256GrowingNumbers) {
  const testing::TemporaryFolder folder;
  const auto file = folder.path() / "pcalib.txt";
  ASSERT_TRUE(write_pcalib(file, photographing_sensor(8)));
  const std::string text = testing::read_text(file);
  EXPECT_EQ(text.find('\n'), text.size() - 1);
  std::istringstream numbers(text);
  const auto expected = inverse_response(photographing_sensor(8));
  for (const double value : expected) {
    double read = -1.0;
    ASSERT_TRUE(numbers >> read);
    EXPECT_NEAR(read, value, 1e-6);
  }
  double more = 0.0;
  EXPECT_FALSE(numbers >> more);
}

TEST(PhotometricCalibration, NamesTheFileThatCannotBeWritten) {
  const Status status = write_pcalib("/nowhere/pcalib.txt", photographing_sensor(8));
  ASSERT_FALSE(status);
  EXPECT_EQ(status.error().code, ErrorCode::kIo);
  EXPECT_NE(status.error().message.find("/nowhere/pcalib.txt"), std::string::npos);
}

}  // namespace
}  // namespace overfly::sensor
