#pragma once

#include <Eigen/Core>

#include "settings.h"

namespace dso {

extern int wG[PYR_LEVELS], hG[PYR_LEVELS];
extern float fxG[PYR_LEVELS], fyG[PYR_LEVELS], cxG[PYR_LEVELS], cyG[PYR_LEVELS];

void setGlobalCalib(int w, int h, const Eigen::Matrix3f& K);

}  // namespace dso
