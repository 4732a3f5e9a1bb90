#include "server/net/connection_table.hpp"

#include <algorithm>
#include <utility>

namespace overfly::net {
namespace {

bool is_http(ConnectionPhase phase) {
  return phase == ConnectionPhase::kIdle || phase == ConnectionPhase::kReceiving ||
         phase == ConnectionPhase::kAnswering || phase == ConnectionPhase::kSending;
}

bool is_web_socket(ConnectionPhase phase) {
  return phase == ConnectionPhase::kViewer || phase == ConnectionPhase::kOnlooker;
}

}  // namespace

std::size_t& ConnectionTable::counted(ConnectionPhase phase) {
  return counts_.at(static_cast<std::size_t>(phase));
}

std::size_t ConnectionTable::count(ConnectionPhase phase) const {
  const std::lock_guard lock(mutex_);
  return counts_.at(static_cast<std::size_t>(phase));
}

void ConnectionTable::change(Entry* entry, ConnectionPhase phase) {
  --counted(entry->phase);
  ++counted(phase);
  entry->phase = phase;
  entry->since = ++last_since_;
}

bool ConnectionTable::close_oldest(ConnectionPhase phase) {
  Entry* oldest = nullptr;
  for (auto& [number, entry] : entries_) {
    if (entry.phase != phase) continue;
    if (oldest == nullptr || entry.since < oldest->since) oldest = &entry;
  }
  if (oldest == nullptr) return false;
  oldest->close();
  change(oldest, ConnectionPhase::kClosing);
  return true;
}

bool ConnectionTable::is_full_for(ConnectionPhase phase) const {
  const std::size_t open = counts_[static_cast<std::size_t>(ConnectionPhase::kViewer)] +
                           counts_[static_cast<std::size_t>(ConnectionPhase::kOnlooker)];
  const std::size_t kept = phase == ConnectionPhase::kOnlooker ? limits_.max_viewers / 8 : 0;
  return open + kept >= limits_.max_viewers;
}

bool ConnectionTable::has_room_for(ConnectionPhase phase) const {
  const std::lock_guard lock(mutex_);
  return !is_full_for(phase);
}

std::unique_ptr<ConnectionTable::Place> ConnectionTable::add(Close close) {
  auto place = std::make_unique<Place>(*this, ++last_number_);
  const std::lock_guard lock(mutex_);
  if (counted(ConnectionPhase::kStranger) >= limits_.max_strangers) {
    (void)close_oldest(ConnectionPhase::kStranger);
  }
  entries_[place->number()] = {ConnectionPhase::kStranger, ++last_since_, std::move(close)};
  ++counted(ConnectionPhase::kStranger);
  return place;
}

bool ConnectionTable::enter(std::uint64_t number, ConnectionPhase phase) {
  const std::lock_guard lock(mutex_);
  Entry& entry = entries_.at(number);
  if (entry.phase == ConnectionPhase::kClosing) return false;
  if (is_web_socket(phase) && is_full_for(phase)) return false;
  if (is_http(phase) && !is_http(entry.phase)) {
    const std::size_t http =
        counted(ConnectionPhase::kIdle) + counted(ConnectionPhase::kReceiving) +
        counted(ConnectionPhase::kAnswering) + counted(ConnectionPhase::kSending);
    // Connections that wait for an answer of the server are not closed.
    if (http >= limits_.max_http && !close_oldest(ConnectionPhase::kIdle) &&
        !close_oldest(ConnectionPhase::kReceiving) && !close_oldest(ConnectionPhase::kSending)) {
      return false;
    }
  }
  change(&entry, phase);
  return true;
}

void ConnectionTable::remove(std::uint64_t number) {
  const std::lock_guard lock(mutex_);
  const auto found = entries_.find(number);
  if (found == entries_.end()) return;
  --counted(found->second.phase);
  entries_.erase(found);
}

}  // namespace overfly::net
