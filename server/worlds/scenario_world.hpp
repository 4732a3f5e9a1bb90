// Opens the world of a scenario.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "server/scenario/scenario.hpp"
#include "terrain/world.hpp"
#include "terrain/world/world_files.hpp"

namespace overfly::server {

struct OpenedWorld {
  terrain::World world;
  struct Manifest {
    std::string file;
    std::string digest;  ///< in the format of terrain::World::data_hashes
  };
  std::optional<Manifest> manifest;  ///< empty if the scenario lists the layers itself
  /// The source files, with their state before the world was opened.
  std::vector<terrain::WorldFile> files;
};

/// Opens the scenario's world; makes the built-in one if this machine does not have it yet.
/// @param progress  called with the share done in [0, 1] while it is made, and with 0 while files
///                  are opened; returning false cancels
/// Errors: as terrain::open_world, read_world_manifest and builtin_world; kIo for a file that was
/// changed meanwhile.
[[nodiscard]] Result<OpenedWorld> open_scenario_world(
    const Scenario& scenario, const std::function<bool(double)>& progress = {});

/// The files of the scenario's layers, as terrain::world_files, and its manifest. Empty for the
/// built-in world, and if the files cannot be read or must not be: opening the world reports that.
[[nodiscard]] std::vector<terrain::WorldFile> scenario_world_files(const Scenario& scenario);

/// Whether the scenario's world is the built-in one and has to be made first.
[[nodiscard]] bool world_must_be_made(const Scenario& scenario);

/// Equal for scenarios with the same world.
[[nodiscard]] std::string world_key(const Scenario& scenario);

}  // namespace overfly::server
