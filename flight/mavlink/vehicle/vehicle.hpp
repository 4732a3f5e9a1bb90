// A session with one vehicle over a link.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "core/result.hpp"
#include "flight/mavlink/link/frame_link.hpp"
#include "flight/mavlink/vehicle/exchange.hpp"
#include "flight/mavlink/vehicle/vehicle_state.hpp"

namespace overfly::flight::mavlink {

struct VehicleOptions {
  LinkOptions link;
  /// The vehicle's system number; 0: the first autopilot that is heard.
  std::uint8_t system = 0;
};

/// What the session knows about its clocks.
struct VehicleClock {
  std::int64_t vehicle_ns = 0;     ///< the vehicle's clock now
  double rate = 1.0;               ///< vehicle seconds per local second
  std::int64_t round_trip_ns = 0;  ///< the shortest of the latest answers
};

/// Listens to one vehicle on a thread of its own. Unless the link is read-only it sends a heartbeat
/// each second as a ground station does, asks for the vehicle's time, and answers when the vehicle
/// asks for the time (in the vehicle's own clock, so that time stamps in that clock need no
/// conversion there).
///
/// Messages of other systems on the link are counted and otherwise ignored, as are the vehicle's
/// answers to other ground stations in conversations; the vehicle's component is the autopilot that
/// sends the first heartbeat. All functions may be called from any thread.
class Vehicle {
 public:
  /// Errors: as FrameLink::create; kInternal if no thread can be started. A vehicle that is silent
  /// is no error.
  static Result<std::unique_ptr<Vehicle>> open(const LinkAddress& address,
                                               const VehicleOptions& options);
  ~Vehicle();
  Vehicle(const Vehicle&) = delete;
  Vehicle& operator=(const Vehicle&) = delete;

  /// Waits for the first heartbeat of the vehicle.
  /// Errors: kIo after `patience`, with what was heard instead; kCancelled; kInternal if the
  /// session has failed.
  [[nodiscard]] Status wait_until_heard(std::chrono::milliseconds patience,
                                        const std::atomic<bool>* cancel);
  [[nodiscard]] VehicleState state() const;
  [[nodiscard]] LinkCounts link_counts() const;
  /// Empty until the vehicle has answered some requests, and on a read-only link.
  [[nodiscard]] std::optional<VehicleClock> clock() const;
  /// With the actual port if 0 was asked for.
  [[nodiscard]] const LinkAddress& address() const;
  /// One line for error messages: what was heard last, and when.
  [[nodiscard]] std::string last_heard() const;

  /// Begins a conversation, which holds the messages of the vehicle from now on: at most
  /// kMaxHeldMessages, the oldest are dropped. Ends with the object, which must not outlive the
  /// vehicle.
  /// @param cancel  ends its waits; may be null
  [[nodiscard]] std::unique_ptr<Exchange> converse(const std::atomic<bool>* cancel);
  /// Sends one message to the vehicle soon.
  /// Errors: as encode_frame; kConflict on a read-only link, before the vehicle was heard, and if
  /// 256 messages wait.
  [[nodiscard]] Status send(MessageId id, const PayloadWriter& payload);

  /// Called with each message of the vehicle on the session's thread; must not call the session.
  /// Returns when no call is in progress; an empty function ends the calls.
  void set_listener(std::function<void(const Frame&)> listener);

 private:
  struct Impl;
  class Conversation;
  explicit Vehicle(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace overfly::flight::mavlink
