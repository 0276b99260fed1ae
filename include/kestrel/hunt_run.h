// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// The hunt pipeline as the vision of a session over a recording.
//
// Example:
//   const OpenedSource opened =
//       OpenRecording({.sources = {"flight"}, .format = PixelFormat::kBgr});
//   const ObjectModel model = DefaultObjectModel();
//   HuntRun hunt(opened, model, ColorGrid(model.colors), HuntPipelineOptions(),
//                /*altitude_m=*/std::nullopt);
//   ObservationSinks sinks(SinkErrors::kThrow);
//   RunRecording(opened, &hunt, &sinks, [](std::size_t done) { return done < 100; });
//   std::cout << hunt.pipeline().map().Confirmed().size() << " objects\n";

#include "kestrel/flight/session/hunt_run.h"  // IWYU pragma: export
