// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Names of the files of a recording in the EuRoC layout, below its folder mav0.
namespace kestrel::euroc {

inline constexpr char kImages[] = "cam0/data.csv";
inline constexpr char kImageFolder[] = "cam0/data";
inline constexpr char kCamera[] = "cam0/sensor.yaml";
inline constexpr char kExposures[] = "cam0/exposure.csv";
inline constexpr char kDroppedImages[] = "cam0/dropped.csv";
inline constexpr char kPoses[] = "nav0/data.csv";
inline constexpr char kPoseSensor[] = "nav0/sensor.yaml";
inline constexpr char kGimbal[] = "gimbal0/data.csv";
inline constexpr char kGimbalSensor[] = "gimbal0/sensor.yaml";
inline constexpr char kZoom[] = "zoom0/data.csv";
inline constexpr char kZoomSensor[] = "zoom0/sensor.yaml";
inline constexpr char kTrueGimbal[] = "gimbal_groundtruth0/data.csv";
inline constexpr char kTruePoses[] = "state_groundtruth_estimate0/data.csv";
inline constexpr char kTruePatterns[] = "landing_pattern0/data.csv";
inline constexpr char kScene[] = "scene.yaml";

}  // namespace kestrel::euroc
