// What decides a rendered picture before the sensor, as keys of the frame cache.
#pragma once

#include <string>

#include "renderer/renderer.hpp"
#include "server/scenario/scenario.hpp"
#include "server/worlds/scenario_world.hpp"

namespace overfly::server {

/// What the pictures of a run have in common: the program, the renderer, and the world with its
/// files, its light and its detail.
[[nodiscard]] std::string picture_context(const Scenario& scenario,
                                          const OpenedWorld& world,
                                          const renderer::RendererInfo& renderer);

/// Key of the picture that a request draws: SHA-256 in hexadecimal digits of the context and of all
/// that acts before the sensor: the camera, its motion while the shutter is open, exposure,
/// readout, pixel format, quality and air. Equal keys mean pictures that are equal to the bit.
[[nodiscard]] std::string frame_key(const std::string& context,
                                    const renderer::CameraRequest& request);

}  // namespace overfly::server
