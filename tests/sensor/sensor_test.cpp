// The image chain stage by stage.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "core/motion/pose.hpp"
#include "sensor/defocus.hpp"
#include "tests/sensor/flat_field.hpp"

namespace overfly::sensor {
namespace {

using testing::flat_field;
using testing::moments_of;
using testing::sensor_of;
using testing::small_camera;
using testing::values_of;

SensorModel enabled_sensor() {
  SensorModel model;
  model.enabled = true;
  return model;
}

SensorModel linear_sensor(int bits) {
  SensorModel model = enabled_sensor();
  model.bits = bits;
  model.response = ResponseCurve::linear();
  return model;
}

/// A ramp from 0 to a little above 1 along x.
RadianceImage ramp(int width, int height, int channels = 1) {
  RadianceImage image(width, height, channels);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      for (int c = 0; c < channels; ++c) {
        image.at(x, y, c) = 1.05F * static_cast<float>(x) / static_cast<float>(width - 1);
      }
    }
  }
  return image;
}

/// Everything at once.
SensorModel busy_sensor() {
  SensorModel model = enabled_sensor();
  model.vignette = Vignette{{-0.3, 0.1, -0.05}};
  model.shot_noise = true;
  model.read_noise_e = 6.0;
  model.full_well_e = 9000.0;
  model.prnu = 0.01;
  model.dsnu_e = 2.0;
  model.black_level_dn = 3.0;
  return model;
}

TEST(Sensor, WithoutAStageReturnsTheImagerysNumbers) {
  // Every 8-bit sRGB value, linearised as IEC 61966-2-1 says.
  RadianceImage light(256, 4, 3);
  for (int x = 0; x < 256; ++x) {
    const double encoded = x / 255.0;
    const double linear =
        encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
    for (int y = 0; y < 4; ++y) {
      for (int c = 0; c < 3; ++c) light.at(x, y, c) = static_cast<float>(linear);
    }
  }
  const SensorImage made = sensor_of(enabled_sensor(), small_camera(256, 4))->expose(light, 0);
  EXPECT_EQ(made.image.channels, 3);
  EXPECT_TRUE(made.image16.empty());
  for (int x = 0; x < 256; ++x) {
    // Twelve bits of the converter resolve the darkest value (1/3295 of full scale) to a number.
    EXPECT_NEAR(made.image.at(x, 2, 1), x, x < 16 ? 1 : 0) << x;
  }
}

TEST(Sensor, QuantisesToTheNearestNumberOfEachDepth) {
  for (const int bits : {8, 10, 12, 16}) {
    const SensorImage made =
        sensor_of(linear_sensor(bits), small_camera(700, 3))->expose(ramp(700, 3), 0);
    const int largest = (1 << bits) - 1;
    for (int x = 0; x < 700; ++x) {
      const double ideal = std::min(1.05 * x / 699.0, 1.0) * largest;
      const int number = bits == 8 ? made.image.at(x, 1) : made.image16.at(x, 1);
      // Half a number, and the resolution of a float of that size.
      ASSERT_NEAR(number, ideal, 0.5 + 2e-7 * largest) << bits << " bit, x " << x;
      ASSERT_EQ(made.image.at(x, 1), number >> (bits - 8));
    }
    EXPECT_EQ(made.image16.empty(), bits == 8);
  }
}

TEST(Sensor, ReportsMeanLevelAndSaturation) {
  const SensorImage made =
      sensor_of(linear_sensor(12), small_camera(1000, 2))->expose(ramp(1000, 2), 0);
  // 1.05 x / 999 rounds to full scale from 4094.5 / 4095 on: x >= 951.4.
  EXPECT_NEAR(made.saturated_fraction, 48.0 / 1000.0, 1e-9);
  const double mean = moments_of(values_of(made.image16)).mean / 4095.0;
  EXPECT_NEAR(made.mean_level, mean, 1e-12);
}

