// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// The interface of the vision of a session, for a pipeline of your own.
//
// Example:
//   struct FrameCounter : Vision {
//     void AddPose(const PoseSample&) override {}
//     Duration pose_lead() const override { return Duration::zero(); }
//     Observation Process(const Frame& frame) override { return {frame, LandingObservation()}; }
//     std::string Found() const override { return "frames only"; }
//   };

#include "kestrel/flight/session/vision.h"  // IWYU pragma: export
