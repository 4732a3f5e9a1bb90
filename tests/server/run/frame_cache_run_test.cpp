// Flights with a frame cache: empty, warm, too small, damaged or absent, their folders are equal.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <thread>

#include "server/files/whole_file.hpp"
#include "server/record/run_folder.hpp"
#include "server/run/run.hpp"
#include "tests/server/support/server_fixture.hpp"

namespace overfly::server {
namespace {

namespace fs = std::filesystem;
using testing::contents_without_timings;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

constexpr std::uint64_t kPlenty = std::uint64_t{1} << 30U;

struct CameraCase {
  const char* name;
  std::vector<std::string> fields;
  /// Pictures that a flight with another seed finds, of 21 for each camera.
  int found_with_other_seed;
};

std::ostream& operator<<(std::ostream& out, const CameraCase& tested) { return out << tested.name; }

constexpr const char* kIdeal = R"(camera={"width_px":160,"height_px":120,"rate_hz":10})";
constexpr const char* kNoisy =
    R"(camera={"width_px":160,"height_px":120,"rate_hz":10,"sensor":{"exposure_ms":8,"readout_ms":20,
       "motion_blur":true,"shot_noise":true,"read_noise_e":20,"prnu":0.01,"dsnu_e":3,
       "vignette":[-0.2,0,0],"defocus_sigma_px":0.8}})";
constexpr const char* kAdaptive =
    R"(camera={"width_px":160,"height_px":120,"rate_hz":10,"sensor":{"exposure_ms":8,"shot_noise":true,
       "read_noise_e":20,"auto_exposure":{"max_exposure_ms":16}}})";
constexpr const char* kAdaptiveBlurred =
    R"(camera={"width_px":160,"height_px":120,"rate_hz":10,"sensor":{"exposure_ms":8,"readout_ms":20,
       "motion_blur":true,"shot_noise":true,"read_noise_e":20,"auto_exposure":{"max_exposure_ms":16}}})";
constexpr const char* kVibrating =
    R"(camera={"width_px":160,"height_px":120,"rate_hz":10,
       "vibration":{"noise_rotation_rms_mrad":[0.5,0.5,0.5]}})";
constexpr const char* kTwoDeepColours =
    R"(cameras=[{"name":"a","width_px":160,"height_px":120,"rate_hz":10,"color":"rgb"},
                {"name":"b","width_px":96,"height_px":64,"rate_hz":10,"color":"rgb","bits":12,
                 "sensor":{"shot_noise":true},"mount":{"pitch_deg":-60},
                 "atmosphere":{"visibility_km":2}}])";
constexpr const char* kTurbulence =
    R"(flight={"course":{"length_m":800,"leg_length_m":300,"dynamics":"piper_cub_third",
       "turbulence":"moderate"}})";
constexpr const char* kFaults =
    R"(faults=[{"kind":"dirt","at_s":0.3,"duration_s":1},{"kind":"frozen_frame","at_s":1.2,"duration_s":0.4},
               {"kind":"dropped_frames","at_s":0,"every":5}])";

const CameraCase kCases[] = {
    {"ideal", {kIdeal}, 21},
    {"noise, blur and rolling shutter", {kNoisy}, 21},
    {"auto-exposure", {kAdaptive}, 21},
    // The exposure of the first image is given; later ones follow from noisy images.
    {"auto-exposure with blur", {kAdaptiveBlurred}, 1},
    {"vibration", {kVibrating}, 0},
    {"two cameras in colour", {kTwoDeepColours}, 42},
    // At its start the aircraft is in trim.
    {"turbulence", {kIdeal, kTurbulence}, 1},
    {"faults", {kNoisy, kFaults}, 21}};

constexpr const char* kEstimators =
    R"(estimators=[{"name":"f","type":"feature"},{"name":"h","type":"baseline_hold"}])";

