// Compiles only while no third-party type leaks out of its room: the public headers of all rooms
// are included, and none of the libraries' own macros may be visible after that.
#include "calibration/calibrator.hpp"
#include "evaluation/evaluation.hpp"
#include "flight/dynamics/aircraft.hpp"
#include "flight/dynamics/airframe_file.hpp"
#include "flight/dynamics/flight_speed.hpp"
#include "flight/dynamics/modes.hpp"
#include "flight/flight.hpp"
#include "odometry/feature/feature_odometry.hpp"
#include "renderer/renderer.hpp"
#include "server/net/server.hpp"
#include "server/runs/run_manager.hpp"
#include "server/views/view_service.hpp"
#include "terrain/synthesize.hpp"
#include "terrain/world.hpp"
#include "vo_bridges/toy/toy_estimators.hpp"

#if defined(GDAL_VERSION_MAJOR) || defined(PROJ_VERSION_MAJOR) || defined(CPLE_None)
#error "GDAL or PROJ leaks out of terrain"
#endif
#if defined(GL_TRUE) || defined(EGL_TRUE)
#error "OpenGL or EGL leaks out of the renderer"
#endif
#if defined(CV_VERSION) || defined(CERES_VERSION)
#error "OpenCV or Ceres leaks out of odometry or calibration"
#endif
#if defined(BOOST_VERSION) || defined(BOOST_BEAST_VERSION)
#error "Boost leaks out of server/net"
#endif
#if defined(GEOGRAPHICLIB_VERSION)
#error "GeographicLib leaks out of core"
#endif
#if defined(TJ_NUMSAMP) || defined(SPDLOG_VERSION) || defined(CLI11_VERSION)
#error "libjpeg-turbo, spdlog or CLI11 leaks out of its room"
#endif
