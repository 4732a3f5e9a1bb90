// Replaces the OpenCV 2 header of this name, which OpenCV 4 no longer has.
#pragma once

#include <opencv2/calib3d/calib3d.hpp>
#include <opencv2/core/core.hpp>
#include <opencv2/features2d/features2d.hpp>
#include <opencv2/imgproc/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

#include "../opencv2_names.hpp"
