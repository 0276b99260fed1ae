// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/cli/frame_loop.h"

#include <cstddef>

#include "kestrel/cli/interrupt.h"

namespace kestrel {

void ForEachFrame(FrameSource* source, const CameraIntrinsics& intrinsics,
                  const std::function<void(const Frame&, const ProgressBar&)>& process) {
  CatchInterrupts();
  ProgressBar progress(source->frame_count());
  std::size_t done = 0;
  for (Frame frame; !WasInterrupted() && source->Next(&frame); progress.Show(++done)) {
    CheckImageSize(intrinsics, frame.image.cols, frame.image.rows, frame.name);
    process(frame, progress);
  }
}

}  // namespace kestrel
