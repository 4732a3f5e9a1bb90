// DSO's settings and its camera: globals of its library. C++11.
#pragma once

#include "vo_bridges/adapters/upstream_system.hpp"

namespace overfly_adapters {

/// Writes the session's parameters, then the camera, into DSO's globals. Throws std::runtime_error
/// for what DSO does not take, or takes for something else.
void write_dso_settings(const Session& session);
void set_dso_camera(const AdapterCamera& camera);

/// What stands in the globals now, photometric mode and camera included.
ParameterValues read_dso_settings();

}  // namespace overfly_adapters
