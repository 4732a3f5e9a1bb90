#include <FullSystem/FullSystem.h>
#include <FullSystem/HessianBlocks.h>
#include <util/globalCalib.h>

#include <cstdlib>

#include "tests/vo_bridges/standins/flown_path.hpp"

namespace dso {

int pyrLevelsUsed = PYR_LEVELS;
float setting_minGradHistAdd = 7;
float setting_minGradHistCut = 0.5F;
float setting_desiredImmatureDensity = 1500;
float setting_desiredPointDensity = 2000;
float setting_kfGlobalWeight = 1;
int setting_minFrames = 5;
int setting_maxFrames = 7;
int setting_maxOptIterations = 6;
int setting_minOptIterations = 1;
int setting_photometricCalibration = 2;
float setting_affineOptModeA = 1e12F;
float setting_affineOptModeB = 1e8F;
bool setting_logStuff = true;
bool setting_debugout_runquiet = false;
bool disableAllDisplay = false;
bool multiThreading = true;
int benchmarkSetting_width = 0;
int benchmarkSetting_height = 0;

int wG[PYR_LEVELS], hG[PYR_LEVELS];
float fxG[PYR_LEVELS], fyG[PYR_LEVELS], cxG[PYR_LEVELS], cyG[PYR_LEVELS];

void setGlobalCalib(int w, int h, const Eigen::Matrix3f& K) {
  // As upstream's fast presets do, where nobody looks.
  if (std::getenv("STANDIN_RESIZES") != nullptr) {
    w = 424;
    h = 320;
  }
  if (std::getenv("STANDIN_KEEPS_ITS_DEFAULT") != nullptr) setting_minGradHistAdd = 7;
  pyrLevelsUsed = 1;
  for (int wide = w, high = h; wide % 2 == 0 && high % 2 == 0 && wide * high > 5000;
       wide /= 2, high /= 2) {
    ++pyrLevelsUsed;
  }
  wG[0] = w;
  hG[0] = h;
  fxG[0] = K(0, 0);
  fyG[0] = K(1, 1);
  cxG[0] = K(0, 2);
  cyG[0] = K(1, 2);
}

void FullSystem::publish_keyframe(FrameShell* shell) {
  std::vector<PointHessian> points;
  for (int i = -20; i <= 20; ++i) {
    points.push_back({cxG[0] + 2.0F * static_cast<float>(i),
                      cyG[0] + 5.0F,
                      static_cast<float>(1.0 / standins::kDepth)});
  }
  FrameHessian frame{shell, keyframes_++, {}};
  for (PointHessian& point : points) frame.pointHessians.push_back(&point);
  CalibHessian calibration{{fxG[0], fyG[0], cxG[0], cyG[0]}};
  std::vector<FrameHessian*> frames = {&frame};
  for (IOWrap::Output3DWrapper* out : outputWrapper) {
    out->publishKeyframes(frames, false, &calibration);
  }
}

void FullSystem::addActiveFrame(ImageAndExposure* image, int id) {
  if (isLost) return;
  const int order = static_cast<int>(image->image[0]);
  if (order == standins::kExit) std::exit(3);
  if (order == standins::kAbort) std::abort();
  shells_.push_back(std::unique_ptr<FrameShell>(new FrameShell));
  FrameShell* shell = shells_.back().get();
  shell->incoming_id = id;
  if (order == standins::kDark) {
    isLost = true;
    return;
  }
  if (order == standins::kThrowMapAway) initFailed = true;
  const SE3 truth(standins::orientation_at(image->timestamp),
                  standins::position_at(image->timestamp));
  if (!initialized) {
    initialized = ++frames_ == 3;
    shell->poseValid = initialized;
    if (!initialized) return;
    shell->camToWorld = truth;
    publish_keyframe(shell);
    return;
  }
  // Tracked a little wrong; mapping, which comes after it, puts it right.
  shell->camToWorld =
      SE3(truth.unit_quaternion(), truth.translation() + Eigen::Vector3d(0.1, 0, 0));
  CalibHessian calibration{{fxG[0], fyG[0], cxG[0], cyG[0]}};
  for (IOWrap::Output3DWrapper* out : outputWrapper) out->publishCamPose(shell, &calibration);
  shell->camToWorld = truth;
  publish_keyframe(shell);
}

}  // namespace dso
