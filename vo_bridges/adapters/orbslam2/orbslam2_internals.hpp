// Members of ORB-SLAM2 without accessors that the adapter reads or sets. C++11.
#pragma once

#include <FrameDrawer.h>
#include <LocalMapping.h>
#include <LoopClosing.h>
#include <Map.h>
#include <ORBextractor.h>
#include <System.h>
#include <Tracking.h>

#include "vo_bridges/adapters/private_member.hpp"

namespace overfly_adapters {

#define OVERFLY_PRIVATE_MEMBER(TAG, CLASS, TYPE, MEMBER) \
  struct TAG {                                           \
    using Pointer = TYPE CLASS::*;                       \
    friend Pointer member_of(TAG);                       \
  };                                                     \
  template struct PrivateMember<TAG, &CLASS::MEMBER>;

OVERFLY_PRIVATE_MEMBER(SystemTracker, ORB_SLAM2::System, ORB_SLAM2::Tracking*, mpTracker)
OVERFLY_PRIVATE_MEMBER(SystemMapper, ORB_SLAM2::System, ORB_SLAM2::LocalMapping*, mpLocalMapper)
OVERFLY_PRIVATE_MEMBER(SystemLoopCloser, ORB_SLAM2::System, ORB_SLAM2::LoopClosing*, mpLoopCloser)
OVERFLY_PRIVATE_MEMBER(SystemDrawer, ORB_SLAM2::System, ORB_SLAM2::FrameDrawer*, mpFrameDrawer)
OVERFLY_PRIVATE_MEMBER(SystemMap, ORB_SLAM2::System, ORB_SLAM2::Map*, mpMap)
OVERFLY_PRIVATE_MEMBER(TrackerExtractor,
                       ORB_SLAM2::Tracking,
                       ORB_SLAM2::ORBextractor*,
                       mpORBextractorLeft)
OVERFLY_PRIVATE_MEMBER(ExtractorFeatures, ORB_SLAM2::ORBextractor, int, nfeatures)
OVERFLY_PRIVATE_MEMBER(ExtractorIniThFast, ORB_SLAM2::ORBextractor, int, iniThFAST)
OVERFLY_PRIVATE_MEMBER(ExtractorMinThFast, ORB_SLAM2::ORBextractor, int, minThFAST)
OVERFLY_PRIVATE_MEMBER(LoopCloserLast, ORB_SLAM2::LoopClosing, long unsigned int, mLastLoopKFid)

#undef OVERFLY_PRIVATE_MEMBER

}  // namespace overfly_adapters
