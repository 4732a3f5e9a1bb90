#include "server/export/frame_sequence.hpp"

#include <algorithm>
#include <utility>

#include "server/record/rows/rows.hpp"
#include "server/record/run_info.hpp"

namespace overfly::server {
namespace {

/// True if a frame depends on the preceding ones, so that none may be skipped.
bool needs_history(const Scenario& scenario) {
  // A frozen camera repeats an older image, and stamps shifted by faults depend on the preceding
  // ones.
  const auto changes_frames = [](const FaultSpec& fault) {
    return fault.kind != FaultKind::kGpsOutage;
  };
  if (std::any_of(scenario.faults.begin(), scenario.faults.end(), changes_frames)) return true;
  return std::any_of(
      scenario.cameras.begin(), scenario.cameras.end(), [](const CameraSpec& camera) {
        return camera.sensor.enabled && camera.sensor.auto_exposure.has_value();
      });
}

}  // namespace

Result<std::unique_ptr<FrameSequence>> FrameSequence::open(const ExportSource& source,
                                                           const FrameSpan& span,
                                                           const FrameMakerOptions& options) {
  std::unique_ptr<FrameSequence> sequence(new FrameSequence(source));
  if (Status status = sequence->choose_cameras(span.cameras); !status) return status.error();
  FrameMakerOptions making = options;
  making.open_truth = [&source](const terrain::World& world) { return open_truth(source, world); };
  auto maker = FrameMaker::open(source.scenario, making);
  if (!maker) return maker.error();
  sequence->maker_ = std::move(*maker);
  if (Status status = check_world(source, sequence->maker_->world()); !status) {
    return status.error();
  }
  if (Status status = sequence->choose_frames(span); !status) return status.error();
  return sequence;
}

Status FrameSequence::choose_cameras(const std::vector<std::string>& names) {
  const std::vector<CameraSpec>& all = source_.scenario.cameras;
  std::string known;
  for (std::size_t i = 0; i < all.size(); ++i) {
    known += (i == 0 ? "" : ", ") + all[i].name;
    if (names.empty() || std::find(names.begin(), names.end(), all[i].name) != names.end()) {
      chosen_.push_back(i);
      cameras_.push_back(all[i]);
    }
  }
  for (const std::string& name : names) {
    const bool found = std::any_of(
        all.begin(), all.end(), [&](const CameraSpec& camera) { return camera.name == name; });
    if (!found) {
      return Error{ErrorCode::kInvalidArgument,
                   "camera = " + name + ": must be one of the scenario's: " + known};
    }
  }
  return {};
}

Status FrameSequence::choose_frames(const FrameSpan& span) {
  const std::int64_t from_ns = ns_from_s(span.from_s);
  const auto inside = [&](std::int64_t k) {
    const std::int64_t t_ns = maker_->frame_ns(k);
    return t_ns >= from_ns && (!span.to_s || t_ns <= ns_from_s(*span.to_s));
  };
  if (source_.run) {
    for (const FrameRow& record : source_.run->frames) {
      if (inside(record.frame)) frames_.push_back(record.frame);
    }
  } else {
    for (std::int64_t k = 0; k < maker_->frames_total(); ++k) {
      if (inside(k)) frames_.push_back(k);
    }
  }
  if (!frames_.empty()) return {};
  const double end_s = s_from_ns(maker_->duration_ns().value_or(0));
  return Error{ErrorCode::kInvalidArgument,
               "no frame lies in [from, to] = [" + std::to_string(span.from_s) + ", " +
                   (span.to_s ? std::to_string(*span.to_s) : "end") + "] s: the flight spans [0, " +
                   std::to_string(end_s) + "] s"};
}

const FrameRow* FrameSequence::record_of(std::int64_t frame) const {
  if (!source_.run) return nullptr;
  const auto& rows = source_.run->frames;
  const auto found = std::lower_bound(
      rows.begin(), rows.end(), frame, [](const FrameRow& record, std::int64_t wanted) {
        return record.frame < wanted;
      });
  return found != rows.end() && found->frame == frame ? &*found : nullptr;
}

/// Makes the frames on which the next one depends.
Status FrameSequence::catch_up(std::int64_t frame) {
  if (!needs_history(source_.scenario)) return {};
  for (std::int64_t k = made_up_to_; k < frame; ++k) {
    // A real-time run did not expose its cameras for frames that were too late.
    if (source_.run && record_of(k) == nullptr) continue;
    const auto passed = maker_->make(k);
    if (!passed) return passed.error();
  }
  return {};
}

Result<std::optional<MadeFrame>> FrameSequence::next() {
  if (next_ == frames_.size()) return std::optional<MadeFrame>();
  const std::int64_t frame = frames_[next_++];
  if (Status status = catch_up(frame); !status) return status.error();
  auto next = maker_->make(frame);
  if (!next || !*next) return next;
  MadeFrame& made = **next;
  made_up_to_ = frame + 1;
  if (const FrameRow* record = record_of(frame); record != nullptr) {
    const Pose& T_world_camera = made.shots[kMainCamera].drawn.T_world_camera;
    Status status = check_recorded_pose(*record, made.t_ns, T_world_camera);
    if (!status) return status.error();
  }
  std::vector<CameraShot> shots;
  for (const std::size_t camera : chosen_) shots.push_back(std::move(made.shots[camera]));
  made.shots = std::move(shots);
  return next;
}

}  // namespace overfly::server
