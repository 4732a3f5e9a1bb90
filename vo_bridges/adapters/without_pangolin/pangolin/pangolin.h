// What ORB-SLAM2's own headers name of Pangolin: enough to call the library without its viewer.
#pragma once

namespace pangolin {

struct OpenGlMatrix;

}  // namespace pangolin
