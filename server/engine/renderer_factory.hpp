// How a run comes by its renderer.
#pragma once

#include <functional>
#include <memory>

#include "core/result.hpp"
#include "renderer/renderer.hpp"

namespace overfly::engine {

/// Makes the renderer of a run, on the run's thread.
using RendererFactory = std::function<Result<std::unique_ptr<renderer::Renderer>>(
    std::shared_ptr<const terrain::TileSource>)>;

}  // namespace overfly::engine
