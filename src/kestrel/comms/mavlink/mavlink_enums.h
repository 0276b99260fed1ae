// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

// Values of MAVLink's enums that Kestrel uses.
namespace kestrel::mavlink {

// MAV_TYPE
inline constexpr std::uint8_t kTypeFixedWing = 1;
inline constexpr std::uint8_t kTypeQuadrotor = 2;
inline constexpr std::uint8_t kTypeCoaxial = 3;
inline constexpr std::uint8_t kTypeHelicopter = 4;
inline constexpr std::uint8_t kTypeGcs = 6;
inline constexpr std::uint8_t kTypeGroundRover = 10;
inline constexpr std::uint8_t kTypeSurfaceBoat = 11;
inline constexpr std::uint8_t kTypeSubmarine = 12;
inline constexpr std::uint8_t kTypeHexarotor = 13;
inline constexpr std::uint8_t kTypeOctorotor = 14;
inline constexpr std::uint8_t kTypeTricopter = 15;
inline constexpr std::uint8_t kTypeOnboardController = 18;
inline constexpr std::uint8_t kTypeVtolFirst = 19;  // to kTypeVtolLast: with wings and rotors
inline constexpr std::uint8_t kTypeVtolLast = 25;
inline constexpr std::uint8_t kTypeDodecarotor = 29;
inline constexpr std::uint8_t kTypeCamera = 30;
inline constexpr std::uint8_t kTypeDecarotor = 35;

// MAV_AUTOPILOT
inline constexpr std::uint8_t kAutopilotArduPilot = 3;
inline constexpr std::uint8_t kAutopilotInvalid = 8;  // the sender is not an autopilot
inline constexpr std::uint8_t kAutopilotPx4 = 12;

// MAV_COMPONENT
inline constexpr std::uint8_t kComponentAutopilot = 1;
inline constexpr std::uint8_t kComponentCamera = 100;

// GIMBAL_DEVICE_FLAGS and GIMBAL_MANAGER_FLAGS
inline constexpr std::uint16_t kGimbalRollLock = 4;
inline constexpr std::uint16_t kGimbalPitchLock = 8;
inline constexpr std::uint16_t kGimbalYawLock = 16;
inline constexpr std::uint16_t kGimbalYawInVehicleFrame = 32;
inline constexpr std::uint16_t kGimbalYawInEarthFrame = 64;
// Gimbals and cameras up to this device id are behind the autopilot, the others are components.
inline constexpr int kLastDeviceBehindAutopilot = 6;

// CAMERA_CAP_FLAGS
inline constexpr std::uint32_t kCameraHasStream = 256;
inline constexpr std::uint32_t kCameraTracksPoint = 512;
inline constexpr std::uint32_t kCameraTracksRectangle = 1024;
inline constexpr std::uint32_t kCameraTracksOnEarth = 2048;

// CAMERA_MODE, VIDEO_STREAM_STATUS_FLAGS, VIDEO_STREAM_ENCODING
inline constexpr std::uint8_t kCameraModeVideo = 1;
inline constexpr std::uint16_t kStreamIsRunning = 1;
inline constexpr std::uint8_t kStreamH264 = 1;

// CAMERA_TRACKING_STATUS_FLAGS, CAMERA_TRACKING_MODE, CAMERA_TRACKING_TARGET_DATA
inline constexpr std::uint8_t kTrackingActive = 1;
inline constexpr std::uint8_t kTrackingError = 2;
inline constexpr std::uint8_t kTrackingCoasting = 8;
inline constexpr std::uint8_t kTrackingRectangle = 2;
inline constexpr std::uint8_t kTargetRendered = 2;
inline constexpr std::uint8_t kTargetInStatus = 4;

// MAV_MODE_FLAG
inline constexpr std::uint8_t kModeFlagCustom = 1;
inline constexpr std::uint8_t kModeFlagArmed = 128;

// MAV_STATE
inline constexpr std::uint8_t kStateStandby = 3;
inline constexpr std::uint8_t kStateActive = 4;
inline constexpr std::uint8_t kStateCritical = 5;
inline constexpr std::uint8_t kStateEmergency = 6;

// MAV_SYS_STATUS_SENSOR: the receiver of a transmitter
inline constexpr std::uint32_t kSensorReceiver = 0x10000;

// MAV_CMD
inline constexpr std::uint16_t kCommandLand = 21;
inline constexpr std::uint16_t kCommandTakeOff = 22;
inline constexpr std::uint16_t kCommandDoSetMode = 176;
inline constexpr std::uint16_t kCommandGripper = 211;
inline constexpr std::uint16_t kCommandArmDisarm = 400;
inline constexpr std::uint16_t kCommandGetMessageInterval = 510;
inline constexpr std::uint16_t kCommandSetMessageInterval = 511;
inline constexpr std::uint16_t kCommandRequestMessage = 512;
// Older requests of one message each, which ground stations still send.
inline constexpr std::uint16_t kCommandRequestCameraInformation = 521;
inline constexpr std::uint16_t kCommandRequestCameraSettings = 522;
inline constexpr std::uint16_t kCommandRequestCaptureStatus = 527;
inline constexpr std::uint16_t kCommandRequestStreamInformation = 2504;
inline constexpr std::uint16_t kCommandRequestStreamStatus = 2505;
inline constexpr std::uint16_t kCommandGimbalPitchyaw = 1000;
inline constexpr std::uint16_t kCommandGimbalConfigure = 1001;
inline constexpr std::uint16_t kCommandTrackPoint = 2004;
inline constexpr std::uint16_t kCommandTrackRectangle = 2005;
inline constexpr std::uint16_t kCommandStopTracking = 2010;

// MAV_RESULT
inline constexpr std::uint8_t kResultAccepted = 0;
inline constexpr std::uint8_t kResultTemporarilyRejected = 1;
inline constexpr std::uint8_t kResultDenied = 2;
inline constexpr std::uint8_t kResultUnsupported = 3;
inline constexpr std::uint8_t kResultFailed = 4;
inline constexpr std::uint8_t kResultInProgress = 5;

// Parameter 2 of kCommandGripper.
inline constexpr float kGripperRelease = 0, kGripperGrab = 1;

// Parameter 2 of kCommandArmDisarm: at once, also in flight.
inline constexpr float kArmByForce = 21196;

// POSITION_TARGET_TYPEMASK: parts of a set-point to be ignored.
inline constexpr std::uint16_t kIgnorePosition = 0x007;
inline constexpr std::uint16_t kIgnoreVelocity = 0x038;
inline constexpr std::uint16_t kIgnoreAcceleration = 0x1c0;
inline constexpr std::uint16_t kIgnoreYaw = 0x400;
inline constexpr std::uint16_t kIgnoreYawRate = 0x800;

// ATTITUDE_TARGET_TYPEMASK.
inline constexpr std::uint8_t kIgnoreBodyRates = 7;
inline constexpr std::uint8_t kIgnoreThrust = 64;
inline constexpr std::uint8_t kIgnoreAttitude = 128;

// ESTIMATOR_STATUS_FLAGS; flags of EKF_STATUS_FLAGS with the same names have the same values.
inline constexpr std::uint16_t kEstimatorAttitude = 1;
inline constexpr std::uint16_t kEstimatorVelocityHorizontal = 2;
inline constexpr std::uint16_t kEstimatorVelocityVertical = 4;
inline constexpr std::uint16_t kEstimatorPositionRelative = 8;
inline constexpr std::uint16_t kEstimatorPositionAbsolute = 16;
inline constexpr std::uint16_t kEstimatorPositionVertical = 32;
inline constexpr std::uint16_t kEstimatorConstantPosition = 128;
inline constexpr std::uint16_t kEstimatorGpsGlitch = 1024;
inline constexpr std::uint16_t kEkfUninitialized = 1024;
inline constexpr std::uint16_t kEkfGpsGlitching = 32768;

// MAV_FRAME
inline constexpr std::uint8_t kFrameLocalNed = 1;
inline constexpr std::uint8_t kFrameLocalOffsetNed = 7;
inline constexpr std::uint8_t kFrameBodyNed = 8;
inline constexpr std::uint8_t kFrameBodyOffsetNed = 9;
inline constexpr std::uint8_t kFrameBodyFrd = 12;
inline constexpr std::uint8_t kFrameLocalFrd = 20;

// MAV_ESTIMATOR_TYPE of ODOMETRY
inline constexpr std::uint8_t kEstimatorTypeVision = 2;

// TARGET_OBS_FRAME of TARGET_RELATIVE
inline constexpr std::uint8_t kTargetFrameBodyFrd = 1;
inline constexpr std::uint8_t kTargetFrameOther = 3;

// LANDING_TARGET_TYPE
inline constexpr std::uint8_t kTargetTypeVisionFiducial = 2;
inline constexpr std::uint8_t kTargetTypeVisionOther = 3;

// MAV_LANDED_STATE
inline constexpr std::uint8_t kLandedOnGround = 1;
inline constexpr std::uint8_t kLandedInAir = 2;
inline constexpr std::uint8_t kLandedTakeoff = 3;
inline constexpr std::uint8_t kLandedLanding = 4;

// MAV_SEVERITY
inline constexpr std::uint8_t kSeverityCritical = 2;
inline constexpr std::uint8_t kSeverityError = 3;
inline constexpr std::uint8_t kSeverityWarning = 4;
inline constexpr std::uint8_t kSeverityInfo = 6;

// MAV_PARAM_TYPE
inline constexpr std::uint8_t kParamUint32 = 5;
inline constexpr std::uint8_t kParamInt32 = 6;
inline constexpr std::uint8_t kParamReal32 = 9;

// MAV_DISTANCE_SENSOR, MAV_SENSOR_ORIENTATION
inline constexpr std::uint8_t kDistanceUnknown = 4;
inline constexpr std::uint8_t kOrientationDown = 25;  // pitched by 270 degrees

// MAV_DATA_STREAM
inline constexpr std::uint8_t kStreamPosition = 6;
inline constexpr std::uint8_t kStreamExtra1 = 10;  // attitude

}  // namespace kestrel::mavlink