class FrameCacheRun : public ::testing::TestWithParam<CameraCase> {
 protected:
  struct Flown {
    std::vector<std::pair<std::string, std::string>> contents;
    nlohmann::json use;  ///< of the cache; null without
  };

  /// @param budget_bytes  empty: no cache
  Flown fly(const std::string& name,
            std::vector<std::string> fields,
            std::optional<std::uint64_t> budget_bytes) {
    for (const std::string& field : GetParam().fields) fields.insert(fields.begin(), field);
    if (std::none_of(fields.begin(), fields.end(), [](const std::string& field) {
          return field.starts_with("estimators");
        })) {
      fields.emplace_back(kEstimators);
    }
    fields.emplace_back(R"(recording={"frames":true})");
    RunOptions options = testing::options_for(folder_.path() / name);
    options.renderer_factory = [](std::shared_ptr<const terrain::TileSource> tiles) {
      renderer::RendererOptions renderer;
      renderer.threads = 1;
      return Result<std::unique_ptr<renderer::Renderer>>(
          renderer::create_raycast_renderer(std::move(tiles), renderer));
    };
    if (budget_bytes) options.frame_cache = {cache(), *budget_bytes, keep_since_ns_, 0};
    options.warn = [this](const std::string& text) {
      const std::lock_guard lock(mutex_);
      warnings_.push_back(text);
    };
    const auto run = run_scenario(testing::small_scenario(fields), options);
    EXPECT_TRUE(run.ok()) << run.error().message;
    const auto timings = read_json(timings_file(options.folder));
    return {contents_without_timings(options.folder),
            timings ? timings->value("frame_cache", nlohmann::json()) : nlohmann::json()};
  }

  static void expect_equal(const Flown& a, const Flown& b) {
    ASSERT_EQ(a.contents.size(), b.contents.size());
    for (std::size_t i = 0; i < a.contents.size(); ++i) {
      ASSERT_EQ(a.contents[i].first, b.contents[i].first);
      EXPECT_EQ(a.contents[i].second, b.contents[i].second) << a.contents[i].first << " differs";
    }
  }
  [[nodiscard]] static int pictures() {
    return GetParam().fields.front() == kTwoDeepColours ? 42 : 21;
  }
  [[nodiscard]] fs::path cache() const { return folder_.path() / "cache"; }
  [[nodiscard]] std::vector<fs::path> files() const {
    std::vector<fs::path> files;
    for (const auto& entry : fs::recursive_directory_iterator(cache())) {
      if (entry.path().extension() == ".frame") files.push_back(entry.path());
    }
    std::sort(files.begin(), files.end());
    return files;
  }

  overfly::testing::TemporaryFolder folder_;
  std::int64_t keep_since_ns_ = 0;
  std::mutex mutex_;
  std::vector<std::string> warnings_;
};

TEST_P(FrameCacheRun, EveryStateOfTheCacheGivesTheSameFolder) {
  const Flown without = fly("without", {}, std::nullopt);
  EXPECT_TRUE(without.use.is_null());
  const Flown empty = fly("empty", {}, kPlenty);
  EXPECT_EQ(empty.use.at("read"), 0);
  EXPECT_EQ(empty.use.at("rendered"), pictures());
  EXPECT_EQ(empty.use.at("added"), pictures());
  expect_equal(without, empty);

  const Flown warm = fly("warm", {}, kPlenty);
  EXPECT_EQ(warm.use.at("read"), pictures());
  EXPECT_EQ(warm.use.at("rendered"), 0);
  expect_equal(without, warm);

  const std::vector<fs::path> known = files();
  ASSERT_THAT(known, SizeIs(pictures()));
  for (std::size_t i = 0; i < known.size(); i += 2) {
    std::string bytes = overfly::testing::read_text(known[i]);
    bytes[bytes.size() * (i + 1) / (known.size() + 1)] ^= 4;
    overfly::testing::write_text(known[i], bytes);
  }
  EXPECT_THAT(warnings_, IsEmpty());
  const Flown damaged = fly("damaged", {}, kPlenty);
  EXPECT_EQ(damaged.use.at("damaged"), (pictures() + 1) / 2);
  EXPECT_EQ(damaged.use.at("read"), pictures() / 2);
  EXPECT_THAT(warnings_, SizeIs(1));
  expect_equal(without, damaged);
}

