// The network of the geographic libraries.
#pragma once

namespace overfly::terrain {

/// Forbids GDAL and PROJ every address for the rest of the program, whatever the environment
/// says (PROJ_NETWORK): of a server, whose clients name data. Only `download_world` needs it.
/// @pre no other thread runs yet: it changes the environment
void turn_network_off();

}  // namespace overfly::terrain
