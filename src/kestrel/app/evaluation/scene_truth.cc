// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/evaluation/scene_truth.h"

#include <cstdint>

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/load_yaml.h"
#include "kestrel/core/base/parse_number.h"
#include "kestrel/core/geometry/angles.h"

namespace kestrel {
namespace {

// A map in the file. It reads values and names the errors; the map may be absent.
class Section {
 public:
  Section(const YAML::Node& node, const std::string& name) : node_(node), name_(name) {}

  const YAML::Node& node() const { return node_; }
  Section Child(const std::string& key) const { return {Find(key), name_ + key + "."}; }
  std::optional<std::string> Text(const std::string& key) const {
    const YAML::Node value = Find(key);
    if (!value || !value.IsScalar()) return std::nullopt;
    return value.Scalar();
  }
  std::optional<double> Number(const std::string& key) const {
    const std::optional<std::string> text = Text(key);
    if (!text) return std::nullopt;
    const std::optional<double> number = ParseNumber<double>(*text);
    if (number) return number;
    throw InputError(fmt::format("{}{}: is '{}', expected a finite number", name_, key, *text));
  }

 private:
  YAML::Node Find(const std::string& key) const {
    if (!node_ || !node_.IsMap()) return YAML::Node(YAML::NodeType::Undefined);
    return node_[key];
  }

  const YAML::Node node_;  // const: a look-up must not create the key
  std::string name_;
};

Eigen::Quaterniond MountError(const Section& section) {
  const auto turn = [&](const char* key, const Eigen::Vector3d& axis) {
    return Eigen::AngleAxisd(Radians(section.Number(key).value_or(0)), axis);
  };
  return turn("yaw_deg", Eigen::Vector3d::UnitZ()) * turn("pitch_deg", Eigen::Vector3d::UnitY()) *
         turn("roll_deg", Eigen::Vector3d::UnitX());
}

void ReadFrames(const Section& frames, const std::string& file, SceneTruth* scene) {
  for (const auto& entry : frames.node()) {
    const std::string& key = entry.first.Scalar();
    const std::optional<std::int64_t> ns = ParseNumber<std::int64_t>(key);
    if (!ns) {
      throw InputError(fmt::format("{}: frames.{}: expected a timestamp in ns", file, key));
    }
    const Time time = TimeFromNanoseconds(*ns);
    const Section frame = frames.Child(key);
    if (const auto condition = frame.Text("condition")) scene->frame_conditions[time] = *condition;
    if (const auto exposure = frame.Number("exposure_s")) {
      scene->frame_exposures_s[time] = *exposure;
    }
  }
}

}  // namespace

const std::string& SceneTruth::ConditionAt(Time time) const {
  const auto own = frame_conditions.find(time);
  return own == frame_conditions.end() ? condition : own->second;
}

std::optional<double> SceneTruth::ExposureAt(Time time) const {
  const auto own = frame_exposures_s.find(time);
  return own == frame_exposures_s.end() ? exposure_s : own->second;
}

SceneTruth ParseSceneTruth(const std::string& text, const std::string& file) {
  const YAML::Node node = LoadYaml(text, file);
  if (!node.IsMap()) throw InputError(file + ": expected a map of keys, as scene.yaml has");
  const Section root(node, file + ": ");
  SceneTruth scene;
  scene.condition = root.Text("condition").value_or(scene.condition);
  scene.mount_error = MountError(root.Child("mount_error"));
  scene.clock_offset_s = root.Number("time_offset_s").value_or(scene.clock_offset_s);
  const Section options = root.Child("options");
  scene.ring_diameter_m =
      options.Child("pattern").Number("outer_diameter_m").value_or(scene.ring_diameter_m);
  if (const auto kind = options.Child("target").Text("kind")) {
    scene.heading_symmetry = HeadingSymmetryOf(*kind);
  }
  scene.exposure_s = options.Child("shutter").Number("exposure_s");
  if (root.Child("frames").node()) ReadFrames(root.Child("frames"), file, &scene);
  return scene;
}

}  // namespace kestrel
