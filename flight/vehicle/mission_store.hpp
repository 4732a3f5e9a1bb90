// The vehicle's side of MAVLink's mission protocol: upload, download, clearing.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "core/result.hpp"
#include "flight/mavlink/frame.hpp"
#include "flight/mavlink/vehicle/mission.hpp"
#include "flight/vehicle/send.hpp"

namespace overfly::vehicle {

/// Holds one flight plan. An upload replaces it when its last item has come and `accept` has no
/// objection; items that do not come are asked for again each second, five times. Fences and rally
/// points are not supported: reading them gives none.
class MissionStore {
 public:
  using Items = std::vector<flight::mavlink::MissionItem>;
  using Accept = std::function<Status(const Items&)>;

  MissionStore(std::uint8_t system, Accept accept);

  /// Takes the messages of the protocol. @return empty for other messages; the objection of
  /// `accept` if it has just refused a mission
  [[nodiscard]] std::optional<Status> take(const flight::mavlink::Frame& frame,
                                           std::int64_t now_ns,
                                           const Send& send);
  /// Asks again for an item that has not come.
  void step(std::int64_t now_ns, const Send& send);

  [[nodiscard]] const Items& items() const { return items_; }

 private:
  struct Upload {
    std::uint8_t from_system = 0;
    std::uint8_t from_component = 0;
    std::size_t count = 0;
    Items items;
    std::int64_t asked_ns = 0;
    int attempts = 0;
  };

  void begin_upload(const flight::mavlink::Frame& frame, std::int64_t now_ns, const Send& send);
  [[nodiscard]] Status take_item(const flight::mavlink::Frame& frame,
                                 std::int64_t now_ns,
                                 const Send& send);
  void ask_for_next(std::int64_t now_ns, const Send& send);
  void acknowledge(std::uint8_t system,
                   std::uint8_t component,
                   std::uint8_t result,
                   std::uint8_t type,
                   const Send& send) const;

  std::uint8_t system_;
  Accept accept_;
  Items items_;
  std::optional<Upload> upload_;
};

}  // namespace overfly::vehicle
