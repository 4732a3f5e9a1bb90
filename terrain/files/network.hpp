// Network access of the geographic libraries.
#pragma once

namespace overfly::terrain {

/// Disables all network access of GDAL and PROJ for the rest of the program, regardless of the
/// environment (PROJ_NETWORK). Needed by a server, whose clients name data. Only `download_world`
/// uses the network.
/// @pre no other thread is running, since it changes the environment
void turn_network_off();

}  // namespace overfly::terrain
