#include "server/timeline/recorded_points.hpp"

#include <string>

#include "server/record/map_points.hpp"
#include "server/record/run_folder.hpp"

namespace overfly::server {

std::vector<Eigen::Vector3f> recorded_points(const std::filesystem::path& run_folder,
                                             RecordedNumbers& numbers,
                                             const RunTimeline& timeline,
                                             std::size_t estimator,
                                             const RowAlignment& alignment,
                                             const FrameRow& row) {
  const auto estimate = timeline.estimate_at(estimator, row.t_ns);
  if (!estimate || estimate->sample.state != TrackingState::kTracking) return {};
  const std::string& name = timeline.estimators().at(estimator);
  const auto frame = numbers.last(map_points_file(run_folder, name, 0).parent_path(), row.frame);
  if (!frame) return {};
  const auto points = read_map_points(map_points_file(run_folder, name, *frame));
  if (!points) return {};
  const auto S_world_vo = alignment.S_world_vo(estimate->sample.map_id, points->S_world_vo);
  return S_world_vo ? in_world(*points, *S_world_vo) : std::vector<Eigen::Vector3f>();
}

}  // namespace overfly::server
