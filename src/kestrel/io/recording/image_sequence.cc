// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/recording/image_sequence.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <string_view>
#include <utility>

#include "kestrel/core/base/error.h"
#include "kestrel/core/camera/calibration_reader.h"
#include "kestrel/io/recording/file_kind.h"
#include "kestrel/io/recording/image_file.h"

namespace kestrel {
namespace {

bool IsDigit(char c) { return std::isdigit(static_cast<unsigned char>(c)); }

// Removes the digits at the front of the text. Returns them without leading zeros.
std::string_view TakeNumber(std::string_view* text) {
  const auto end = std::find_if_not(text->begin(), text->end(), IsDigit);
  std::string_view number = text->substr(0, end - text->begin());
  text->remove_prefix(number.size());
  number.remove_prefix(std::min(number.find_first_not_of('0'), number.size()));
  return number;
}

// Compares numbers within the texts by value and everything else by character.
bool NaturallyLess(const std::string& left, const std::string& right) {
  std::string_view a = left;
  std::string_view b = right;
  while (!a.empty() && !b.empty()) {
    if (IsDigit(a.front()) && IsDigit(b.front())) {
      const std::string_view m = TakeNumber(&a);
      const std::string_view n = TakeNumber(&b);
      if (m.size() != n.size()) return m.size() < n.size();
      if (m != n) return m < n;
    } else {
      if (a.front() != b.front()) return a.front() < b.front();
      a.remove_prefix(1);
      b.remove_prefix(1);
    }
  }
  if (a.empty() != b.empty()) return a.empty();
  return left < right;  // "1" and "01"
}

std::vector<std::string> ImagesBelow(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  try {
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
      if (entry.is_regular_file() && FileKindOf(entry.path()) == FileKind::kImage) {
        names.push_back(entry.path().lexically_relative(folder).string());
      }
    }
  } catch (const std::filesystem::filesystem_error& error) {
    throw InputError(folder.string() + ": cannot be read: " + error.code().message());
  }
  std::sort(names.begin(), names.end(), NaturallyLess);
  return names;
}

}  // namespace

ImageSequence::ImageSequence(std::vector<Item> items, std::string calibration_file,
                             std::vector<PoseSample> poses)
    : items_(std::move(items)),
      calibration_file_(std::move(calibration_file)),
      poses_(std::move(poses)) {}

bool ImageSequence::Next(Frame* frame) {
  if (next_ == items_.size()) return false;
  const Item& item = items_[next_];
  try {
    return Read(next_++, frame);
  } catch (const InputError& error) {
    if (items_.size() == 1) throw;
    throw BrokenImage(error.what(), item.name, item.time);
  }
}

bool ImageSequence::Read(std::size_t index, Frame* frame) const {
  if (index >= items_.size()) return false;
  const Item& item = items_[index];
  frame->name = item.name;
  frame->time = item.time;
  frame->image = ReadImage(item.path, format());
  if (keeps_color()) frame->color = ReadImage(item.path, PixelFormat::kBgr);
  return true;
}

std::optional<CameraCalibration> ImageSequence::calibration() const {
  if (calibration_file_.empty()) return std::nullopt;
  return ReadCalibration(calibration_file_);
}

double ImageSequence::rate_hz() const {
  const Duration span = items_.back().time - items_.front().time;
  return span.count() > 0 ? (items_.size() - 1) / ToSeconds(span) : kNominalRateHz;
}

Time NominalTime(std::size_t index) { return Time(DurationFromSeconds(index / kNominalRateHz)); }

ImageSequence OpenImageFiles(const std::vector<std::string>& paths) {
  std::vector<ImageSequence::Item> items;
  for (const std::string& path : paths) items.push_back({path, path, NominalTime(items.size())});
  return ImageSequence(std::move(items));
}

ImageSequence OpenImageFolder(const std::string& folder) {
  std::vector<ImageSequence::Item> items;
  for (const std::string& name : ImagesBelow(folder)) {
    const std::string path = (std::filesystem::path(folder) / name).string();
    items.push_back({name, path, NominalTime(items.size())});
  }
  if (items.empty()) throw InputError(folder + ": no image in this folder, nor below it");
  return ImageSequence(std::move(items));
}

}  // namespace kestrel
