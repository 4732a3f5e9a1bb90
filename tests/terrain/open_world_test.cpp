#include <gdal_priv.h>
#include <gtest/gtest.h>
#include <ogr_spatialref.h>
#include <proj.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <memory>

#include "core/pose.hpp"
#include "terrain/world.hpp"
#include "tests/support/support.hpp"
#include "tests/support/synthetic_world.hpp"

namespace overfly::terrain {
namespace {

using testing::TemporaryFolder;

TEST(OpenWorld, DISABLED_Try) {
  TemporaryFolder folder;
  auto t0 = std::chrono::steady_clock::now();
  auto since = [&] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - t0).count();
  };
  const WorldSpec synthetic = testing::write_synthetic_world(folder.path());
  printf("write %.3f\n", since());
  auto world = open_world(synthetic);
  printf("open %.3f\n", since());
  ASSERT_TRUE(world) << world.error().message;
  printf("%s", describe(*world).c_str());
  for (const char* set : {"autzen", "autzen_ft", "goleta", "mcmillan", "hgt", "dem"}) {
    std::string name = set;
    WorldSpec spec;
    auto img = [&](const char* f) { spec.imagery.push_back({*testing::shared_data(f), "", {}}); };
    auto ele = [&](const char* f, VerticalDatum d) {
      ElevationLayer e;
      e.file = *testing::shared_data(f);
      e.datum = d;
      spec.elevation.push_back(e);
    };
    if (name == "autzen") {
      img("terrain/autzen/ortho_0.3m_utm10.tif");
      ele("terrain/autzen/dtm_3m_utm10.tif", VerticalDatum::kNavd88);
    } else if (name == "autzen_ft") {
      img("terrain/autzen/ortho_epsg2994_ft.tif");
      ele("terrain/autzen/dtm_3m_utm10.tif", VerticalDatum::kNavd88);
    } else if (name == "goleta") {
      img("terrain/goleta/ortho_epsg4326.tif");
      ele("terrain/goleta/elevation_epsg4326.tif", VerticalDatum::kEgm96);
    } else if (name == "mcmillan") {
      img("terrain/mcmillan/ortho_0.8m_utm10.tif");
      spec.ground_height_m = 250;
    } else {
      continue;
    }
    t0 = std::chrono::steady_clock::now();
    auto w = open_world(spec);
    printf("== %s open %.3f\n", set, since());
    ASSERT_TRUE(w) << w.error().message;
    printf("%s", describe(*w).c_str());
    for (int level = 0; level < w->tiles->grid().levels; ++level) {
      t0 = std::chrono::steady_clock::now();
      auto tile = w->tiles->tile({level, 0, 0});
      ASSERT_TRUE(tile);
      printf("level %d tile %.4f cov %d\n", level, since(),
             (int)w->tiles->coverage({level, 0, 0}));
    }
    t0 = std::chrono::steady_clock::now();
    for (int c = 0; c < std::min(3, w->tiles->grid().cols); ++c)
      (void)w->tiles->tile({0, c, 1}).ok();
    printf("3 tiles %.4f\n", since());
    t0 = std::chrono::steady_clock::now();
    double s = 0;
    for (int i = 0; i < 100000; ++i)
      s += w->tiles->world_from_map(w->tiles->grid().left_x_m + i % 1000,
                                    w->tiles->grid().top_y_m - i % 777)
               .z();
    printf("1e5 world_from_map %.4f\n", since());
    t0 = std::chrono::steady_clock::now();
    for (int i = 0; i < 100000; ++i) s += w->tiles->ground_up_m(i % 1000, i % 777);
    printf("1e5 ground_up %.4f  %g\n", since(), s);
  }
}

}  // namespace
}  // namespace overfly::terrain
