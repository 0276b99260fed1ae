// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/cli/frame_loop.h"

#include <cstddef>

#include "kestrel/app/cli/interrupt.h"
#include "kestrel/app/cli/progress_bar.h"

namespace kestrel {

void ForEachFrame(FrameSource* source, const CameraIntrinsics& intrinsics,
                  const std::function<void(const Frame&)>& process) {
  CatchInterrupts();
  ProgressBar progress(source->frame_count());
  std::size_t done = 0;
  for (Frame frame; !WasInterrupted() && source->Next(&frame);) {
    CheckImageSize(intrinsics, frame.image.cols, frame.image.rows, frame.name);
    process(frame);
    progress.Show(++done);
  }
}

}  // namespace kestrel
