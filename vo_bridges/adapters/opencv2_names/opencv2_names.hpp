// Names of OpenCV 2 and 3 that sources of their time use (CV_BGR2GRAY, CV_RANSAC, CV_SVD,
// CV_WINDOW_AUTOSIZE, ...), for OpenCV 4, which keeps them in headers that nothing else includes.
// To be included in front of everything: g++ -include opencv2_names.hpp
#pragma once

#ifdef __cplusplus
// usleep and the like, which such sources take for granted.
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