TEST_P(FrameCacheRun, ACacheSmallerThanTheFlightHelpsAsFarAsItGoes) {
  const Flown without = fly("without", {}, std::nullopt);
  (void)fly("all", {}, kPlenty);
  std::uint64_t all_bytes = 0;
  for (const fs::path& file : files()) all_bytes += fs::file_size(file);
  fs::remove_all(cache());
  const Flown first = fly("first", {}, all_bytes / 2);
  const Flown second = fly("second", {}, all_bytes / 2);
  EXPECT_GT(second.use.at("read").get<int>(), pictures() / 5);
  EXPECT_LT(second.use.at("read").get<int>(), pictures());
  std::uint64_t bytes = 0;
  for (const fs::path& file : files()) bytes += fs::file_size(file);
  EXPECT_LE(bytes, all_bytes / 2);
  expect_equal(without, first);
  expect_equal(without, second);
  EXPECT_THAT(warnings_, IsEmpty());
}

TEST_P(FrameCacheRun, OtherSeedsFindThePicturesThatAreTheirs) {
  (void)fly("first", {}, kPlenty);
  const Flown without = fly("without", {"seed=2"}, std::nullopt);
  const Flown with = fly("with", {"seed=2"}, kPlenty);
  EXPECT_EQ(with.use.at("read"), GetParam().found_with_other_seed);
  expect_equal(without, with);
  const Flown again = fly("again", {"seed=2"}, kPlenty);
  EXPECT_EQ(again.use.at("read"), pictures());
  expect_equal(without, again);
}

TEST_P(FrameCacheRun, OtherEstimatorsFindAllPictures) {
  (void)fly("first", {}, kPlenty);
  const std::string other =
      R"(estimators=[{"name":"f","type":"feature","parameters":{"features":300}}])";
  const Flown without = fly("without", {other}, std::nullopt);
  const Flown with = fly("with", {other}, kPlenty);
  EXPECT_EQ(with.use.at("read"), pictures());
  EXPECT_EQ(with.use.at("rendered"), 0);
  expect_equal(without, with);
}

TEST_P(FrameCacheRun, TwoFlightsAtOnceShareACache) {
  const Flown without = fly("without", {}, std::nullopt);
  Flown a, b;
  std::thread other([&] { a = fly("a", {}, kPlenty); });
  b = fly("b", {}, kPlenty);
  other.join();
  expect_equal(without, a);
  expect_equal(without, b);
  EXPECT_THAT(files(), SizeIs(pictures()));
  EXPECT_THAT(warnings_, IsEmpty());
}

INSTANTIATE_TEST_SUITE_P(
    Cameras, FrameCacheRun, ::testing::ValuesIn(kCases), [](const auto& tested) {
      std::string name = tested.param.name;
      std::erase_if(name, [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; });
      return name;
    });

TEST(FrameCacheOptions, FlightsInRealTimeHaveNoCache) {
  const overfly::testing::TemporaryFolder folder;
  RunOptions options = testing::options_for(folder.path() / "r");
  options.frame_cache = {folder.path() / "cache", kPlenty, 0, 0};
  const auto run =
      run_scenario(testing::small_scenario({"pacing=real_time", "duration_s=0.3"}), options);
  ASSERT_TRUE(run.ok()) << run.error().message;
  EXPECT_FALSE(fs::exists(folder.path() / "cache"));
  EXPECT_FALSE(read_json(timings_file(options.folder))->contains("frame_cache"));
}

}  // namespace
}  // namespace overfly::server