TEST(Sensor, SameBytesWithAllVectorUnits) {
  // 1003 is no multiple of any chunk; radiances from deep shade to beyond the full well.
  for (const int channels : {1, 3}) {
    for (const double brightness : {1.0, 0.002}) {
      const CameraModel camera = small_camera(1003, 37);
      RadianceImage light = ramp(1003, 37, channels);
      for (float& value : light.data) value *= static_cast<float>(brightness);
      const auto scalar = sensor_of(busy_sensor(), camera, 9, VectorUnits::kNone);
      const SensorImage expected = scalar->expose(light, 5);
      for (const auto units : {VectorUnits::kBest, VectorUnits::kAvx2, VectorUnits::kAvx512}) {
        if (!supported(units)) continue;
        const SensorImage made = sensor_of(busy_sensor(), camera, 9, units)->expose(light, 5);
        EXPECT_EQ(made.image.data, expected.image.data) << static_cast<int>(units);
        EXPECT_EQ(made.mean_level, expected.mean_level);
        EXPECT_EQ(made.saturated_fraction, expected.saturated_fraction);
      }
    }
  }
}

TEST(Sensor, SameSeedAndFrameGiveTheSameBytesInAnyOrder) {
  const CameraModel camera = small_camera(320, 240);
  const RadianceImage light = ramp(320, 240);
  const auto first = sensor_of(busy_sensor(), camera, 21);
  const auto second = sensor_of(busy_sensor(), camera, 21);
  const Image three = first->expose(light, 3).image;
  const Image four = first->expose(light, 4).image;
  EXPECT_EQ(second->expose(light, 4).image.data, four.data);
  EXPECT_EQ(second->expose(light, 3).image.data, three.data);
  EXPECT_NE(three.data, four.data);
  EXPECT_NE(sensor_of(busy_sensor(), camera, 22)->expose(light, 3).image.data, three.data);
}

TEST(Sensor, ColoursHaveNoiseOfTheirOwn) {
  SensorModel model = linear_sensor(12);
  model.read_noise_e = 50.0;
  const SensorImage made =
      sensor_of(model, small_camera(400, 300))->expose(flat_field(400, 300, 0.5F, 3), 0);
  std::array<std::vector<double>, 3> colours;
  const std::vector<double> all = values_of(made.image16);
  for (std::size_t i = 0; i < all.size(); ++i) colours[i % 3].push_back(all[i]);
  const double bound = 5.0 / std::sqrt(400.0 * 300.0);
  EXPECT_NEAR(testing::correlation(colours[0], colours[1]), 0.0, bound);
  EXPECT_NEAR(testing::correlation(colours[1], colours[2]), 0.0, bound);
  const double sigma_dn = 50.0 * model.effective_gain_dn_per_e();
  for (const auto& colour : colours) {
    EXPECT_NEAR(std::sqrt(moments_of(colour).variance), sigma_dn, 0.01 * sigma_dn + 0.01);
  }
}

TEST(Sensor, VignetteDarkensByItsPolynomial) {
  SensorModel model = linear_sensor(16);
  model.vignette = Vignette{{-0.4, 0.1, -0.02}};
  const CameraModel camera = small_camera(640, 480);
  const SensorImage made = sensor_of(model, camera)->expose(flat_field(640, 480, 0.8F), 0);
  for (const auto& [x, y] : {std::pair{0, 0}, {639, 479}, {320, 240}, {100, 400}}) {
    const double dx = x - camera.pinhole().cx_px;
    const double dy = y - camera.pinhole().cy_px;
    const double q = (dx * dx + dy * dy) / (400.0 * 400.0);
    const double transmission = 1.0 - 0.4 * q + 0.1 * q * q - 0.02 * q * q * q;
    EXPECT_NEAR(made.image16.at(x, y), 0.8 * 65535.0 * transmission, 1.0);
  }
}

