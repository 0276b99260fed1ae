// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/objects/object_model.h"

#include <algorithm>
#include <array>
#include <set>
#include <string_view>

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include "kestrel/base/error.h"
#include "kestrel/base/options.h"
#include "kestrel/base/parse_number.h"
#include "kestrel/base/read_file.h"
#include "kestrel/objects/embedded_data.h"

namespace kestrel {
namespace {

constexpr std::array kShapes = {ObjectShape::kDisc, ObjectShape::kCuboid, ObjectShape::kBar};

// A node of the file and what to call it in a message.
class Reader {
 public:
  Reader(YAML::Node node, std::string file, std::string key)
      : node_(std::move(node)), file_(std::move(file)), key_(std::move(key)) {}

  [[noreturn]] void Fail(const std::string& message) const {
    throw InputError(fmt::format("{}:{}: {}{}{}", file_, node_.Mark().line + 1, key_,
                                 key_.empty() ? "" : ": ", message));
  }

  // The value of 'name' in a map; required.
  Reader operator[](const std::string& name) const {
    if (!Has(name)) Fail(fmt::format("'{}' is missing", name));
    return {node_[name], file_, key_.empty() ? name : key_ + "." + name};
  }
  bool Has(const std::string& name) const { return node_.IsMap() && node_[name].IsDefined(); }

  // Refuses keys that are not in 'names', and keys that are given twice.
  void RequireKeys(const std::set<std::string>& names) const {
    if (!node_.IsMap()) Fail("expected 'name: value'");
    std::set<std::string> seen;
    for (const auto& entry : node_) {
      if (!entry.first.IsScalar()) Fail("expected 'name: value'");
      const std::string& name = entry.first.Scalar();
      if (!names.contains(name)) Fail(fmt::format("unknown key '{}'", name));
      if (!seen.insert(name).second) Fail(fmt::format("'{}' is given twice", name));
    }
  }
  std::vector<Reader> Items() const {
    if (!node_.IsSequence()) Fail("expected a list");
    std::vector<Reader> items;
    for (std::size_t i = 0; i < node_.size(); ++i) {
      items.push_back({node_[i], file_, fmt::format("{}[{}]", key_, i)});
    }
    return items;
  }
  std::string Text() const {
    if (!node_.IsScalar() || node_.Scalar().empty()) Fail("expected a word");
    return node_.Scalar();
  }
  double Number() const {
    const auto number = node_.IsScalar() ? ParseNumber<double>(node_.Scalar()) : std::nullopt;
    if (!number) Fail("expected a number");
    return *number;
  }
  bool Bool() const {
    const std::string text = Text();
    if (text != "true" && text != "false") Fail("expected true or false");
    return text == "true";
  }

 private:
  YAML::Node node_;
  std::string file_;
  std::string key_;
};

Hsv ParseHsv(const Reader& reader) {
  const std::vector<Reader> items = reader.Items();
  if (items.size() != 3) reader.Fail("expected [hue, saturation, value]");
  return {static_cast<float>(items[0].Number()), static_cast<float>(items[1].Number()),
          static_cast<float>(items[2].Number())};
}

std::vector<ColorComponent> ParseComponents(const Reader& reader) {
  std::vector<ColorComponent> components;
  for (const Reader& item : reader.Items()) {
    item.RequireKeys({"weight", "mean", "sigma"});
    components.push_back(
        {item["weight"].Number(), ParseHsv(item["mean"]), ParseHsv(item["sigma"])});
  }
  return components;
}

ColorModel ParseColors(const Reader& root) {
  ColorModel colors;
  if (root.Has("max_distance")) colors.max_distance = root["max_distance"].Number();
  for (const Reader& item : root["colors"].Items()) {
    item.RequireKeys({"name", "components"});
    colors.colors.push_back({item["name"].Text(), ParseComponents(item["components"])});
  }
  if (root.Has("ambiguous")) colors.ambiguous.components = ParseComponents(root["ambiguous"]);
  return colors;
}

std::size_t ParseColorName(const Reader& reader, const ColorModel& model) {
  const std::string name = reader.Text();
  const auto found = std::find_if(model.colors.begin(), model.colors.end(),
                                  [&](const ColorMixture& color) { return color.name == name; });
  if (found == model.colors.end()) {
    reader.Fail(fmt::format("'{}' is none of the colors", name));
  }
  return found - model.colors.begin();
}

ObjectShape ParseShape(const Reader& reader) {
  const std::string name = reader.Text();
  for (const ObjectShape shape : kShapes) {
    if (name == ToString(shape)) return shape;
  }
  reader.Fail(fmt::format("'{}' is no shape, expected disc, cuboid or bar", name));
}

ObjectClass ParseClass(const Reader& item, const ColorModel& colors) {
  item.RequireKeys({"name", "color", "shape", "size_m", "width_m", "height_m", "max_height_m",
                    "score", "may_move"});
  ObjectClass result;
  result.name = item["name"].Text();
  result.color = ParseColorName(item["color"], colors);
  result.shape = ParseShape(item["shape"]);
  result.size_m = item["size_m"].Number();
  if (item.Has("width_m")) result.width_m = item["width_m"].Number();
  result.height_m = item["height_m"].Number();
  result.max_height_m =
      item.Has("max_height_m") ? item["max_height_m"].Number() : result.height_m;
  result.score = item["score"].Number();
  result.may_move = item["may_move"].Bool();
  return result;
}

ObjectModel ParseRoot(const Reader& root) {
  root.RequireKeys({"max_distance", "colors", "ambiguous", "classes"});
  ObjectModel model;
  model.colors = ParseColors(root);
  for (const Reader& item : root["classes"].Items()) {
    model.classes.push_back(ParseClass(item, model.colors));
  }
  return model;
}

std::string Print(const ColorComponent& component) {
  const auto hsv = [](const Hsv& x) {
    return fmt::format("[{}, {}, {}]", x.hue_deg, x.saturation, x.value);
  };
  return fmt::format("{{weight: {}, mean: {}, sigma: {}}}\n", component.weight, hsv(component.mean),
                     hsv(component.sigma));
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
  constexpr std::size_t kMaxClasses = 64;
  std::vector<std::string> violations = colors.Validate();
  if (classes.empty()) violations.emplace_back("there must be at least one class");
  if (classes.size() > kMaxClasses) {
    violations.push_back(fmt::format("there are {} classes, at most {}", classes.size(),
                                     kMaxClasses));
  }
  for (std::size_t i = 0; i < classes.size(); ++i) {
    const ObjectClass& c = classes[i];
    const auto require = [&](bool holds, const char* rule) {
      if (!holds) violations.push_back(fmt::format("class {} ({}): {}", i + 1, c.name, rule));
    };
    require(c.color < colors.colors.size(), "its color must be one of the colors");
    require(c.size_m > 0 && c.size_m < 1e3, "size_m must be positive and below 1000");
    require(c.shape != ObjectShape::kBar || (c.width_m > 0 && c.width_m < c.size_m),
            "width_m must be positive and less than size_m");
    require(c.height_m >= 0 && c.height_m <= c.max_height_m && c.max_height_m < 1e3,
            "height_m must not be negative, nor more than max_height_m");
  }
  return violations;
}

ObjectModel ParseObjectModel(const std::string& yaml, const std::string& file) {
  ObjectModel model;
  try {
    model = ParseRoot(Reader(YAML::Load(yaml), file, ""));
  } catch (const YAML::Exception& error) {
    throw InputError(fmt::format("{}:{}: not YAML: {}", file, error.mark.line + 1, error.msg));
  }
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
