// How a run comes by its renderer.
#pragma once

#include <functional>
#include <memory>

#include "core/result.hpp"
#include "renderer/renderer.hpp"
#include "server/scenario/scenario.hpp"

namespace overfly::engine {

/// Makes the renderer of a run, on the run's thread.
using RendererFactory = std::function<Result<std::unique_ptr<renderer::Renderer>>(
    std::shared_ptr<const terrain::TileSource>)>;

/// The factory's renderer; where it is empty, the one that the scenario asks for.
/// Errors: as the factory's; kUnsupported when the scenario's renderer does not work here.
[[nodiscard]] Result<std::unique_ptr<renderer::Renderer>> make_renderer(
    const Scenario& scenario,
    const std::shared_ptr<const terrain::TileSource>& tiles,
    const RendererFactory& factory);

}  // namespace overfly::engine
