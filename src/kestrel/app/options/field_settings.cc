// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/options/field_settings.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "kestrel/app/options/config_file.h"
#include "kestrel/core/base/error.h"
#include "kestrel/core/base/options.h"
#include "kestrel/io/recording/media/video_device.h"
#include "kestrel/io/recording/media/video_source.h"
#include "kestrel/io/recording/open_source.h"
#include "kestrel/vision/targets/make_target_detector.h"

namespace kestrel {
namespace {

struct Field {
  const char* key;
  const char* label;
};
constexpr Field kFields[] = {{"fly.source", "Camera"},
                             {"fly.control_exposure", "Exposure control"},
                             {"fly.exposure.max_exposure_s", "Longest exposure"},
                             {"landing.target.kind", "Target"},
                             {"landing.target.size_m", "Size of the target"},
                             {"landing.target.id", "Id of the target"}};

std::string KeyOf(const std::string& setting) { return setting.substr(0, setting.find('=')); }

struct ValueText {
  std::string operator()(const bool* value) const { return *value ? "true" : "false"; }
  std::string operator()(const std::string* value) const { return *value; }
  template <class Number>
  std::string operator()(const Number* value) const {
    return fmt::to_string(*value);
  }
};

std::vector<std::string> ChoicesOf(const OptionField& field) {
  if (field.key == "landing.target.kind") return TargetKinds();
  if (std::holds_alternative<bool*>(field.value)) return {"true", "false"};
  return {};
}

// Throws InputError in the words of the command line where the source is not there.
void RequireSource(const std::string& source) {
  if (source.empty()) throw InputError("fly.source: expected a camera or a recording");
  if (source.starts_with("sim:") || source.starts_with("dds:")) return;
  const bool is_device = source.starts_with(kVideoDevice);
  if ((IsCamera(source) && !is_device) || std::filesystem::exists(source)) return;
  throw InputError(is_device ? CameraFault(source) : source + ": no such file or folder");
}

}  // namespace

FieldSettings::FieldSettings(std::string file, std::vector<std::string> given,
                             const KestrelOptions& options)
    : file_(std::move(file)), given_(std::move(given)), options_(options) {}

bool FieldSettings::IsGiven(const std::string& key) const {
  return std::any_of(given_.begin(), given_.end(),
                     [&](const std::string& setting) { return KeyOf(setting) == key; });
}

ConsoleSettings FieldSettings::State() const {
  ConsoleSettings state{.file = file_, .settings = {}};
  KestrelOptions options = options_;
  const OptionFields all = FieldsOf(options);
  for (const auto& [key, label] : kFields) {
    const auto field = std::find_if(all.begin(), all.end(),
                                    [&, key = key](const auto& one) { return one.key == key; });
    state.settings.push_back({.name = key,
                              .label = label,
                              .value = std::visit(ValueText(), field->value),
                              .unit = std::string(field->unit),
                              .meaning = std::string(field->meaning),
                              .choices = ChoicesOf(*field),
                              .is_given = IsGiven(key)});
  }
  return state;
}

ConsoleSettings FieldSettings::Save(const std::vector<std::string>& settings,
                                    const std::optional<AutopilotState>& autopilot) {
  std::string saved, error;
  try {
    SaveOrThrow(settings, autopilot);
    saved = "saved to " + file_ + "; restart kestrel fly";
  } catch (const InputError& refusal) {
    error = refusal.what();
  }
  ConsoleSettings state = State();
  state.saved = saved;
  state.error = error;
  return state;
}

void FieldSettings::SaveOrThrow(const std::vector<std::string>& settings,
                                const std::optional<AutopilotState>& autopilot) {
  if (file_.empty()) {
    throw InputError(
        "there is no configuration file: start kestrel fly with --config FILE (kestrel config > "
        "FILE makes one)");
  }
  if (autopilot && autopilot->is_armed) {
    throw InputError("the UAV is armed: settings are saved on the ground, when it is disarmed");
  }
  for (const std::string& setting : settings) {
    const std::string key = KeyOf(setting);
    if (std::none_of(std::begin(kFields), std::end(kFields),
                     [&](const Field& field) { return key == field.key; })) {
      throw InputError("'" + setting + "': is no setting of this page");
    }
    if (IsGiven(key)) {
      throw InputError(key + ": is given on the command line, which holds over " + file_);
    }
  }
  std::vector<std::string> all = settings;
  all.insert(all.end(), given_.begin(), given_.end());
  const KestrelOptions changed = ReadKestrelOptions(file_, all);
  ShapeOfTarget(changed.landing.target, changed.landing.detector);
  if (changed.fly.source != options_.fly.source) RequireSource(changed.fly.source);
  SaveSettings(file_, settings);
  options_ = changed;
}

}  // namespace kestrel
