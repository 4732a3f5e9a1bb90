// A server of which every route is asked for, those of experiments and calibrations by functions of
// their own.
#pragma once

#include <string>

#include "tests/server/net/rest/documented_api.hpp"

namespace overfly::testing {

class RestApiTest : public DocumentedApi {
 protected:
  /// Every route of sweeps.
  void check_sweeps();
  /// Those that start sweeps.
  void check_sweep_starts();
  /// Every route of studies.
  void check_studies();
  /// Every route of calibrations.
  void check_calibrations();
  void wait_until_solved(const std::string& session);
};

}  // namespace overfly::testing
