// The frames of an export in order, checked against the recorded run.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "server/camera/frame_maker.hpp"
#include "server/export/export_source.hpp"
#include "server/record/rows/rows.hpp"

namespace overfly::server {

struct FrameSpan {
  double from_s = 0.0;
  std::optional<double> to_s;
  std::vector<std::string> cameras;  ///< names; empty = all
};

class FrameSequence {
 public:
  /// @param source  must outlive the sequence
  /// Errors: kInvalidArgument for an unknown camera or a span without frames; kConflict for a
  /// changed world; as FrameMaker::open.
  static Result<std::unique_ptr<FrameSequence>> open(const ExportSource& source,
                                                     const FrameSpan& span,
                                                     const FrameMakerOptions& options);

  /// The next frame with the shots of the chosen cameras; empty at the end.
  /// Errors: kConflict if it differs from the recorded frame; as FrameMaker::make.
  [[nodiscard]] Result<std::optional<MadeFrame>> next();

  [[nodiscard]] FrameMaker& maker() { return *maker_; }
  [[nodiscard]] const std::vector<CameraSpec>& cameras() const { return cameras_; }
  /// Number of frames; an upper bound for a flight of unknown length.
  [[nodiscard]] std::int64_t count() const { return static_cast<std::int64_t>(frames_.size()); }
  [[nodiscard]] std::int64_t first_frame() const { return frames_.front(); }
  [[nodiscard]] std::int64_t last_frame() const { return frames_.back(); }

 private:
  explicit FrameSequence(const ExportSource& source) : source_(source) {}
  Status choose_cameras(const std::vector<std::string>& names);
  Status choose_frames(const FrameSpan& span);
  Status catch_up(std::int64_t frame);
  [[nodiscard]] const FrameRow* record_of(std::int64_t frame) const;

  const ExportSource& source_;
  std::unique_ptr<FrameMaker> maker_;
  std::vector<std::size_t> chosen_;   ///< indices into Scenario::cameras
  std::vector<CameraSpec> cameras_;   ///< the chosen cameras
  std::vector<std::int64_t> frames_;  ///< to be made, increasing
  std::size_t next_ = 0;
  std::int64_t made_up_to_ = 0;  ///< the maker has passed all frames before this one
};

}  // namespace overfly::server
