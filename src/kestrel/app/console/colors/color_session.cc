// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/console/colors/color_session.h"

#include <exception>
#include <filesystem>
#include <set>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "kestrel/app/web_server/deflate.h"
#include "kestrel/calibration/color_training/model_versions.h"
#include "kestrel/core/base/error.h"
#include "kestrel/core/base/read_file.h"
#include "kestrel/core/base/write_file.h"
#include "kestrel/core/base/yaml_reader.h"

namespace kestrel {
namespace {

namespace fs = std::filesystem;

constexpr int kJpegQuality = 92;  // high, as users judge colours by it

bool IsDraftOf(const std::string& file, const std::string& recording) {
  return YamlReader(ReadFile(file), file)["recording"].Text() == recording;
}

// The recording's own draft: a folder may have drafts of several recordings.
std::string DraftFile(const std::string& folder, const std::string& recording) {
  std::string file = (fs::path(folder) / "draft.yaml").string();
  for (int i = 2; fs::exists(file) && !IsDraftOf(file, recording); ++i) {
    file = (fs::path(folder) / fmt::format("draft_{}.yaml", i)).string();
  }
  return file;
}

// The bytes of a continuous image with one byte per pixel.
std::string BytesOf(const cv::Mat& image) {
  return {reinterpret_cast<const char*>(image.data), image.total()};
}

void MakeFolder(const std::string& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw InputError(folder + ": cannot be made: " + error.message());
}

}  // namespace

ColorSession::ColorSession(ColorSource source)
    : source_(std::move(source)),
      draft_file_(DraftFile(source_.folder, source_.recording)),
      model_file_((fs::path(source_.folder) / "objects.yaml").string()),
      editor_(source_.model, source_.frame_count,
              [this](std::size_t frame) { return Image(frame); }),
      encoder_(kJpegQuality) {
  if (is_live()) state_.most_kept = MarkedPixels::kMaxFrames;
  state_.file = model_file_;
  LookAtFile();
  for (const ColorMixture& color : source_.model.colors.colors) state_.names.push_back(color.name);
  state_.color = state_.names.front();
  if (fs::exists(draft_file_)) {
    editor_.Restore(ParseColorDraft(ReadFile(draft_file_), source_.recording, draft_file_));
    state_.answer = "goes on with the draft in " + draft_file_;
  }
  Notify();
}

void ColorSession::Obey(const ColorRequest& request) {
  state_.answer.clear();
  state_.is_refused = false;
  try {
    Do(request);
  } catch (const std::exception& error) {  // includes errors of the file system
    state_.answer = error.what();
    state_.is_refused = true;
  }
  if (request.action != ColorAction::kChoose) ++state_.revision;
  Notify();
}

void ColorSession::Do(const ColorRequest& request) {
  switch (request.action) {
    case ColorAction::kChoose:
      editor_.IndexOf(request.color);
      state_.color = request.color;
      return;
    case ColorAction::kMark:
      editor_.Mark(request.stroke);
      return KeepDraft();
    case ColorAction::kUndo:
      if (editor_.Undo()) KeepDraft();
      return;
    case ColorAction::kRedo:
      if (editor_.Redo()) KeepDraft();
      return;
    case ColorAction::kTeach:
      editor_.Teach(request.color);
      state_.color = request.color;
      state_.answer = "taught " + request.color;
      return;
    case ColorAction::kRevert:
      editor_.SetModel(source_.model);
      state_.answer = "the model is as it was";
      return;
    case ColorAction::kSave:
      return Save();
    case ColorAction::kKeep:
      return Keep();
  }
}

void ColorSession::Keep() {
  if (!is_live()) throw InputError("a recording has all its frames, none is to be kept");
  state_.answer = source_.keep();
  ++source_.frame_count;
  editor_.AddFrame();
}

void ColorSession::Save() {
  MakeFolder(source_.folder);
  const std::string version = SaveModelVersion(model_file_, editor_.model());
  source_.model = editor_.model();
  LookAtFile();
  state_.answer = version.empty()
                      ? fmt::format("saved as {}", model_file_)
                      : fmt::format("saved as {}, the one before is {}", model_file_, version);
}

void ColorSession::LookAtFile() {
  saved_ = fs::exists(model_file_) ? ReadFile(model_file_) : PrintObjectModel(source_.model);
  state_.versions = ModelVersions(model_file_);
}

void ColorSession::KeepDraft() const {
  MakeFolder(source_.folder);
  WriteFile(draft_file_, PrintColorDraft(editor_.draft(), source_.recording));
}

// Updates all of the state after a request.
void ColorSession::Notify() {
  state_.frames = source_.frame_count;
  std::set<std::size_t> marked;
  for (const ColorStroke& stroke : editor_.draft().strokes()) marked.insert(stroke.frame);
  state_.marked.assign(marked.begin(), marked.end());
  state_.strokes = editor_.draft().strokes().size();
  state_.can_redo = editor_.draft().can_redo();
  const HueSaturationHistogram histogram = editor_.Histogram(state_.color);
  state_.histogram.assign(histogram.counts().begin(), histogram.counts().end());
  state_.cut_hue_deg = histogram.CutHue_deg();
  const ColorModel& colors = editor_.model().colors;
  state_.components = colors.colors[editor_.IndexOf(state_.color)].components;
  state_.max_distance = colors.max_distance;
  state_.warnings = editor_.Warnings(state_.color);
  if (source_.warn) {
    for (std::string& warning : source_.warn()) state_.warnings.push_back(std::move(warning));
  }
  state_.difference = LineDifference(saved_, PrintObjectModel(editor_.model()));
}

const cv::Mat& ColorSession::Image(std::size_t frame) {
  if (image_.empty() || frame_ != frame) {
    image_ = source_.read(frame);
    frame_ = frame;
  }
  return image_;
}

ExportAnswer ColorSession::Answer(const ExportRequest& request) {
  if (request.number >= source_.frame_count) return {};
  try {
    const cv::Mat& image = Image(request.number);
    if (request.kind == ExportRequest::Kind::kPicture) {
      ExportAnswer picture{"", "image/jpeg", fmt::format("picture-{}.jpg", request.number)};
      encoder_.Append(image, &picture.content);
      return picture;
    }
    // One byte per pixel for each; a browser takes longer to decode an image than for all the rest.
    const std::string labels = BytesOf(editor_.Labels(image));
    std::string marks = BytesOf(editor_.Marks(request.number));
    marks.resize(labels.size());  // zero where nothing is marked yet
    ExportAnswer answer{Deflate(labels + marks), "application/octet-stream",
                        fmt::format("labels-{}.bin", request.number)};
    answer.coding = "deflate";
    return answer;
  } catch (const InputError&) {  // the image's file is gone
    return {};
  }
}

}  // namespace kestrel
