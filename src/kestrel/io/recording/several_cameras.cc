// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/recording/several_cameras.h"

#include <utility>

namespace kestrel {

SeveralCameras::SeveralCameras(std::vector<Camera> cameras) {
  for (Camera& camera : cameras) {
    const std::size_t index = queues_.size();
    camera.source->set_on_broken([this, index](BrokenImage broken) {
      broken.camera = index;
      broken_.push_back(std::move(broken));
    });
    queues_.push_back({std::move(camera.source), camera.clock_offset});
  }
}

std::optional<std::size_t> SeveralCameras::frame_count() const {
  std::size_t sum = 0;
  for (const Queue& queue : queues_) {
    const auto count = queue.source->frame_count();
    if (!count) return std::nullopt;
    sum += *count;
  }
  return sum;
}

void SeveralCameras::Fill(std::size_t camera) {
  Queue& queue = queues_[camera];
  if (queue.next || queue.has_ended) return;
  queue.source->set_format(format());
  queue.source->set_keeps_color(keeps_color());
  Frame frame;
  queue.has_ended = !queue.source->Next(&frame);
  if (queue.has_ended) return;
  frame.camera = camera;
  queue.next = std::move(frame);
}

bool SeveralCameras::ReadNext(Frame* frame) {
  for (std::size_t i = 0; i < queues_.size(); ++i) Fill(i);
  if (!broken_.empty()) {
    const BrokenImage broken = broken_.front();
    broken_.erase(broken_.begin());
    throw broken;
  }
  Queue* earliest = nullptr;
  const auto time_of = [](const Queue& queue) { return queue.next->time + queue.clock_offset; };
  for (Queue& queue : queues_) {
    if (!queue.next) continue;
    if (earliest == nullptr || time_of(queue) < time_of(*earliest)) earliest = &queue;
  }
  if (earliest == nullptr) return false;
  *frame = *std::exchange(earliest->next, std::nullopt);
  return true;
}

}  // namespace kestrel
