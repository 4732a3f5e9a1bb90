// Which ground is read ahead for a viewer.
#include "server/views/view_renderers.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <future>

#include "terrain/decoration/tile_decorator.hpp"
#include "terrain/height_errors.hpp"
#include "terrain/world.hpp"
#include "tests/server/support/manager_fixture.hpp"
#include "tests/support/synthetic_world.hpp"

namespace overfly::server {
namespace {

/// Tiles of whose elevation files one turns out to be damaged when the test says so.
class DamagedTiles final : public terrain::TileDecorator {
 public:
  using TileDecorator::TileDecorator;
  std::atomic<bool> damaged = false;
  [[nodiscard]] double ground_up_m(double east_m, double north_m) const override {
    if (damaged) terrain::HeightErrors::add({ErrorCode::kIo, "elevation.tif: cannot be read"});
    return base().ground_up_m(east_m, north_m);
  }

 private:
  [[nodiscard]] Result<terrain::Tile> read_tile(
      const terrain::TileId& id, const terrain::Cancelled& cancelled) const override {
    return base().tile(id, cancelled);
  }
};

class ViewRenderersTest : public testing::ManagerTest {
 protected:
  /// A manager with real renderers and a scenario over a small world.
  std::unique_ptr<RunManager> manager_over_ground() {
    overfly::testing::SyntheticWorldOptions small;
    small.size_m = 400.0;
    const terrain::WorldSpec world = overfly::testing::write_synthetic_world(root(), small);
    nlohmann::json document = testing::small_document();
    document["name"] = "small";
    document["world"] = {{"imagery", {{{"file", world.imagery.front().file.string()}}}},
                         {"ground_height_m", 200}};
    overfly::testing::write_text(root() / "scenarios" / "small.json", document.dump());
    RunManagerOptions real = options();
    real.renderer_factory = nullptr;
    return std::move(RunManager::create(real).value());
  }

  /// The run's view once its world has been opened.
  ViewRenderers::WorldView& view_of(const std::string& id) {
    while (true) {
      std::future<void> opened;
      {
        const std::lock_guard lock(mutex_);
        opened_ = {};
        opened = opened_.get_future();
      }
      const auto view = renderers_.of_run(id);
      if (!view) throw std::runtime_error(view.error().message);
      if (*view != nullptr) return **view;
      opened.wait();
    }
  }
  static std::int64_t read_ahead(const ViewRenderers::WorldView& view) {
    view.tiles->wait_until_idle();
    return view.tiles->counts().read_ahead;
  }

  std::unique_ptr<RunManager> runs_ = manager_over_ground();
  std::vector<std::shared_ptr<DamagedTiles>> worlds_;  ///< in the order in which they were opened

 private:
  std::mutex mutex_;
  std::promise<void> opened_;
  std::atomic<bool> stopping_ = false;
  WorldOpener opener_{
      {[this](const std::string& id,
              const std::function<bool()>& cancelled) -> Result<WorldOpener::World> {
         const auto world = runs_->world_of(id, cancelled);
         if (!world) return world.error();
         auto own = std::make_shared<terrain::World>(**world);
         worlds_.push_back(std::make_shared<DamagedTiles>(own->tiles));
         own->tiles = worlds_.back();
         return WorldOpener::World(own);
       },
       [this] {
         const std::lock_guard lock(mutex_);
         opened_.set_value();
       },
       [] { return ThreadPriority::kBelowFlights; }}};

 protected:
  ViewRenderers renderers_{*runs_, opener_, stopping_};
};

TEST_F(ViewRenderersTest, GroundBelowADamagedWorldIsNotReadAheadAgain) {
  const std::string id = fly(*runs_);
  EXPECT_GT(read_ahead(view_of(id)), 0);
  ASSERT_EQ(worlds_.size(), 1U);
  const std::int64_t read = read_ahead(view_of(id));
  EXPECT_GT(read, 0) << "the same view";
  ASSERT_EQ(worlds_.size(), 1U);
  worlds_.front()->damaged = true;
  EXPECT_EQ(read_ahead(view_of(id)), read) << "nothing of the damaged file was asked for";
  (void)view_of(id).tiles->tiles().ground_up_m(0.0, 0.0);
  // Opened again, for what pictures show only.
  EXPECT_EQ(read_ahead(view_of(id)), 0);
  ASSERT_EQ(worlds_.size(), 2U);
  EXPECT_TRUE(view_of(id).runs.front().scenes_expected);
  // Another run over these files is read ahead for.
  EXPECT_GT(read_ahead(view_of(fly(*runs_))), 0);
}

TEST_F(ViewRenderersTest, FilesOfADeletedRunAreClosed) {
  const std::string deleted = fly(*runs_);
  const std::string kept = fly(*runs_);
  for (const std::string& id : {deleted, kept}) {
    (void)view_of(id);
    ASSERT_TRUE(renderers_.frames_of(id).value());
  }
  ASSERT_TRUE(runs_->remove(deleted).ok());
  renderers_.drop_deleted();
  EXPECT_FALSE(view_of(deleted).runs.front().frames);
  EXPECT_TRUE(view_of(kept).runs.front().frames);
}

}  // namespace
}  // namespace overfly::server
