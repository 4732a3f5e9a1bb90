// ORB-SLAM2 (Mur-Artal, Tardos 2017) as a monocular odometry, through its class System.
#include <KeyFrame.h>
#include <MapPoint.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <stdexcept>

#include "vo_bridges/adapters/orbslam2/orbslam2_internals.hpp"
#include "vo_bridges/adapters/orbslam2/orbslam2_settings.hpp"
#include "vo_bridges/adapters/scene_points.hpp"
#include "vo_bridges/adapters/stopwatch.hpp"
#include "vo_bridges/adapters/upstream_system.hpp"

namespace overfly_adapters {
namespace {

/// ORB-SLAM2 does not search loops for ten keyframes after the keyframe with this number, but adds
/// each keyframe to the database used by relocalisation. With this value no loop is ever closed and
/// the database is still filled. Stopping the loop closer's thread would disable relocalisation.
constexpr long unsigned int kNoLoopBefore = 1UL << 62U;

class OrbSlam2System : public UpstreamSystem {
 public:
  explicit OrbSlam2System(const Session& session)
      : session_(session),
        wait_for_mapping_(flag_of(session.parameters, "wait_for_mapping", session.lockstep)) {
    const std::string& vocabulary = session.parameters.at("vocabulary");
    if (!std::ifstream(vocabulary).good()) {
      throw std::runtime_error("parameter vocabulary = '" + vocabulary + "': no such file");
    }
    const SettingsFile settings(session);
    system_ =
        new ORB_SLAM2::System(vocabulary, settings.path(), ORB_SLAM2::System::MONOCULAR, false);
    tracker_ = system_->*member_of(SystemTracker());
    mapper_ = system_->*member_of(SystemMapper());
    loop_closer_ = system_->*member_of(SystemLoopCloser());
    drawer_ = system_->*member_of(SystemDrawer());
    map_ = system_->*member_of(SystemMap());
    keep_loops_open();
  }

  ParameterValues effective_parameters() override {
    ORB_SLAM2::ORBextractor& extractor = *(tracker_->*member_of(TrackerExtractor()));
    ParameterValues values;
    values["vocabulary"] = session_.parameters.at("vocabulary");
    values["wait_for_mapping"] = text_of_flag(wait_for_mapping_);
    const auto tell = [&](const char* name, double value) { values[name] = text_of_number(value); };
    tell("ORBextractor.nFeatures", extractor.*member_of(ExtractorFeatures()));
    values["ORBextractor.scaleFactor"] = scale_factor_text(extractor.GetScaleFactor());
    tell("ORBextractor.nLevels", extractor.GetLevels());
    tell("ORBextractor.iniThFAST", extractor.*member_of(ExtractorIniThFast()));
    tell("ORBextractor.minThFAST", extractor.*member_of(ExtractorMinThFast()));
    values["loop_closing"] = text_of_flag(last_loop() != kNoLoopBefore);
    return values;
  }

  AdapterAnswer track(const AdapterFrame& frame) override {
    // It keeps a reference to the image until the next one.
    image_ = cv::Mat(session_.camera.height_px,
                     session_.camera.width_px,
                     CV_8UC1,
                     const_cast<std::uint8_t*>(frame.pixels))
                 .clone();
    AdapterAnswer answer;
    const Stopwatch stopwatch;
    const cv::Mat T_camera_vo = system_->TrackMonocular(image_, frame.t_s);
    answer.timings_ms["track"] = stopwatch.wall_ms();
    answer.timings_ms["track_cpu"] = stopwatch.thread_cpu_ms();
    keep_loops_open();  // an internal reset clears it
    set_state(!T_camera_vo.empty(), &answer);
    if (answer.state == AdapterState::kTracking) {
      set_pose(T_camera_vo, &answer);
      see_points(T_camera_vo, frame.debug_wanted, &answer);
    }
    answer.counters["features"] = static_cast<double>(system_->GetTrackedKeyPointsUn().size());
    if (frame.debug_wanted) answer.debug_image = debug_image();
    wait_for_mapping(&answer);
    answer.timings_ms["track_and_map_cpu"] = stopwatch.process_cpu_ms();
    return answer;
  }

 private:
  static std::string scale_factor_text(float value) {
    char text[32] = {};
    std::snprintf(text, sizeof(text), "%.7g", static_cast<double>(value));
    return text;
  }

  long unsigned int last_loop() const {
    return __atomic_load_n(&(loop_closer_->*member_of(LoopCloserLast())), __ATOMIC_ACQUIRE);
  }

  void keep_loops_open() {
    __atomic_store_n(
        &(loop_closer_->*member_of(LoopCloserLast())), kNoLoopBefore, __ATOMIC_RELEASE);
  }

