// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "kestrel/core/base/limits.h"
#include "kestrel/core/base/time.h"
#include "kestrel/core/geometry/rigid_transform.h"
#include "kestrel/core/poses/pose_history.h"
#include "kestrel/simulation/autopilots/object_field.h"
#include "kestrel/simulation/autopilots/room.h"
#include "kestrel/simulation/scene/follow_scene.h"
#include "kestrel/simulation/scene/landing_scene.h"
#include "kestrel/simulation/scene/vehicle_scenarios.h"
#include "kestrel/vision/landing/landing_pattern.h"

namespace kestrel {

// The vehicle with the pattern in the autopilot's local frame (ENU), driving in real time; or a
// thing to follow, which has the vehicle's motion, and no pad; or a field of objects.
struct VehicleWorldOptions : LandingSceneOptions {
  VehicleWorldOptions();

  FollowedThingOptions thing;
  ObjectFieldOptions field;
  RoomOptions room;
  double drive_altitude_m = 0;
  double drive_delay_s = 0;
  double drive_acceleration = 1;
  double start_s = 0;

  static void Visit(auto& self, auto&& visit) {
    visit.Group("thing", self.thing);
    visit.Group("field", self.field);
    visit.Group("room", self.room);
    visit("drive_altitude_m", self.drive_altitude_m, Range{0, 1000},
          "height of the UAV that the vehicle waits for; 0: it drives all the time");
    visit("drive_delay_s", self.drive_delay_s, Range{0, 1000},
          "further wait before the vehicle drives off");
    visit("drive_acceleration", self.drive_acceleration, Range{0.1, 10},
          "[m/s^2] acceleration of the vehicle when it drives off");
    visit("start_s", self.start_s, Range{0, 1e9},
          "start on this computer's steady clock, for programs that share a world; 0: now");
    LandingSceneOptions::Visit(self, visit);
  }
};

// Returns the options of a scenario (standing, straight, circle, figure8, ...) with the pad
// 'target', changed by the settings "key=value". Throws InputError when the scenario does not
// exist, a setting is wrong, or the result is not valid.
VehicleWorldOptions ReadVehicleWorld(const std::string& scenario,
                                     const std::vector<std::string>& settings,
                                     const TargetOptions& target = {});

// World shared by the simulated camera and the simulated autopilot: one vehicle, on one clock. The
// options and the seed determine its scene. Thread-safe.
class VehicleWorld {
 public:
  // Time 0 of the scene is at 'start' on the local clock, unless the options set it. Throws
  // InputError when the options are not valid.
  VehicleWorld(const VehicleWorldOptions& options, Time start, std::uint64_t seed);
  VehicleWorld(const VehicleWorld&) = delete;  // the scene's motions refer to it
  VehicleWorld& operator=(const VehicleWorld&) = delete;

  // Seconds since the start: the time of the scene's motions.
  double SceneTime(Time time) const { return ToSeconds(time - start_); }

  RigidTransform PatternAt(Time time) const;    // world_from_pattern
  Eigen::Vector3d VelocityAt(Time time) const;  // pattern's centre in the world, m/s

  // True when a point of the pattern's plane (in the pattern's frame) is on the board.
  bool IsOnBoard(const Eigen::Vector3d& point_in_pattern) const;

  // Reports the position of a UAV, for a vehicle that waits for it.
  void ObserveUav(Time time, const Eigen::Vector3d& position_in_world);

  // The true poses of a UAV that is simulated beside this world, and the attitude of the platform
  // of its gimbal (world_from_platform; nothing: it has none), from the autopilot to the camera:
  // they take no time.
  using PlatformAttitude = std::optional<Eigen::Quaterniond>;
  using PoseListener =
      std::function<void(const PoseSample& pose, const PlatformAttitude& platform)>;
  // 'owner': by which the listener is known; one that is empty ends its listening.
  void ListenToPoses(const void* owner, PoseListener listener);
  void ReportPose(const PoseSample& pose, const PlatformAttitude& platform = std::nullopt);

  const LandingScene& scene() const { return scene_; }
  ObjectField& field() { return field_; }  // without objects where there is none
  const VehicleWorldOptions& options() const { return options_; }

 private:
  double DrivenTime(double scene_time_s) const;

  VehicleWorldOptions options_;
  Time start_;
  std::atomic<double> departure_s_;  // scene time; infinite while it waits
  ObjectField field_;
  LandingScene scene_;
  std::mutex listener_mutex_;
  std::map<const void*, PoseListener> listeners_;
};

}  // namespace kestrel
