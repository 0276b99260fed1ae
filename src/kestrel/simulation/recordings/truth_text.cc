// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/recordings/truth_text.h"

#include <algorithm>
#include <sstream>

#include <fmt/format.h>

#include "kestrel/io/recording/euroc/euroc_text.h"
#include "kestrel/simulation/recordings/recording_plan.h"
#include "kestrel/simulation/rendering/pattern_visibility.h"
#include "kestrel/simulation/vehicle/flight_time.h"

namespace kestrel {

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
  std::string text = TrueStateHeader();
  Time last = TimeOfFlight(times_s.front()) - Duration(1);
  for (const double time_s : times_s) {
    const Time time = TimeOfFlight(time_s);
    if (time == last) continue;
    last = time;
    const Eigen::Vector3d v = VelocityOf(world_from_body, time_s);
    text += TrueStateRow(time, world_from_body(time_s), v);
  }
  return text;
}

std::string TrueStateText(const std::vector<PoseSample>& poses) {
  std::string text = EurocPoseColumns("RS") + "\n";
  for (const PoseSample& pose : poses) {
    text += EurocPoseCells(pose.time, pose.world_from_body) + "\n";
  }
  return text;
}

std::optional<TruePattern> SeenPattern(Time stamp, double time_s, const FlightCamera& camera,
                                       const TargetPrint& print, const Motion& world_from_pattern) {
  const RigidTransform pose = world_from_pattern(time_s);
  const auto pixel = camera.Project(
      time_s, [&](double row_time_s) { return world_from_pattern(row_time_s).translation; });
  if (!pixel) return std::nullopt;
  const RigidTransform pattern_from_camera = pose.Inverse() * camera.WorldFromCamera(time_s);
  return TruePattern{stamp,
                     pose,
                     VelocityOf(world_from_pattern, time_s),
                     *pixel,
                     pattern_from_camera.translation.z(),
                     VisibleFraction(print, pattern_from_camera.Inverse(), camera.lens())};
}

}  // namespace kestrel
