// The vehicle's side of MAVLink's parameter protocol.
#pragma once

#include "core/result.hpp"
#include "flight/autopilot/parameters.hpp"
#include "flight/mavlink/frame.hpp"
#include "flight/vehicle/send.hpp"

namespace overfly::vehicle {

/// Holds the autopilot's parameters. Values are floats; one that is out of its limits is refused:
/// the answer then has the old value, as ground stations expect.
class ParameterStore {
 public:
  ParameterStore(std::uint8_t system, const autopilot::Parameters& values)
      : system_(system), values_(values) {}

  enum class Outcome { kNotMine, kAnswered, kChanged, kRefused };
  /// Takes the messages of the protocol. `refusal` is set with kRefused.
  [[nodiscard]] Outcome take(const flight::mavlink::Frame& frame,
                             const Send& send,
                             std::string& refusal);

  [[nodiscard]] const autopilot::Parameters& values() const { return values_; }

 private:
  void answer(std::size_t index, std::uint8_t system, const Send& send) const;
  [[nodiscard]] Outcome set(const flight::mavlink::Frame& frame,
                            const Send& send,
                            std::string& refusal);

  std::uint8_t system_;
  autopilot::Parameters values_;
};

}  // namespace overfly::vehicle