TEST(Sensor, DefocusSpreadsAPointAsAGaussian) {
  SensorModel model = linear_sensor(16);
  model.defocus_sigma_px = 2.0;
  RadianceImage point = flat_field(81, 61, 0.0F);
  point.at(40, 30) = 20.0F;
  const SensorImage made = sensor_of(model, small_camera(81, 61))->expose(point, 0);
  for (const auto& [dx, dy] : {std::pair{0, 0}, {2, 0}, {0, 2}, {3, -4}, {-5, 1}}) {
    const double expected = 20.0 / (2.0 * kPi * 4.0) * std::exp(-(dx * dx + dy * dy) / 8.0);
    EXPECT_NEAR(made.image16.at(40 + dx, 30 + dy) / 65535.0, expected, 2e-4);
  }
}

TEST(Sensor, DefocusKeepsEvenLightUpToTheEdges) {
  const RadianceImage even = flat_field(50, 40, 0.3F, 3);
  for (const float value : defocused(even, 3.3).data) ASSERT_NEAR(value, 0.3F, 1e-6F);
}

TEST(Sensor, BlackLevelIsAddedToTheNumbers) {
  SensorModel model = linear_sensor(12);
  model.black_level_dn = 64.0;
  const auto sensor = sensor_of(model, small_camera(8, 8));
  EXPECT_EQ(sensor->expose(flat_field(8, 8, 0.0F), 0).image16.at(3, 3), 64);
  EXPECT_EQ(sensor->expose(flat_field(8, 8, 1.0F), 0).image16.at(3, 3), 4095);
}

TEST(Sensor, ResponseIsUndoneByItsInverse) {
  ResponseCurve gamma{ResponseShape::kGamma, 2.2, {}};
  ResponseCurve table{ResponseShape::kTable, 1.0, {0.0, 0.3, 0.5, 0.8, 1.0}};
  for (const ResponseCurve& curve : {ResponseCurve{}, gamma, table, ResponseCurve::linear()}) {
    EXPECT_EQ(curve(0.0), 0.0);
    EXPECT_NEAR(curve(1.0), 1.0, 1e-15);
    double before = -1.0;
    for (int i = 0; i <= 1000; ++i) {
      const double input = i / 1000.0;
      EXPECT_NEAR(curve.inverse(curve(input)), input, 1e-7) << to_string(curve.shape) << input;
      EXPECT_GT(curve(input), before);
      before = curve(input);
    }
  }
  EXPECT_NEAR(gamma(0.25), std::pow(0.25, 1.0 / 2.2), 1e-15);
  EXPECT_NEAR(table(0.375), 0.4, 1e-15);
  // IEC 61966-2-1: 18 % grey is 118 of 255.
  EXPECT_NEAR(255.0 * ResponseCurve{}(0.18), 117.6, 0.1);
}

TEST(Sensor, ResponseActsOnTheConvertersNumbers) {
  SensorModel model = enabled_sensor();
  model.response = {ResponseShape::kTable, 1.0, {0.0, 0.7, 1.0}};
  model.adc_bits = 10;
  const SensorImage made = sensor_of(model, small_camera(61, 2))->expose(ramp(61, 2), 0);
  // 61 columns: none falls on the border between two numbers, where a float decides.
  for (int x = 0; x < 61; ++x) {
    const double number = std::round(std::min(1.05 * x / 60.0, 1.0) * 1023.0) / 1023.0;
    const double expected = number < 0.5 ? 1.4 * number : 0.7 + 0.6 * (number - 0.5);
    EXPECT_NEAR(made.image.at(x, 0), expected * 255.0, 0.51) << x;
  }
}

