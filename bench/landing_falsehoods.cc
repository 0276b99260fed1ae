// SPDX-License-Identifier: BSD-3-Clause
#include "landing_falsehoods.h"

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "for_each_index.h"
#include "landing_score.h"

namespace kestrel {
namespace {

template <int kPercent>
CameraIntrinsics WithFocalLength(CameraIntrinsics camera) {
  camera.fx_px *= 1 + kPercent / 100.0;
  camera.fy_px *= 1 + kPercent / 100.0;
  return camera;
}

template <int kPixels>
CameraIntrinsics WithPrincipalPoint(CameraIntrinsics camera) {
  camera.cx_px += 0.8 * kPixels;
  camera.cy_px -= 0.6 * kPixels;
  return camera;
}

CameraIntrinsics WithoutDistortion(CameraIntrinsics camera) {
  std::fill(camera.distortion.begin(), camera.distortion.end(), 0.0);
  return camera;
}

constexpr std::array kCalibrationErrors = {
    CalibrationError{"right", WithFocalLength<0>},
    CalibrationError{"focal length -30 %", WithFocalLength<-30>},
    CalibrationError{"focal length -20 %", WithFocalLength<-20>},
    CalibrationError{"focal length -10 %", WithFocalLength<-10>},
    CalibrationError{"focal length +10 %", WithFocalLength<10>},
    CalibrationError{"focal length +20 %", WithFocalLength<20>},
    CalibrationError{"focal length +30 %", WithFocalLength<30>},
    CalibrationError{"principal point off by 20 px", WithPrincipalPoint<20>},
    CalibrationError{"principal point off by 40 px", WithPrincipalPoint<40>},
    CalibrationError{"distortion left out", WithoutDistortion},
};

constexpr std::array kPrintErrors = {
    PrintError{"flat", 0, 0, 0},
    PrintError{"bulges by 3 %", 0.03, 0, 0},
    PrintError{"sags by 3 %", -0.03, 0, 0},
    PrintError{"folded, creases of 2 %", 0, 0.02, 0},
    PrintError{"skewed by 5 % (rolling shutter)", 0, 0, 0.05},
};

TargetHint Nothing(const LandingFrame& /*frame*/) { return {}; }

TargetHint Attitude(const LandingFrame& frame) {
  TargetHint hint;
  hint.up_in_camera = frame.up_in_camera;
  return hint;
}

template <int kMetres>
TargetHint AltitudePlus(const LandingFrame& frame) {
  TargetHint hint = Attitude(frame);
  hint.altitude_m = frame.altitude_m + kMetres;
  return hint;
}

template <int kTimes>
TargetHint AltitudeTimes(const LandingFrame& frame) {
  TargetHint hint = Attitude(frame);
  hint.altitude_m = frame.altitude_m * kTimes;
  return hint;
}

TargetHint UpsideDown(const LandingFrame& frame) {
  TargetHint hint = AltitudePlus<0>(frame);
  hint.up_in_camera = -*hint.up_in_camera;
  return hint;
}

TargetHint TurnedRound(const LandingFrame& frame) {
  TargetHint hint = AltitudePlus<0>(frame);
  hint.up_in_camera->head<2>() *= -1;
  return hint;
}

TargetHint TiltedBy30Degrees(const LandingFrame& frame) {
  constexpr double kTilt = 0.5236;
  TargetHint hint = AltitudePlus<0>(frame);
  hint.up_in_camera = Eigen::AngleAxisd(kTilt, Eigen::Vector3d::UnitX()) * *hint.up_in_camera;
  return hint;
}

TargetHint CenterElsewhere(const LandingFrame& frame) {
  TargetHint hint = Attitude(frame);
  hint.center_in_camera = frame.camera_from_target->translation;
  hint.center_in_camera->x() += 0.5 * frame.altitude_m;
  hint.center_sigma_m = 0.1;
  return hint;
}

TargetHint CenterTwiceAsFar(const LandingFrame& frame) {
  TargetHint hint = Attitude(frame);
  hint.center_in_camera = 2 * frame.camera_from_target->translation;
  hint.center_sigma_m = 0.1;
  return hint;
}

constexpr std::array kGivenHints = {
    GivenHint{"nothing", Nothing},
    GivenHint{"attitude", Attitude},
    GivenHint{"attitude and altitude", AltitudePlus<0>},
    GivenHint{"altitude 10 m too high", AltitudePlus<10>},
    GivenHint{"altitude 500 m too high (sea level)", AltitudePlus<500>},
    GivenHint{"altitude three times too high", AltitudeTimes<3>},
    GivenHint{"altitude negative", AltitudePlus<-20>},
    GivenHint{"camera upside down", UpsideDown},
    GivenHint{"camera turned round by 180 degrees", TurnedRound},
    GivenHint{"attitude wrong by 30 degrees", TiltedBy30Degrees},
    GivenHint{"track elsewhere", CenterElsewhere},
    GivenHint{"track at twice the distance", CenterTwiceAsFar},
};

}  // namespace

std::vector<LandingStillMaker> StillMakers(const PrintError& print) {
  std::vector<LandingStillMaker> makers;
  for (const AltitudeBin& bin : kAltitudeBins) {
    LandingStillOptions options;
    options.min_altitude_m = bin.min_m;
    options.max_altitude_m = bin.max_m;
    options.bulge = print.bulge;
    options.fold = print.fold;
    options.rolling_skew = print.rolling_skew;
    makers.emplace_back(options);
  }
  return makers;
}

LandingFrameSet RenderStills(int per_altitude, const PrintError& print, int threads) {
  constexpr std::uint64_t kFirstSeed = 5'000'000, kSeedsOfAltitude = 1'000'000;
  LandingFrameSet set{std::string(print.name), PaperCamera(), {}};
  const std::vector<LandingStillMaker> makers = StillMakers(print);
  const auto stills = static_cast<std::size_t>(per_altitude);
  set.frames.resize(stills * makers.size());
  ForEachIndex(set.frames.size(), threads, [&](std::size_t i) {
    const std::size_t bin = i / stills;
    set.frames[i] = FrameFromStill(makers[bin], kAltitudeBins[bin].Name(),
                                   kFirstSeed + kSeedsOfAltitude * bin + i % stills);
  });
  return set;
}

std::span<const CalibrationError> CalibrationErrors() { return kCalibrationErrors; }
std::span<const PrintError> PrintErrors() { return kPrintErrors; }
std::span<const GivenHint> GivenHints() { return kGivenHints; }

}  // namespace kestrel
