// Manifests of worlds.
#include "terrain/world.hpp"
#include "tests/fuzz/input_folder.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace overfly;
  const auto manifest =
      fuzz::InputFolder::of_process().file("world.json", fuzz::text_of(data, size));
  const auto spec = terrain::read_world_manifest(manifest);
  if (spec) (void)terrain::write_world_manifest(manifest, *spec);
  return 0;
}
