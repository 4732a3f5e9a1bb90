// Creates the renderer of a run.
#pragma once

#include <functional>
#include <memory>

#include "core/result.hpp"
#include "renderer/renderer.hpp"
#include "server/scenario/scenario.hpp"

namespace overfly::server {

/// Creates a run's renderer; called on the run's thread.
using RendererFactory = std::function<Result<std::unique_ptr<renderer::Renderer>>(
    std::shared_ptr<const terrain::TileSource>)>;

/// The factory's renderer, or the one that the scenario asks for if the factory is empty.
/// @param options  without what the scenario tells; not for the factory's renderer
/// Errors: as the factory's; kUnsupported if the scenario's renderer does not work on this machine.
[[nodiscard]] Result<std::unique_ptr<renderer::Renderer>> make_renderer(
    const Scenario& scenario,
    const std::shared_ptr<const terrain::TileSource>& tiles,
    const RendererFactory& factory,
    renderer::RendererOptions options = {});

}  // namespace overfly::server
