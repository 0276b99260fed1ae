// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/objects/object_model.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/limits.h"
#include "kestrel/core/base/read_file.h"
#include "kestrel/core/base/yaml_reader.h"
#include "kestrel/vision/objects/embedded_data.h"

namespace kestrel {
namespace {

constexpr std::array kShapes = {ObjectShape::kDisc, ObjectShape::kCuboid, ObjectShape::kBar};

Hsv ParseHsv(const YamlReader& reader) {
  const std::vector<double> numbers = reader.Numbers(3);
  return {static_cast<float>(numbers[0]), static_cast<float>(numbers[1]),
          static_cast<float>(numbers[2])};
}

std::vector<ColorComponent> ParseComponents(const YamlReader& reader) {
  std::vector<ColorComponent> components;
  for (const YamlReader& item : reader.Items()) {
    item.RequireKeys({"weight", "mean", "sigma", "correlation"});
    components.push_back({item["weight"].Number(), ParseHsv(item["mean"]), ParseHsv(item["sigma"]),
                          item.Has("correlation") ? item["correlation"].Number() : 0});
  }
  return components;
}

ColorModel ParseColors(const YamlReader& root) {
  ColorModel colors;
  if (root.Has("max_distance")) colors.max_distance = root["max_distance"].Number();
  for (const YamlReader& item : root["colors"].Items()) {
    item.RequireKeys({"name", "components"});
    colors.colors.push_back({item["name"].Text(), ParseComponents(item["components"])});
  }
  if (root.Has("ambiguous")) colors.ambiguous.components = ParseComponents(root["ambiguous"]);
  return colors;
}

std::size_t ParseColorName(const YamlReader& reader, const ColorModel& model) {
  const std::string name = reader.Text();
  const auto found = std::find_if(model.colors.begin(), model.colors.end(),
                                  [&](const ColorMixture& color) { return color.name == name; });
  if (found == model.colors.end()) {
    reader.Fail(fmt::format("'{}' is none of the colors", name));
  }
  return found - model.colors.begin();
}

ObjectShape ParseShape(const YamlReader& reader) {
  const std::string name = reader.Text();
  for (const ObjectShape shape : kShapes) {
    if (name == ToString(shape)) return shape;
  }
  reader.Fail(fmt::format("'{}' is no shape, expected disc, cuboid or bar", name));
}

ObjectClass ParseClass(const YamlReader& item, const ColorModel& colors) {
  item.RequireKeys({"name", "color", "shape", "size_m", "width_m", "height_m", "max_height_m",
                    "score", "may_move"});
  ObjectClass result;
  result.name = item["name"].Text();
  result.color = ParseColorName(item["color"], colors);
  result.shape = ParseShape(item["shape"]);
  result.size_m = item["size_m"].Number();
  if (item.Has("width_m")) result.width_m = item["width_m"].Number();
  result.height_m = item["height_m"].Number();
  result.max_height_m = item.Has("max_height_m") ? item["max_height_m"].Number() : result.height_m;
  result.score = item["score"].Number();
  result.may_move = item["may_move"].Bool();
  return result;
}

ObjectModel ParseRoot(const YamlReader& root) {
  root.RequireKeys({"max_distance", "colors", "ambiguous", "classes"});
  ObjectModel model;
  model.colors = ParseColors(root);
  for (const YamlReader& item : root["classes"].Items()) {
    model.classes.push_back(ParseClass(item, model.colors));
  }
  return model;
}

std::string Print(const ColorComponent& component) {
  const auto hsv = [](const Hsv& x) {
    return fmt::format("[{}, {}, {}]", x.hue_deg, x.saturation, x.value);
  };
  const std::string correlation =
      component.correlation == 0 ? "" : fmt::format(", correlation: {}", component.correlation);
  return fmt::format("{{weight: {}, mean: {}, sigma: {}{}}}\n", component.weight,
                     hsv(component.mean), hsv(component.sigma), correlation);
}

}  // namespace

const char* ToString(ObjectShape shape) {
  switch (shape) {
    case ObjectShape::kDisc:
      return "disc";
    case ObjectShape::kCuboid:
      return "cuboid";
    case ObjectShape::kBar:
      return "bar";
  }
  return "";
}

std::vector<std::string> ObjectModel::Validate() const {
  std::vector<std::string> violations = colors.Validate();
  if (classes.empty()) violations.emplace_back("there must be at least one class");
  for (std::size_t i = 0; i < classes.size(); ++i) {
    const ObjectClass& c = classes[i];
    const auto require = [&](bool holds, const char* rule) {
      if (!holds) violations.push_back(fmt::format("class {} ({}): {}", i + 1, c.name, rule));
    };
    require(c.color < colors.colors.size(), "its color must be one of the colors");
    const std::string name = fmt::format("class {} ({}): ", i + 1, c.name);
    Require(c.size_m, Metres(), name + "size_m", &violations);
    if (c.shape == ObjectShape::kBar) Require(c.width_m, Metres(), name + "width_m", &violations);
    if (c.max_height_m > 0) Require(c.max_height_m, Metres(), name + "max_height_m", &violations);
    require(c.shape != ObjectShape::kBar || c.width_m < c.size_m,
            "width_m must be less than size_m");
    require(c.height_m >= 0 && c.height_m <= c.max_height_m && std::isfinite(c.max_height_m),
            "height_m must not be negative, nor more than max_height_m");
  }
  return violations;
}

ObjectModel ParseObjectModel(const std::string& yaml, const std::string& file) {
  ObjectModel model = ParseRoot(YamlReader(yaml, file));
  const std::vector<std::string> violations = model.Validate();
  if (!violations.empty()) {
    throw InputError(fmt::format("{}: {}", file, fmt::join(violations, "; ")));
  }
  return model;
}

ObjectModel ReadObjectModel(const std::string& path) {
  return ParseObjectModel(ReadFile(path), path);
}

std::string PrintObjectModel(const ObjectModel& model) {
  std::string text = fmt::format("max_distance: {}\ncolors:\n", model.colors.max_distance);
  for (const ColorMixture& color : model.colors.colors) {
    text += fmt::format("  - name: {}\n    components:\n", color.name);
    for (const ColorComponent& component : color.components) text += "      - " + Print(component);
  }
  if (!model.colors.ambiguous.components.empty()) text += "ambiguous:\n";
  for (const ColorComponent& component : model.colors.ambiguous.components) {
    text += "  - " + Print(component);
  }
  text += "classes:\n";
  for (const ObjectClass& c : model.classes) {
    text += fmt::format(
        "  - {{name: {}, color: {}, shape: {}, size_m: {}, width_m: {}, height_m: {}, "
        "max_height_m: {}, score: {}, may_move: {}}}\n",
        c.name, model.colors.colors[c.color].name, ToString(c.shape), c.size_m, c.width_m,
        c.height_m, c.max_height_m, c.score, c.may_move);
  }
  return text;
}

ObjectModel DefaultObjectModel() {
  return ParseObjectModel(std::string(kDefaultObjectModelYaml), "default object model");
}

}  // namespace kestrel
