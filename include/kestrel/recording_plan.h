// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Simulated flights and hunts with their truth: rendered frame by frame, or written as a recording.
//
// Example:
//   const RecordingPlan plan = PlanLandingScenario("calm", {}, PaperCalibration(), /*seed=*/1);
//   LandingPipeline pipeline(PaperCalibration(), {});
//   const LandingObservation seen = pipeline.Process(plan.render(0), plan.times[0]);
//   const auto go_on = [](std::size_t done) { return done < 100; };
//   WriteRecording(plan, "flight", /*replace=*/false, /*threads=*/2, go_on);

#include "kestrel/simulation/recordings/recording_plan.h"  // IWYU pragma: export
