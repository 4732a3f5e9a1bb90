// A run whose data files have changed since its flight: its info names them.
#include "server/worlds/world_change.hpp"
#include "server/record/run_info.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/server/support/manager_fixture.hpp"
#include "tests/support/synthetic_world.hpp"

namespace overfly::server {
namespace {

namespace fs = std::filesystem;
using overfly::testing::read_text;
using overfly::testing::write_text;
using ::testing::HasSubstr;

class WorldChangeTest : public testing::ManagerTest {
 protected:
  WorldChangeTest() {
    write_picture(1);
    write_text(
        world(),
        R"({"format_version": 1, "imagery": [{"file": "ortho.tif"}], "ground_height_m": 200})");
    nlohmann::json document = testing::small_document();
    document["name"] = "mapped";
    document["world"] = {{"manifest", world().string()}};
    write_text(root() / "scenarios" / "mapped.json", document.dump());
  }

  [[nodiscard]] fs::path world() const { return root() / "world.json"; }
  [[nodiscard]] fs::path picture() const { return root() / "ortho.tif"; }
  /// Writes a new file and renames it over the old one, as programs that make such files do.
  void write_picture(unsigned seed) const {
    overfly::testing::GeoTiff tiff;
    tiff.image = overfly::testing::textured_image(300, 300, 1, seed);
    tiff.left = 583000.0;
    tiff.top = 4357000.0;
    tiff.pixel = 2.0;
    write_geotiff(root() / "new.tif", tiff);
    fs::rename(root() / "new.tif", picture());
  }
  /// Flies with a manager that is destroyed afterwards, with its thread and its world.
  [[nodiscard]] std::string fly_mapped() const {
    const auto runs = manager();
    const std::string id = runs->start("mapped", perfect()).value().id;
    EXPECT_EQ(wait_for_end(*runs, id).status, RunStatus::kCompleted);
    return id;
  }
  /// The change that is reported in the run's info, by its time line and in the list.
  static std::string told(RunManager& runs, const std::string& id) {
    const auto world = runs.world_of(id);
    if (!world) return world.error().message;
    std::string change = runs.run(id).value().world_change;
    EXPECT_EQ(runs.timeline(id).value()->info().world_change, change);
    EXPECT_EQ(runs.runs().front()->world_change, change);
    return change;
  }
};

TEST_F(WorldChangeTest, NamesTheFilesUntilTheyAreAsTheyWere) {
  const std::string id = fly_mapped();
  const auto runs = manager();
  EXPECT_EQ(told(*runs, id), "");
  write_picture(2);
  EXPECT_EQ(told(*runs, id),
            picture().string() +
                " has changed since this run was flown: newly rendered pictures show the present "
                "terrain");
  const std::string manifest = read_text(world());
  write_text(
      world(),
      R"({"format_version": 1, "imagery": [{"file": "ortho.tif"}], "ground_height_m": 300})");
  EXPECT_THAT(told(*runs, id), HasSubstr(world().string() + " and 1 more have changed since"));
  write_text(world(), manifest);
  write_picture(1);
  EXPECT_EQ(told(*runs, id), "");
}

TEST_F(WorldChangeTest, IsToldToWhoeverWatches) {
  const std::string id = fly_mapped();
  const auto runs = manager();
  const auto timeline = runs->timeline(id).value();
  write_picture(2);
  const std::uint64_t seen = timeline->revision();
  ASSERT_TRUE(runs->world_of(id).ok());
  EXPECT_GT(timeline->revision(), seen);
  EXPECT_THAT(timeline->info().world_change, HasSubstr("ortho.tif has changed"));
}

TEST_F(WorldChangeTest, IsUnknownWhereTheManifestDoesNotTell) {
  for (const char* damage : {R"({"world": 3})", R"({"world": {"data_hashes": [1]}})", "{}", "["}) {
    write_text(root() / "manifest.json", damage);
    OpenedWorld opened;
    opened.world.data_hashes = {{"ortho.tif", "sha256:1"}};
    EXPECT_EQ(world_change(root(), opened), "") << damage;
  }
}

}  // namespace
}  // namespace overfly::server
