#include "server/runs/timeline_shelf.hpp"

#include <algorithm>
#include <utility>

#include "server/record/run_folder.hpp"
#include "server/scoring/run_metrics_json.hpp"

namespace overfly::server {

namespace {

/// How long a timeline of a run that another process writes is kept at least.
constexpr std::chrono::seconds kShortestFresh{1};

}  // namespace

void tell_deleted(RunTimeline& timeline) {
  timeline.change_info([](RunInfo& info) { info.problem = "the run was deleted"; });
}

TimelineShelf::Entry TimelineShelf::entry_of(const std::string& id) const {
  Entry entry;
  entry.id = id;
  entry.metrics = FileStamp::of(metrics_file(places_.of(id)));
  entry.metrics_settled = entry.metrics.settled(utc_now_ns());
  return entry;
}

bool TimelineShelf::is_fresh(Entry& entry) const {
  const FileStamp manifest = FileStamp::of(manifest_file(places_.of(entry.id)));
  if (!manifest.exists) tell_deleted(*entry.timeline);
  if (!manifest.exists || manifest != entry.timeline->manifest_stamp()) return false;
  if (entry.fresh_until && std::chrono::steady_clock::now() > *entry.fresh_until) return false;
  const Entry now = entry_of(entry.id);
  if (now.metrics == entry.metrics && entry.metrics_settled) return true;
  entry.metrics = now.metrics;
  entry.metrics_settled = now.metrics_settled;
  Result<RunMetrics> metrics = read_run_metrics(places_.of(entry.id));
  // A file that cannot be read is reported when the run is opened again.
  if (!metrics) return false;
  const auto known = entry.timeline->metrics();
  // Compared as they are sent: viewers are not notified of a file that was only touched.
  if (!known || json_from(*known) != json_from(*metrics)) {
    entry.timeline->set_metrics(std::move(*metrics));
  }
  return true;
}

Result<std::shared_ptr<RunTimeline>> TimelineShelf::get(const std::string& id) {
  {
    const std::lock_guard lock(mutex_);
    const auto found = std::find_if(
        entries_.begin(), entries_.end(), [&](const Entry& entry) { return entry.id == id; });
    if (found != entries_.end()) {
      if (is_fresh(*found)) {
        entries_.splice(entries_.begin(), entries_, found);
        return found->timeline;
      }
      entries_.erase(found);
    }
  }
  // Read without the lock, since a long run takes time. The stamp is taken first: a change
  // meanwhile is seen at the next call.
  Entry entry = entry_of(id);
  const auto begin = std::chrono::steady_clock::now();
  Result<std::shared_ptr<RunTimeline>> opened = RunTimeline::open(places_.of(id));
  if (!opened) return opened.error();
  if (RunInfo info = (*opened)->info(); info.id != id) {
    info.id = id;  // of a sweep
    (*opened)->set_info(info);
  }
  entry.timeline = *opened;
  // A run that another process still writes is read again, but not for every picture.
  if ((*opened)->info().status == RunStatus::kRunning) {
    const auto end = std::chrono::steady_clock::now();
    entry.fresh_until = end + kShortestFresh + 4 * (end - begin);
  }
  return kept(std::move(entry));
}

void TimelineShelf::put(const std::string& id, std::shared_ptr<RunTimeline> timeline) {
  Entry entry;
  entry.id = id;
  entry.timeline = std::move(timeline);
  keep(std::move(entry));
}

std::shared_ptr<RunTimeline> TimelineShelf::kept(Entry entry) {
  {
    const std::lock_guard lock(mutex_);
    const auto found = std::find_if(entries_.begin(), entries_.end(), [&](const Entry& other) {
      return other.id == entry.id && !other.fresh_until &&
             other.timeline->manifest_stamp() == entry.timeline->manifest_stamp();
    });
    if (found != entries_.end()) return found->timeline;
  }
  std::shared_ptr<RunTimeline> timeline = entry.timeline;
  keep(std::move(entry));
  return timeline;
}

void TimelineShelf::keep(Entry entry) {
  const std::lock_guard lock(mutex_);
  std::erase_if(entries_, [&](const Entry& other) { return other.id == entry.id; });
  entries_.push_front(std::move(entry));
  std::size_t unused = 0;
  std::erase_if(entries_, [&](const Entry& other) {
    return other.timeline.use_count() == 1 && ++unused > kMostUnused;
  });
}

void TimelineShelf::forget(const std::string& id) {
  const std::lock_guard lock(mutex_);
  std::erase_if(entries_, [&](const Entry& entry) {
    if (entry.id != id) return false;
    tell_deleted(*entry.timeline);
    return true;
  });
}

void TimelineShelf::refresh() {
  const std::lock_guard lock(mutex_);
  std::erase_if(entries_, [&](Entry& entry) { return !is_fresh(entry); });
}

}  // namespace overfly::server
