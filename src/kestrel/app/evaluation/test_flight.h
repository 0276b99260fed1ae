// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <fmt/format.h>

#include "kestrel/core/base/test_folder.h"
#include "kestrel/core/base/time.h"

namespace kestrel {

// A recording without images: a camera of 400 px focal length that hovers 4 m above the origin and
// looks straight down (x of the camera to -y of the world, y to -x); images every 0.1 s.
class TestFlight {
 public:
  explicit TestFlight(int frames = 5) {
    std::string images = "#timestamp [ns],filename\n";
    std::string poses =
        "#timestamp [ns],p_RS_R_x [m],p_RS_R_y [m],p_RS_R_z [m],q_RS_w [],q_RS_x [],q_RS_y "
        "[],q_RS_z []\n";
    for (int i = 0; i < frames; ++i) {
      images += fmt::format("{0},{0}.png\n", TimeNs(i));
      poses += fmt::format("{},0,0,4,1,0,0,0\n", TimeNs(i));
    }
    folder_.Write("flight/mav0/cam0/data.csv", images);
    folder_.Write("flight/mav0/state_groundtruth_estimate0/data.csv", poses);
    folder_.Write(
        "flight/mav0/cam0/sensor.yaml",
        "T_BS:\n  rows: 4\n  cols: 4\n  data: [0, -1, 0, 0, -1, 0, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1]\n"
        "resolution: [640, 480]\ncamera_model: pinhole\nintrinsics: [400, 400, 320, 240]\n"
        "distortion_model: none\ndistortion_coefficients: []\n");
  }

  static long TimeNs(int frame) { return 100'000'000L * (frame + 1); }

  std::string recording() const { return folder_ / "flight"; }
  std::string output() const { return folder_ / "output"; }

  // Write files of the truth, below mav0, and of the results.
  void WriteTruth(const std::string& name, const std::string& text) const {
    folder_.Write("flight/mav0/" + name, text);
  }
  void WriteResult(const std::string& name, const std::string& text) const {
    folder_.Write("output/" + name, text);
  }

 private:
  TestFolder folder_;
};

inline Time FrameTime(int frame) { return TimeFromNanoseconds(TestFlight::TimeNs(frame)); }

inline constexpr char kPatternHeader[] =
    "#timestamp [ns],p_WP_W_x [m],p_WP_W_y [m],p_WP_W_z [m],q_WP_w [],q_WP_x [],q_WP_y [],q_WP_z "
    "[],v_WP_W_x [m s^-1],v_WP_W_y [m s^-1],v_WP_W_z [m s^-1],u [px],v [px],altitude "
    "[m],visible_fraction []\n";
inline constexpr char kDetectionHeader[] =
    "frame,timestamp_ns,detected,u_px,v_px,method,quality,p_CP_C_x_m,p_CP_C_y_m,p_CP_C_z_m,"
    "p_WP_W_x_m,p_WP_W_y_m,p_WP_W_z_m,yaw_WP_rad,sigma_x_m,sigma_y_m,sigma_z_m,rejected_at,"
    "detect_ms\n";

}  // namespace kestrel