TEST(Sensor, DefaultsExposeTypicalAerialImageryWell) {
  // Linear means of aerial photographs are 0.1 to 0.2.
  SensorModel model = enabled_sensor();
  model.shot_noise = true;
  model.read_noise_e = 10.0;
  const auto sensor = sensor_of(model, small_camera(320, 240));
  for (const float radiance : {0.1F, 0.2F}) {
    const SensorImage made = sensor->expose(flat_field(320, 240, radiance), 0);
    const double mean = moments_of(values_of(made.image)).mean;
    EXPECT_GT(mean, 80.0);
    EXPECT_LT(mean, 130.0);
    EXPECT_EQ(made.saturated_fraction, 0.0);
  }
}

TEST(Sensor, ModelsOutsideTheirLimitsAreNamed) {
  const auto message_of = [](const std::function<void(SensorModel&)>& change) {
    SensorModel model = enabled_sensor();
    change(model);
    const auto sensor = Sensor::create(model, small_camera(64, 48), 1);
    return sensor.ok() ? std::string() : sensor.error().message;
  };
  EXPECT_EQ(message_of([](SensorModel&) {}), "");
  EXPECT_EQ(message_of([](SensorModel& m) { m.bits = 7; }), "sensor: bits = 7: must be in [8, 16]");
  const std::vector<std::pair<std::string, std::function<void(SensorModel&)>>> bad = {
      {"exposure_s", [](SensorModel& m) { m.exposure_s = 0.0; }},
      {"exposure_s", [](SensorModel& m) { m.exposure_s = std::nan(""); }},
      {"readout_s", [](SensorModel& m) { m.readout_s = -1.0; }},
      {"defocus_sigma_px", [](SensorModel& m) { m.defocus_sigma_px = 51.0; }},
      {"electrons_per_s", [](SensorModel& m) { m.electrons_per_s = 0.0; }},
      {"full_well_e", [](SensorModel& m) { m.full_well_e = -5.0; }},
      {"read_noise_e", [](SensorModel& m) { m.read_noise_e = -0.1; }},
      {"gain_dn_per_e", [](SensorModel& m) { m.gain_dn_per_e = -1.0; }},
      {"adc_bits", [](SensorModel& m) { m.bits = 12, m.adc_bits = 10; }},
      {"black_level_dn", [](SensorModel& m) { m.black_level_dn = 128.0; }},
      {"prnu", [](SensorModel& m) { m.prnu = 0.6; }},
      {"dsnu_e", [](SensorModel& m) { m.dsnu_e = -1.0; }},
      {"response.gamma",
       [](SensorModel& m) {
         m.response = {ResponseShape::kGamma, 0.0, {}};
       }},
      {"response.table",
       [](SensorModel& m) {
         m.response = {ResponseShape::kTable, 1.0, {0.0}};
       }},
      {"response.table",
       [](SensorModel& m) {
         m.response = {ResponseShape::kTable, 1.0, {0.0, 0.6, 0.6, 1.0}};
       }},
      {"response.table",
       [](SensorModel& m) {
         m.response = {ResponseShape::kTable, 1.0, {0.1, 1.0}};
       }},
      {"vignette",
       [](SensorModel& m) {
         m.vignette = Vignette{{-1.2, 0.0, 0.0}};
       }},
      {"vignette",
       [](SensorModel& m) {
         m.vignette = Vignette{{0.1, 0.0, 0.0}};
       }},
      {"vignette",
       [](SensorModel& m) {
         m.vignette = Vignette{{std::nan(""), 0.0, 0.0}};
       }},
      {"auto_exposure.target_mean",
       [](SensorModel& m) { m.auto_exposure.emplace().target_mean = 1.0; }},
      {"auto_exposure.max_exposure_s",
       [](SensorModel& m) { m.auto_exposure.emplace().max_exposure_s = 1e-6; }},
      {"auto_exposure.settle_frames",
       [](SensorModel& m) { m.auto_exposure.emplace().settle_frames = 3; }},
  };
  for (const auto& [field, change] : bad) {
    EXPECT_NE(message_of(change).find(field), std::string::npos) << field << message_of(change);
  }
}

}  // namespace
}  // namespace overfly::sensor
