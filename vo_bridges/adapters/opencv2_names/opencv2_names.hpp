// Names of OpenCV 2 and 3 used by older sources (CV_BGR2GRAY, CV_RANSAC, CV_SVD,
// CV_WINDOW_AUTOSIZE, ...) for OpenCV 4, which keeps them in headers that are not included by
// default. Include it before everything else: g++ -include opencv2_names.hpp
#pragma once

#ifdef __cplusplus
// usleep and similar functions, which such sources use without including them.
#include <unistd.h>

#if __has_include(<opencv2/imgproc/imgproc_c.h>)
#include <opencv2/core/core_c.h>
#include <opencv2/imgproc/imgproc_c.h>
#endif
#if __has_include(<opencv2/calib3d/calib3d_c.h>)
#include <opencv2/calib3d/calib3d_c.h>
#endif
#if __has_include(<opencv2/highgui/highgui_c.h>)
#include <opencv2/highgui/highgui_c.h>
#endif
#endif
