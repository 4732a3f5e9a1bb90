// The Pangolin type named by ORB-SLAM2's headers: enough to call the library without its viewer.
#pragma once

namespace pangolin {

struct OpenGlMatrix;

}  // namespace pangolin
