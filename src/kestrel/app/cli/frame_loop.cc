// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/cli/frame_loop.h"

#include <cstddef>
#include <variant>

#include "kestrel/app/cli/interrupt.h"

namespace kestrel {

void ForEachFrame(FrameSource* source, const CameraIntrinsics& intrinsics,
                  const std::function<void(const Frame&, const ProgressBar&)>& process) {
  RecordingEvents frames(source, {}, Duration::zero());
  ForEachEvent(
      &frames, source->frame_count(), intrinsics, [](const PoseSample&) {}, process);
}

void ForEachEvent(EventSource* source, std::optional<std::size_t> frame_count,
                  const CameraIntrinsics& intrinsics,
                  const std::function<void(const PoseSample&)>& add_pose,
                  const std::function<void(const Frame&, const ProgressBar&)>& process) {
  CatchInterrupts();
  ProgressBar progress(frame_count);
  std::size_t done = 0;
  while (!WasInterrupted()) {
    const Event event = source->Next();
    if (std::holds_alternative<EndOfStream>(event)) return;
    if (const auto* pose = std::get_if<PoseSample>(&event)) add_pose(*pose);
    const auto* frame = std::get_if<Frame>(&event);
    if (frame == nullptr) continue;
    CheckImageSize(intrinsics, frame->image.cols, frame->image.rows, frame->name);
    process(*frame, progress);
    progress.Show(++done);
  }
}

}  // namespace kestrel
