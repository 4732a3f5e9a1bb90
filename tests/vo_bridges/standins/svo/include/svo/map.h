#pragma once

#include <cstddef>

namespace svo {

class Map {
 public:
  std::size_t size() const { return keyframes; }
  std::size_t keyframes = 0;
};

}  // namespace svo
