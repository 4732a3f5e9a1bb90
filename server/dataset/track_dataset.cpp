#include "server/dataset/track_dataset.hpp"
#include "server/dataset/open_dataset.hpp"

#include <algorithm>
#include <utility>

#include "core/cancel.hpp"
#include "core/measure/process_memory.hpp"
#include "core/measure/processor_time.hpp"
#include "core/motion/trajectory_io.hpp"
#include "server/estimators/estimator_driver.hpp"
#include "server/files/jpeg.hpp"
#include "server/files/number_text.hpp"
#include "server/files/whole_file.hpp"
#include "server/timing/run_clock.hpp"

namespace overfly::server {
namespace {

namespace fs = std::filesystem;

double ms_since(std::int64_t begin_ns) {
  return static_cast<double>(machine_clock().now_ns() - begin_ns) * 1e-6;
}

/// One pass over the data set.
class Pass {
 public:
  Pass(const Dataset& dataset, VoPort& port, const TrackOptions& options)
      : dataset_(dataset), port_(port), options_(options) {}

  Result<TrackedDataset> run() {
    if (Status status = prepare(); !status) return status.error();
    for (std::size_t i = 0; i < dataset_.images.size() && !crashed_; ++i) {
      if (is_cancelled(options_.cancel)) {
        result_.cancelled = true;
        break;
      }
      Status status = step(i);
      pass_on_log();
      if (!status) return status.error();
      if (result_.cancelled) break;
      if (options_.progress) {
        options_.progress(i + 1, dataset_.images.size(), result_.records.back().sample.state);
      }
    }
    result_.type = port_.type();
    result_.parameters = port_.effective_parameters();
    // An estimator in this process is measured by the use of the process, which does nothing else
    // here.
    const std::optional<ResourceUse> use = driver_.use();
    if (use && use->own_process) {
      result_.resources = *use;
      result_.own_process = true;
    } else {
      result_.resources.peak_memory_mb = peak_memory_mb();
    }
    return std::move(result_);
  }

 private:
  /// Errors: as for reading the first image.
  Status prepare() {
    Result<VoFrame> first = read_frame(dataset_, 0);
    if (!first) return first.error();
    first->image.reset();
    driver_.prepare(*first);
    pass_on_log();
    return {};
  }

  Status step(std::size_t i) {
    const std::int64_t read_ns = machine_clock().now_ns();
    const Result<VoFrame> frame = read_frame(dataset_, i);
    if (!frame) return frame.error();
    result_.reading.ms.push_back(ms_since(read_ns));
    const double cpu_before_s = process_cpu_s();
    const std::int64_t track_ns = machine_clock().now_ns();
    const Result<VoEstimate> estimate = driver_.track(*frame, wants_debug_);
    result_.tracking.ms.push_back(ms_since(track_ns));
    result_.resources.cpu_s += process_cpu_s() - cpu_before_s;
    report_lines(driver_.take_notes());
    if (estimate) return book(*frame, *estimate);
    if (estimate.error().code == ErrorCode::kCancelled) {
      result_.cancelled = true;
      return {};
    }
    const bool hung = estimate.error().code == ErrorCode::kTimeout;
    if (estimate.error().code != ErrorCode::kInternal && !hung) {
      return estimate.error().in(dataset_.images[i].listed_at);
    }
    crashed_ = true;
    result_.records.push_back(lost_record(*frame));
    result_.records.back().crash = estimate.error().message;
    result_.records.back().hung = hung;
    return {};
  }

  Status book(const VoFrame& frame, const VoEstimate& estimate) {
    result_.records.push_back(record_of(estimate));
    const auto unanswered = estimate.counters.find("unanswered");
    if (unanswered != estimate.counters.end() && unanswered->second > 0.0) ++result_.unanswered;
    if (estimate.image_crc32 && estimate.image_crc32 != frame.image_crc32) {
      ++result_.hash_mismatches;
    }
    for (const auto& [stage, ms] : estimate.timing_ms) result_.stages[stage].ms.push_back(ms);
    if (options_.map_points) result_.map.add(estimate.sample, estimate.map_points_vo);
    if (options_.debug_folder.empty() || !estimate.debug_image) return {};
    constexpr int kQuality = 85;
    const auto bytes = encode_jpeg(*estimate.debug_image, kQuality);
    if (!bytes) return bytes.error().in("debug image of frame " + std::to_string(frame.index));
    return write_whole(options_.debug_folder / (padded(frame.index, 6) + ".jpg"),
                       std::span<const std::uint8_t>(*bytes));
  }

  void pass_on_log() { report_lines(port_.take_log()); }

  void report_lines(const std::vector<std::string>& lines) {
    for (const std::string& line : lines) {
      if (options_.log) options_.log(line);
    }
  }

  const Dataset& dataset_;
  VoPort& port_;
  EstimatorDriver driver_{port_};
  const TrackOptions& options_;
  const bool wants_debug_ = !options_.debug_folder.empty() || options_.map_points;
  TrackedDataset result_;
  bool crashed_ = false;
};

}  // namespace

Result<TrackedDataset> track_dataset(const Dataset& dataset,
                                     VoPort& port,
                                     const TrackOptions& options) {
  return Pass(dataset, port, options).run();
}

std::string never_ran(const TrackedDataset& tracked) {
  for (const EstimateRecord& record : tracked.records) {
    const auto unanswered = record.counters.find("unanswered");
    const bool answered = unanswered == record.counters.end() || unanswered->second <= 0.0;
    if (!record.crash.empty()) return record.crash;
    if (answered) return {};
  }
  return {};
}

EstimateTrack track_of(const TrackedDataset& tracked) {
  EstimateTrack track;
  track.name = tracked.type;
  for (const EstimateRecord& record : tracked.records) track.samples.push_back(record.sample);
  return track;
}

std::optional<int> scored_map(const TrackedDataset& tracked) {
  std::map<int, int> frames;
  for (const EstimateRecord& record : tracked.records) {
    if (record.sample.state == TrackingState::kTracking) ++frames[record.sample.map_id];
  }
  if (frames.empty()) return std::nullopt;
  return std::max_element(frames.begin(),
                          frames.end(),
                          [](const auto& a, const auto& b) { return a.second < b.second; })
      ->first;
}

Status write_track(const fs::path& file, const TrackedDataset& tracked) {
  const std::optional<int> map_id = scored_map(tracked);
  Trajectory trajectory;
  std::map<std::string, std::string> comments;
  for (const EstimateRecord& record : tracked.records) {
    const EstimateSample& sample = record.sample;
    if (sample.state != TrackingState::kTracking || sample.map_id != map_id) continue;
    if (trajectory.empty() && sample.scene_depth) {
      comments["init_scene_depth"] = number_text(*sample.scene_depth);
    }
    const Status added = trajectory.append({sample.t_ns, sample.T_vo_camera});
    if (!added) return added.error().in("frame " + std::to_string(sample.frame));
  }
  return write_tum(file, trajectory, comments);
}

Status write_statuses(const fs::path& file, const TrackedDataset& tracked) {
  std::string text;
  for (const EstimateRecord& record : tracked.records) text += json_from(record).dump() + "\n";
  return write_whole(file, text);
}

}  // namespace overfly::server
