// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/recording_plan.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <fstream>
#include <mutex>
#include <thread>

#include <fmt/format.h>
#include <opencv2/imgcodecs.hpp>

#include "kestrel/base/error.h"
#include "kestrel/base/read_file.h"

namespace kestrel {
namespace {

namespace fs = std::filesystem;

// Fails with what the system says.
void Require(const std::error_code& error, const fs::path& path, const char* what) {
  if (error) throw InputError(fmt::format("{}: {}: {}", path.string(), what, error.message()));
}

void MakeFolder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  Require(error, folder, "cannot be made");
}

// Under another name first: what has its name is whole.
void WriteWhole(const fs::path& path, const char* bytes, std::size_t size) {
  MakeFolder(path.parent_path());
  const fs::path unfinished = path.string() + ".unfinished";
  std::ofstream file(unfinished, std::ios::binary);
  file.write(bytes, static_cast<std::streamsize>(size));
  file.close();
  if (!file) throw InputError(path.string() + ": cannot be written, is the disk full?");
  std::error_code error;
  fs::rename(unfinished, path, error);
  Require(error, path, "cannot be written");
}

void WriteText(const fs::path& path, const std::string& text) {
  WriteWhole(path, text.data(), text.size());
}

std::string ImageName(Time time) { return fmt::format("{}.png", ToNanoseconds(time)); }

void WriteImage(const fs::path& path, const cv::Mat& image) {
  std::vector<std::uint8_t> bytes;
  constexpr int kFast = 1;
  cv::imencode(".png", image, bytes, {cv::IMWRITE_PNG_COMPRESSION, kFast});
  WriteWhole(path, reinterpret_cast<const char*>(bytes.data()), bytes.size());
}

void RequireFree(const fs::path& output, bool replace) {
  if (!fs::exists(output)) return;
  if (!fs::is_directory(output)) {
    throw InputError(output.string() + ": is a file, not a folder");
  }
  if (fs::is_empty(output)) return;
  if (!fs::exists(output / "mav0" / "cam0")) {
    throw InputError(output.string() + ": is no recording, and not empty");
  }
  if (!replace) throw InputError(output.string() + ": exists already; --force replaces it");
}

// The folder to go on in; what another plan left there is removed.
void PreparePart(const RecordingPlan& plan, const fs::path& part) {
  const fs::path scene = part / "mav0" / "scene.yaml";
  if (fs::exists(scene) && ReadFile(scene.string()) == plan.scene) return;
  std::error_code error;
  fs::remove_all(part, error);
  Require(error, part, "cannot be removed");
  WriteText(scene, plan.scene);
}

void Publish(const fs::path& part, const fs::path& output) {
  std::error_code error;
  fs::remove_all(output, error);
  Require(error, output, "cannot be replaced");
  fs::rename(part, output, error);
  Require(error, output, "cannot be written");
}

// Renders the images that are not there yet. Every thread takes the next one.
class ImageJob {
 public:
  ImageJob(const RecordingPlan& plan, const fs::path& folder, const RenderProgress& progress)
      : plan_(plan), folder_(folder), progress_(progress) {}

  bool Run(int threads) {
    std::vector<std::thread> others;
    for (int i = 1; i < threads; ++i) others.emplace_back([this] { Work(); });
    Work();
    for (std::thread& thread : others) thread.join();
    if (error_) std::rethrow_exception(error_);
    return !stopped_;
  }

 private:
  void Work() {
    try {
      while (!stopped_) {
        const std::size_t index = next_++;
        if (index >= plan_.times.size()) break;
        const fs::path file = folder_ / ImageName(plan_.times[index]);
        if (!fs::exists(file)) WriteImage(file, plan_.render(index));
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
  fs::path folder_;
  const RenderProgress& progress_;
  std::atomic<std::size_t> next_ = 0;
  std::atomic<bool> stopped_ = false;
  std::mutex mutex_;
  std::size_t done_ = 0;
  std::exception_ptr error_;
};

}  // namespace

bool WriteRecording(const RecordingPlan& plan, const fs::path& output, bool replace, int threads,
                    const RenderProgress& progress) {
  const fs::path path = fs::absolute(output).lexically_normal();
  const fs::path named = path.has_filename() ? path : path.parent_path();
  RequireFree(named, replace);
  const fs::path part = named.string() + ".part";
  PreparePart(plan, part);
  const fs::path camera = part / "mav0" / "cam0";
  MakeFolder(camera / "data");
  if (!ImageJob(plan, camera / "data", progress).Run(std::max(threads, 1))) return false;
  for (const RecordingPlan::TextFile& file : plan.files) {
    WriteText(part / "mav0" / file.name, file.text);
  }
  std::string rows = "#timestamp [ns],filename\n";
  for (const Time time : plan.times) {
    rows += fmt::format("{},{}\n", ToNanoseconds(time), ImageName(time));
  }
  WriteText(camera / "data.csv", rows);
  Publish(part, named);
  return true;
}

}  // namespace kestrel
