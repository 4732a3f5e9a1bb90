#pragma once

#define PYR_LEVELS 6

namespace dso {

extern int pyrLevelsUsed;
extern float setting_minGradHistAdd;
extern float setting_minGradHistCut;
extern float setting_desiredImmatureDensity;
extern float setting_desiredPointDensity;
extern float setting_kfGlobalWeight;
extern int setting_minFrames;
extern int setting_maxFrames;
extern int setting_maxOptIterations;
extern int setting_minOptIterations;
extern int setting_photometricCalibration;
extern float setting_affineOptModeA;
extern float setting_affineOptModeB;
extern bool setting_logStuff;
extern bool setting_debugout_runquiet;
extern bool disableAllDisplay;
extern bool multiThreading;
extern int benchmarkSetting_width;
extern int benchmarkSetting_height;

}  // namespace dso
