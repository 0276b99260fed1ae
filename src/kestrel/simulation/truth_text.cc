// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/truth_text.h"

#include <algorithm>
#include <sstream>

#include <fmt/format.h>

#include "kestrel/flight/flight_time.h"
#include "kestrel/rendering/pattern_visibility.h"
#include "kestrel/simulation/recording_plan.h"

namespace kestrel {
namespace {

constexpr const char* kPoseColumns =
    "#timestamp [ns],p_RS_R_x [m],p_RS_R_y [m],p_RS_R_z [m],"
    "q_RS_w [],q_RS_x [],q_RS_y [],q_RS_z []";

std::string PoseCells(Time time, const RigidTransform& pose) {
  const Eigen::Vector3d& p = pose.translation;
  const Eigen::Quaterniond& q = pose.rotation;
  return fmt::format("{},{:.6f},{:.6f},{:.6f},{:.9f},{:.9f},{:.9f},{:.9f}", ToNanoseconds(time),
                     p.x(), p.y(), p.z(), q.w(), q.x(), q.y(), q.z());
}

}  // namespace

std::string Indented(const std::string& lines) {
  std::string indented;
  std::istringstream stream(lines);
  for (std::string line; std::getline(stream, line);) indented += "  " + line + "\n";
  return indented;
}

std::string TrueStateText(const Motion& world_from_body, double begin_s, double end_s,
                          const std::vector<double>& image_times_s) {
  constexpr double kStep_s = 0.01;
  std::vector<double> times_s = image_times_s;
  for (int i = 0; begin_s + i * kStep_s <= end_s; ++i) times_s.push_back(begin_s + i * kStep_s);
  std::sort(times_s.begin(), times_s.end());
  std::string text =
      fmt::format("{},v_RS_R_x [m s^-1],v_RS_R_y [m s^-1],v_RS_R_z [m s^-1]\n", kPoseColumns);
  Time last = TimeOfFlight(times_s.front()) - Duration(1);
  for (const double time_s : times_s) {
    const Time time = TimeOfFlight(time_s);
    if (time == last) continue;
    last = time;
    const Eigen::Vector3d v = VelocityOf(world_from_body, time_s);
    text += fmt::format("{},{:.6f},{:.6f},{:.6f}\n", PoseCells(time, world_from_body(time_s)),
                        v.x(), v.y(), v.z());
  }
  return text;
}

std::string TrueStateText(const std::vector<PoseSample>& poses) {
  std::string text = fmt::format("{}\n", kPoseColumns);
  for (const PoseSample& pose : poses) text += PoseCells(pose.time, pose.world_from_body) + "\n";
  return text;
}

std::string LandingTruthHeader() {
  return "#timestamp [ns],p_WP_W_x [m],p_WP_W_y [m],p_WP_W_z [m],"
         "q_WP_w [],q_WP_x [],q_WP_y [],q_WP_z [],"
         "v_WP_W_x [m s^-1],v_WP_W_y [m s^-1],v_WP_W_z [m s^-1],"
         "u [px],v [px],altitude [m],visible_fraction []\n";
}

std::string LandingTruthRow(Time stamp, double time_s, const FlightCamera& camera,
                            const LandingPattern& pattern, const Motion& world_from_pattern) {
  const RigidTransform pose = world_from_pattern(time_s);
  const auto pixel = camera.Project(
      time_s, [&](double row_time_s) { return world_from_pattern(row_time_s).translation; });
  if (!pixel) return "";
  const RigidTransform pattern_from_camera = pose.Inverse() * camera.WorldFromCamera(time_s);
  const Eigen::Vector3d v = VelocityOf(world_from_pattern, time_s);
  const double visible = VisibleFraction(pattern, pattern_from_camera.Inverse(), camera.lens());
  return fmt::format("{},{:.6f},{:.6f},{:.6f},{:.4f},{:.4f},{:.6f},{:.4f}\n",
                     PoseCells(stamp, pose), v.x(), v.y(), v.z(), pixel->x(), pixel->y(),
                     pattern_from_camera.translation.z(), visible);
}

}  // namespace kestrel
