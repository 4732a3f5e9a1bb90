#pragma once

namespace ORB_SLAM2 {

class ORBextractor {
 public:
  ORBextractor(int nfeatures, float scaleFactor, int nlevels, int iniThFAST, int minThFAST)
      : nfeatures(nfeatures),
        scaleFactor(scaleFactor),
        nlevels(nlevels),
        iniThFAST(iniThFAST),
        minThFAST(minThFAST) {}
  int GetLevels() { return nlevels; }
  float GetScaleFactor() { return static_cast<float>(scaleFactor); }

 protected:
  int nfeatures;
  double scaleFactor;
  int nlevels;
  int iniThFAST;
  int minThFAST;
};

}  // namespace ORB_SLAM2
