// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/recordings/recording_plan.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>

#include "kestrel/io/recording/euroc/recording_writer.h"

namespace kestrel {
namespace {

// Renders the missing images. Each thread takes the next one.
class ImageJob {
 public:
  ImageJob(const RecordingPlan& plan, const RecordingWriter& writer, const RenderProgress& progress)
      : plan_(plan), writer_(writer), progress_(progress) {}

  bool Run(int threads) {
    std::vector<std::thread> others;
    for (int i = 1; i < threads; ++i) others.emplace_back([this] { Work(); });
    Work();
    for (std::thread& thread : others) thread.join();
    if (error_) std::rethrow_exception(error_);
    return !stopped_;
  }

 private:
  // The images of all cameras, one camera after the other.
  void Render(std::size_t index) {
    const std::vector<Time>* times = &plan_.times;
    const std::function<cv::Mat(std::size_t)>* render = &plan_.render;
    std::size_t camera = 0;
    for (; index >= times->size(); ++camera) {
      index -= times->size();
      times = &plan_.further[camera].times;
      render = &plan_.further[camera].render;
    }
    const Time time = (*times)[index];
    if (!writer_.HasImage(time, camera)) writer_.WriteImage(time, (*render)(index), camera);
  }

  void Work() {
    try {
      while (!stopped_) {
        const std::size_t index = next_++;
        if (index >= plan_.image_count()) break;
        Render(index);
        const std::lock_guard lock(mutex_);
        if (!progress_(++done_)) stopped_ = true;
      }
    } catch (...) {
      const std::lock_guard lock(mutex_);
      error_ = std::current_exception();
      stopped_ = true;
    }
  }

  const RecordingPlan& plan_;
  const RecordingWriter& writer_;
  const RenderProgress& progress_;
  std::atomic<std::size_t> next_ = 0;
  std::atomic<bool> stopped_ = false;
  std::mutex mutex_;
  std::size_t done_ = 0;
  std::exception_ptr error_;
};

}  // namespace

std::size_t RecordingPlan::image_count() const {
  std::size_t count = times.size();
  for (const Camera& camera : further) count += camera.times.size();
  return count;
}

bool WriteRecording(const RecordingPlan& plan, const std::filesystem::path& output, bool replace,
                    int threads, const RenderProgress& progress) {
  const RecordingWriter writer(output, replace, plan.scene);
  if (!ImageJob(plan, writer, progress).Run(std::max(threads, 1))) return false;
  writer.Publish(plan.times, plan.files);
  return true;
}

}  // namespace kestrel
