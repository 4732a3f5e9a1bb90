// What sensors measure in addition to the aircraft's own motion: the earth where it flies.
#pragma once

#include <cstdint>
#include <memory>

#include "core/earth/geodesy.hpp"
#include "core/earth/height_query.hpp"
#include "core/earth/magnetic_field.hpp"

namespace overfly::flight {

struct SensorPlace {
  LocalFrame frame;  ///< the world frame
  std::shared_ptr<const HeightQuery> ground;
  std::shared_ptr<const MagneticField> magnetic_field;
};

}  // namespace overfly::flight
