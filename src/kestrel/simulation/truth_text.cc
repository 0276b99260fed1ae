// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/truth_text.h"

#include <algorithm>
#include <sstream>

#include <fmt/format.h>

#include "kestrel/simulation/recording_plan.h"

namespace kestrel {

std::string Indented(const std::string& lines) {
  std::string indented;
  std::istringstream stream(lines);
  for (std::string line; std::getline(stream, line);) indented += "  " + line + "\n";
  return indented;
}

Eigen::Vector3d VelocityOf(const Motion& world_from_body, double time_s) {
  constexpr double kStep_s = 1e-3;
  return (world_from_body(time_s + kStep_s).translation -
          world_from_body(time_s - kStep_s).translation) /
         (2 * kStep_s);
}

std::string TrueStateText(const Motion& world_from_body, double begin_s, double end_s,
                          const std::vector<double>& image_times_s) {
  constexpr double kStep_s = 0.01;
  std::vector<double> times_s = image_times_s;
  for (int i = 0; begin_s + i * kStep_s <= end_s; ++i) times_s.push_back(begin_s + i * kStep_s);
  std::sort(times_s.begin(), times_s.end());
  std::string text =
      "#timestamp [ns],p_RS_R_x [m],p_RS_R_y [m],p_RS_R_z [m],"
      "q_RS_w [],q_RS_x [],q_RS_y [],q_RS_z [],"
      "v_RS_R_x [m s^-1],v_RS_R_y [m s^-1],v_RS_R_z [m s^-1]\n";
  Time last = TimeOfFlight(times_s.front()) - Duration(1);
  for (const double time_s : times_s) {
    const Time time = TimeOfFlight(time_s);
    if (time == last) continue;
    last = time;
    const RigidTransform pose = world_from_body(time_s);
    const Eigen::Vector3d& p = pose.translation;
    const Eigen::Quaterniond& q = pose.rotation;
    const Eigen::Vector3d v = VelocityOf(world_from_body, time_s);
    text += fmt::format(
        "{},{:.6f},{:.6f},{:.6f},{:.9f},{:.9f},{:.9f},{:.9f},{:.6f},{:.6f},{:.6f}\n",
        ToNanoseconds(time), p.x(), p.y(), p.z(), q.w(), q.x(), q.y(), q.z(), v.x(), v.y(), v.z());
  }
  return text;
}

}  // namespace kestrel
