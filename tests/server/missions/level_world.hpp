// A world of level ground.
#pragma once

#include "terrain/world.hpp"
#include "tests/support/support.hpp"
#include "tests/support/synthetic_world.hpp"

namespace overfly::server::testing {

/// 4 km of imagery around the origin, the ground at height 200 m.
class LevelWorld {
 public:
  static constexpr double kTexelM = 4.0;

  LevelWorld() {
    overfly::testing::SyntheticWorldOptions options;
    options.size_m = 4000.0;
    options.texel_m = kTexelM;
    options.relief_m = 0.0;
    world_ = terrain::open_world(overfly::testing::write_synthetic_world(folder_.path(), options))
                 .value();
  }
  [[nodiscard]] const terrain::World& world() const { return world_; }

 private:
  overfly::testing::TemporaryFolder folder_;
  terrain::World world_;
};

}  // namespace overfly::server::testing
