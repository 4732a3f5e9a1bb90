// DSO's settings and its camera: globals of its library. C++11.
#pragma once

#include "vo_bridges/adapters/upstream_system.hpp"

namespace overfly_adapters {

/// Writes the session's parameters, then the camera, to DSO's globals. Throws std::runtime_error
/// for values that DSO does not accept or misinterprets.
void write_dso_settings(const Session& session);
void set_dso_camera(const AdapterCamera& camera);

/// The current values of the globals, including photometric mode and camera.
ParameterValues read_dso_settings();

}  // namespace overfly_adapters