  void set_state(bool has_pose, AdapterAnswer* answer) {
    switch (system_->GetTrackingState()) {
      case ORB_SLAM2::Tracking::OK:
        answer->state = has_pose ? AdapterState::kTracking : AdapterState::kLost;
        if (has_pose) posed_ = true;
        break;
      case ORB_SLAM2::Tracking::LOST:
        answer->state = AdapterState::kLost;
        break;
      default:
        // It discarded its map (lost with five keyframes or fewer): new origin, new scale.
        if (posed_) ++map_id_;
        posed_ = false;
        answer->state = AdapterState::kInitialising;
    }
    answer->map_id = map_id_;
  }

  /// Sets T_vo_camera from its inverse: R' and -R' t.
  static void set_pose(const cv::Mat& T_camera_vo, AdapterAnswer* answer) {
    std::array<double, 9> R_vo_camera;
    for (int row = 0; row < 3; ++row) {
      double position = 0.0;
      for (int column = 0; column < 3; ++column) {
        const double value = T_camera_vo.at<float>(column, row);
        R_vo_camera[3 * static_cast<std::size_t>(row) + static_cast<std::size_t>(column)] = value;
        position -= value * static_cast<double>(T_camera_vo.at<float>(column, 3));
      }
      answer->position_vo[static_cast<std::size_t>(row)] = position;
    }
    answer->orientation_xyzw = quaternion_from(R_vo_camera);
  }

  void see_points(const cv::Mat& T_camera_vo, bool debug_wanted, AdapterAnswer* answer) {
    std::vector<double> depths;
    for (ORB_SLAM2::MapPoint* point : system_->GetTrackedMapPoints()) {
      if (point == nullptr || point->isBad()) continue;
      const cv::Mat p_vo = point->GetWorldPos();
      double depth = T_camera_vo.at<float>(2, 3);
      for (int k = 0; k < 3; ++k) {
        depth += static_cast<double>(T_camera_vo.at<float>(2, k)) * p_vo.at<float>(k);
      }
      if (depth > 0.0) depths.push_back(depth);
      if (!debug_wanted) continue;
      answer->map_points_vo.push_back({{p_vo.at<float>(0), p_vo.at<float>(1), p_vo.at<float>(2)}});
    }
    answer->scene_depth = median_depth(depths);
    answer->counters["inliers"] = static_cast<double>(depths.size());
  }

  /// Its own debug image without the text line below it, converted from BGR to RGB.
  RgbImage debug_image() const {
    const cv::Mat drawn = drawer_->DrawFrame();
    RgbImage image;
    if (drawn.rows < session_.camera.height_px || drawn.cols < session_.camera.width_px ||
        drawn.type() != CV_8UC3) {
      return image;
    }
    image.width_px = session_.camera.width_px;
    image.height_px = session_.camera.height_px;
    const std::size_t row_bytes = 3 * static_cast<std::size_t>(image.width_px);
    image.pixels.resize(row_bytes * static_cast<std::size_t>(image.height_px));
    for (int y = 0; y < image.height_px; ++y) {
      const std::uint8_t* from = drawn.ptr<std::uint8_t>(y);
      std::uint8_t* to = image.pixels.data() + static_cast<std::size_t>(y) * row_bytes;
      for (std::size_t i = 0; i < row_bytes; i += 3) {
        to[i] = from[i + 2];
        to[i + 1] = from[i + 1];
        to[i + 2] = from[i];
      }
    }
    return image;
  }

  /// Waits until its mapping thread is idle, so that the result does not depend on the machine's
  /// speed. Checks the queue first: mapping sets its busy flag before it takes from the queue.
  void wait_for_mapping(AdapterAnswer* answer) {
    const Stopwatch stopwatch;
    while (wait_for_mapping_ && (mapper_->KeyframesInQueue() > 0 || !mapper_->AcceptKeyFrames())) {
      ::usleep(200);
    }
    if (wait_for_mapping_) answer->timings_ms["mapping_wait"] = stopwatch.wall_ms();
    answer->counters["keyframes"] = static_cast<double>(map_->KeyFramesInMap());
    answer->counters["map_points"] = static_cast<double>(map_->MapPointsInMap());
    // MapChanged reports only loop closures and the adjustment after them.
    if (system_->MapChanged()) ++loops_closed_;
    answer->counters["loops_closed"] = loops_closed_;
  }

  Session session_;
  bool wait_for_mapping_;
  /// Never destroyed: its class has no destructor, and its threads run until the process ends.
  ORB_SLAM2::System* system_ = nullptr;
  ORB_SLAM2::Tracking* tracker_ = nullptr;
  ORB_SLAM2::LocalMapping* mapper_ = nullptr;
  ORB_SLAM2::LoopClosing* loop_closer_ = nullptr;
  ORB_SLAM2::FrameDrawer* drawer_ = nullptr;
  ORB_SLAM2::Map* map_ = nullptr;
  cv::Mat image_;
  unsigned map_id_ = 0;
  bool posed_ = false;  ///< the current map has given a pose
  int loops_closed_ = 0;
};

}  // namespace

std::unique_ptr<UpstreamSystem> create_upstream_system(const Session& session) {
  return std::unique_ptr<UpstreamSystem>(new OrbSlam2System(session));
}

}  // namespace overfly_adapters
