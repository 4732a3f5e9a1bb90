// Which changes of a scenario leave its pictures as they are.
#include "server/experiments/pictures/picture_key.hpp"

#include <gtest/gtest.h>

#include "tests/server/support/server_fixture.hpp"

namespace overfly::server::experiments {
namespace {

using server::testing::small_scenario;

std::string camera_with(const std::string& sensor) {
  return R"(camera={"width_px":160,"height_px":120,"rate_hz":10,"sensor":{)" + sensor + "}}";
}

std::string key_of(const std::vector<std::string>& fields) {
  return picture_key(small_scenario(fields));
}

TEST(PictureKey, LeavesOutWhatActsAfterTheLight) {
  const std::string plain = key_of({});
  EXPECT_EQ(key_of({"seed=2"}), plain);
  EXPECT_EQ(key_of({"title=another"}), plain);
  EXPECT_EQ(key_of({R"(estimators=[{"name":"p","type":"perfect"}])"}), plain);
  EXPECT_EQ(key_of({R"(sensors={"imu":{}})"}), plain);
  EXPECT_EQ(key_of({R"(faults=[{"kind":"dirt","at_s":0.3}])"}), plain);
  EXPECT_EQ(key_of({"recording.frames=true"}), plain);
  EXPECT_EQ(key_of({"camera.calibrated=true"}), plain);
  const std::string light = key_of({camera_with("")});
  EXPECT_NE(light, plain);
  EXPECT_EQ(key_of({camera_with(R"("shot_noise":true,"read_noise_e":9,"prnu":0.1,"dsnu_e":2)")}),
            light);
  EXPECT_EQ(key_of({camera_with(R"("exposure_ms":5,"vignette":[-0.1,0,0],"defocus_sigma_px":2)")}),
            light);
  EXPECT_EQ(key_of({camera_with(R"("auto_exposure":{},"shot_noise":true)"), "seed=5"}), light);
}

TEST(PictureKey, CountsWhatActsOnTheLight) {
  const std::string plain = key_of({});
  for (const char* field : {"flight.course.height_agl_m=200",
                            "flight.course.airspeed_m_s=20",
                            "start_s=0.5",
                            "camera.fov_deg=60",
                            "camera.quality=reference",
                            "camera.mount.pitch_deg=10",
                            R"(camera.atmosphere={"visibility_km":5})",
                            "detail={}",
                            R"(light={"sun_azimuth_deg":90,"sun_elevation_deg":30})",
                            "renderer.camera=egl"}) {
    EXPECT_NE(key_of({field}), plain) << field;
  }
  const std::string light = key_of({camera_with("")});
  EXPECT_NE(key_of({camera_with(R"("readout_ms":10)")}), light);
  const std::string blurred = key_of({camera_with(R"("motion_blur":true,"exposure_ms":5)")});
  EXPECT_NE(blurred, light);
  EXPECT_NE(key_of({camera_with(R"("motion_blur":true,"exposure_ms":6)")}), blurred);
  EXPECT_EQ(
      key_of({camera_with(R"("motion_blur":true,"exposure_ms":5,"shot_noise":true)"), "seed=3"}),
      blurred);
}

TEST(PictureKey, CountsTheSeedWhereItActsOnTheLight) {
  const std::vector<std::string> with[] = {
      {R"(flight={"course":{"length_m":800,"leg_length_m":300,"dynamics":"piper_cub_third","turbulence":"light"}})"},
      {R"(camera.vibration={"noise_rotation_rms_mrad":[1,1,1]})"},
      {camera_with(R"("motion_blur":true,"auto_exposure":{},"shot_noise":true)")}};
  for (std::vector<std::string> fields : with) {
    const std::string first = key_of(fields);
    fields.emplace_back("seed=2");
    EXPECT_NE(key_of(fields), first) << fields.front();
  }
  // The exposure follows from images without noise.
  const std::string calm = camera_with(R"("motion_blur":true,"auto_exposure":{})");
  EXPECT_EQ(key_of({calm}), key_of({calm, "seed=2"}));
  // It follows from the fault too.
  EXPECT_NE(key_of({calm}), key_of({calm, R"(faults=[{"kind":"dirt","at_s":0.3}])"}));
}

}  // namespace
}  // namespace overfly::server::experiments
