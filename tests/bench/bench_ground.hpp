// The ground that a benchmark of a renderer draws.
#pragma once

#include <cstdio>
#include <memory>

#include "terrain/world.hpp"
#include "tests/renderer/procedural_ground.hpp"

namespace overfly::testing {

/// The world of a manifest, where the first argument names one, or painted hills; null, with a
/// message, where it cannot be opened.
inline std::shared_ptr<const terrain::TileSource> bench_ground(int argc, char** argv) {
  if (argc < 2 || argv[1][0] == '-') return natural_ground();
  const auto spec = terrain::read_world_manifest(argv[1]);
  const auto world = spec.ok() ? terrain::open_world(*spec) : spec.error();
  if (world.ok()) return world->tiles;
  std::fprintf(stderr, "%s\n", world.error().message.c_str());
  return nullptr;
}

}  // namespace overfly::testing
