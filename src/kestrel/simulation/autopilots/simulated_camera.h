// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include <opencv2/core/mat.hpp>

#include "kestrel/core/base/limits.h"
#include "kestrel/core/base/time.h"
#include "kestrel/core/camera/calibration.h"
#include "kestrel/core/geometry/rigid_transform.h"
#include "kestrel/core/poses/gimbal_history.h"
#include "kestrel/core/poses/pose_history.h"
#include "kestrel/io/recording/euroc/truth_rows.h"
#include "kestrel/io/recording/frame.h"
#include "kestrel/simulation/autopilots/camera_faults.h"
#include "kestrel/simulation/autopilots/vehicle_world.h"
#include "kestrel/simulation/recordings/zooming_camera.h"
#include "kestrel/simulation/rendering/flight_camera.h"
#include "kestrel/simulation/scene/light_options.h"
#include "kestrel/simulation/scene/world.h"

namespace kestrel {

// A second camera beside the first one, with the same rate and scale.
struct SecondSimulatedCameraOptions {
  double fov_deg = 0;
  double tilt_deg = 0;
  double clock_offset_s = 0;
  CameraFaultOptions fault;

  static void Visit(auto& self, auto&& visit) {
    visit("fov_deg", self.fov_deg, Range{0, 150}, "field of view of a second camera; 0: none");
    visit("tilt_deg", self.tilt_deg, Range{0, 120},
          "where it looks: 0 down, 45 between down and ahead");
    visit("clock_offset_s", self.clock_offset_s, Range{-1, 1}, "as of the first camera");
    visit.Group("fault", self.fault);
  }

  bool is_there() const { return fov_deg > 0; }
};

struct SimulatedCameraOptions {
  SimulatedCameraOptions();

  double rate_hz = 20;
  double scale = 0.5;
  double clock_offset_s = 0;
  double pose_wait_s = 0.4;
  LensViewOptions lens;
  ShutterOptions shutter;
  SensorOptions sensor;
  ZoomOptions zoom;
  CameraFaultOptions fault;
  SecondSimulatedCameraOptions second;

  static void Visit(auto& self, auto&& visit) {
    visit("rate_hz", self.rate_hz, Range{0.1, 200}, "images per second");
    visit("scale", self.scale, Range{0.1, 2}, "size of the image; the paper's 752x480 is 1");
    visit("clock_offset_s", self.clock_offset_s, Range{-1, 1},
          "time of an image minus its stamp; negative: stamps that are late");
    visit("pose_wait_s", self.pose_wait_s, Range{0, 5},
          "longest wait of an image for its pose, after which the pose is extrapolated");
    visit.Group("lens", self.lens);
    visit.Group("shutter", self.shutter);
    visit.Group("sensor", self.sensor);
    visit.Group("zoom", self.zoom);
    visit.Group("fault", self.fault);
    visit.Group("second", self.second);
  }

  // The options of the second camera.
  SimulatedCameraOptions OfSecond() const;
};

// A live camera that is rendered: the view from the UAV over a vehicle that drives in real time.
// The UAV is where the world's simulated autopilot truly is; with another autopilot at its
// reported pose, extrapolated to the image.
class SimulatedCamera {
 public:
  // The world must outlive this. The first image is taken at 'start' on the local clock. 'gimbal':
  // the camera is on one, of which the world's simulated autopilot reports the attitude. Throws
  // InputError when the options are not valid.
  SimulatedCamera(const SimulatedCameraOptions& options, VehicleWorld* world, Time start,
                  std::uint64_t seed, const std::optional<GimbalMount>& gimbal = std::nullopt);
  // A camera with a calibration of its own, on a fixed mount.
  SimulatedCamera(const SimulatedCameraOptions& options, VehicleWorld* world, Time start,
                  std::uint64_t seed, const CameraCalibration& calibration);
  ~SimulatedCamera() { world_.ListenToPoses(this, nullptr); }
  SimulatedCamera(const SimulatedCamera&) = delete;  // the renderer refers to it
  SimulatedCamera& operator=(const SimulatedCamera&) = delete;

  // Adds a reported pose of the UAV, on the local clock; without effect where the world has true
  // ones. Thread-safe; wakes Next.
  void AddPose(const PoseSample& pose);

  // Waits for the next image of the rate and for its pose, and renders it; images whose time has
  // passed meanwhile are left out and counted. False when there is none within 'timeout': no pose
  // has come yet, or the next image is later. One thread at a time.
  bool Next(Frame* frame, Duration timeout);

  // Returns the image taken at 'capture' on the local clock; nothing without a pose near it. Called
  // by the same thread as Next.
  std::optional<Frame> Capture(Time capture);

  // The calibration of the second camera of the options.
  static CameraCalibration CalibrationOfSecond(const SimulatedCameraOptions& options);

  // The nominal calibration: with the mount, without a clock offset.
  const CameraCalibration& calibration() const { return calibration_; }

  // Returns world_from_pattern at the image with that stamp.
  RigidTransform PatternAt(Time stamp) const;

  // Truth of the pattern in the newest frame; nothing when it cannot be in it. Same thread as Next.
  std::optional<TruePattern> Truth(const Frame& frame) const;

  std::int64_t left_out() const { return left_out_; }  // number of images, for lack of time or pose

 private:
  // A pose with its motion during the exposure of one image.
  struct Snapshot {
    double time_s = 0;  // time in the scene
    RigidTransform world_from_body;
    BodyMotion motion;
    Eigen::Quaterniond world_from_platform = Eigen::Quaterniond::Identity();  // with a gimbal
    Eigen::Vector3d platform_rate{0, 0, 0};                                   // in its own frame
    bool is_turned = false;                                                   // the mount is
  };

  void Place(const PoseSample& pose, const VehicleWorld::PlatformAttitude& platform, bool is_true);
  CameraFault FaultAt(Time capture) const;
  bool IsLeftOut(Time capture) const;
  Time NextCapture();
  Time KnownTime();
  void WaitForPose(Time capture, Time deadline);
  RigidTransform BodyAt(double time_s) const;
  RigidTransform CameraAt(double time_s) const;
  bool AddPlatform(Time capture, Snapshot* snapshot) const;
  std::optional<Snapshot> SnapshotAt(Time capture);
  Time StampOf(Time capture) const;
  Time CaptureOf(Time stamp) const;

  SimulatedCameraOptions options_;
  VehicleWorld& world_;
  Time start_;
  std::uint64_t seed_;
  CameraCalibration calibration_;
  World drawn_;  // with the UAV's shadow
  std::unique_ptr<const ZoomingCamera> camera_;
  Snapshot snapshot_;
  cv::Mat last_image_;
  std::int64_t next_ = 0;  // index of the next image
  std::int64_t left_out_ = 0;

  std::mutex mutex_;  // guards what follows
  std::condition_variable pose_came_;
  PoseHistory poses_;
  GimbalHistory platforms_;
  bool has_true_poses_ = false;
  std::optional<PoseSample> newest_pose_;
};

}  // namespace kestrel
