// An estimator connected by ROS topics.
#pragma once

#include <atomic>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "middleware/ros1/line_log.hpp"
#include "middleware/ros1/master_watch.hpp"
#include "middleware/ros1/node.hpp"
#include "vo_bridges/pose_intake.hpp"
#include "vo_bridges/ros1/answer_patience.hpp"
#include "vo_bridges/ros1/ros1_debug_images.hpp"
#include "vo_bridges/ros1/ros1_node_use.hpp"
#include "vo_bridges/ros1/ros1_topics.hpp"
#include "vo_bridges/stamped_answers.hpp"
#include "vo_bridges/vo_port.hpp"

namespace overfly::ros1 {

class Session final : public VoPort {
 public:
  Session(Node& node, const Ros1EstimatorOptions& options);

  /// Opens the topics and waits for a subscriber.
  /// Errors: as create_ros1_estimator.
  [[nodiscard]] Status begin(AnswerPatience::Clock::time_point end);

  [[nodiscard]] std::string type() const override { return "ros1"; }
  [[nodiscard]] std::map<std::string, std::string> effective_parameters() const override;
  [[nodiscard]] Status prepare(const VoFrame& first) override;
  [[nodiscard]] Result<VoEstimate> track(const VoFrame& frame) override;
  void set_debug(bool wanted) override { debug_ = wanted; }
  [[nodiscard]] std::vector<std::string> take_log() override { return log_->take(); }
  [[nodiscard]] std::optional<ResourceUse> resource_use() const override {
    return node_use_->use();
  }

 private:
  using Clock = AnswerPatience::Clock;

  [[nodiscard]] TopicHandlers handlers();
  void take_pose(std::int64_t stamp_ns,
                 const std::optional<Pose>& published,
                 std::span<const double> covariance);
  void report_strays();
  /// Waits until the node advertises its poses, so that no frame is lost. Nodes do this after
  /// loading, some only after they received the calibration.
  /// Errors: kCancelled.
  Status await_readiness(const VoFrame& frame, std::int64_t stamp_ns);
  [[nodiscard]] Status await_estimator();
  [[nodiscard]] Error gone() const;
  /// Waits for `done`, `end` or a cancellation. @return whether `done`
  template <typename Condition>
  [[nodiscard]] bool wait_until(Clock::time_point end, const Condition& done) const;
  /// Errors: kCancelled.
  [[nodiscard]] Result<VoEstimate> exchange(const VoFrame& frame, std::int64_t stamp_ns);
  void add_debug_image(const VoFrame& frame, std::int64_t stamp_ns, VoEstimate& estimate);
  /// ROS time of a frame. It never runs backwards and is never 0, which means "no time" in ROS. The
  /// first frame sets the offset.
  /// Errors: kInvalidArgument naming stamp and limit.
  [[nodiscard]] Result<std::int64_t> stamp_of(const VoFrame& frame);

  Node& node_;
  const Ros1EstimatorOptions options_;
  const std::shared_ptr<LineLog> log_ = std::make_shared<LineLog>();
  StampedAnswers answers_{kStampToleranceNs};
  AnswerPatience patience_;
  DebugImages debug_images_;
  std::atomic<bool> debug_ = false;
  PoseIntake poses_;
  AnswerCounts reported_;  ///< stray answers logged so far; used by the topics' thread
  std::optional<VoFrame> previous_;
  bool ready_ = false;
  bool tracked_ = false;
  std::int64_t offset_ns_;
  std::optional<Clock::time_point> alone_since_;
  std::optional<Error> ended_;
  // Last, so that no callback runs while the other members are destroyed.
  std::unique_ptr<Topics> topics_;
  std::unique_ptr<NodeUse> node_use_;  ///< updated by the watch
  std::unique_ptr<MasterWatch> watch_;
};

}  // namespace overfly::ros1
