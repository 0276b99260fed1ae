// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/mapping/map_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <Eigen/Cholesky>
#include <fmt/format.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/read_file.h"
#include "kestrel/core/base/write_file.h"
#include "kestrel/core/base/yaml_reader.h"

namespace kestrel {
namespace {

constexpr int kFormat = 3;
constexpr std::array kShapes = {ObjectShape::kDisc, ObjectShape::kCuboid, ObjectShape::kBar};

template <class Range>
std::string List(const Range& range) {
  return fmt::format("[{}]", fmt::join(range.begin(), range.end(), ", "));
}

std::string Print(const MappedObject& object) {
  return fmt::format(
      "{{\"id\": {}, \"shape\": \"{}\", \"first_seen_ns\": {}, \"last_seen_ns\": {}, "
      "\"time_ns\": {}, \"state\": {}, \"covariance\": {}, \"may_move\": {}, "
      "\"move_log_odds\": {}, \"moves\": {}, \"detections\": {}, \"log_odds\": {}, "
      "\"color\": [{}, {}, {}], \"color_log_likelihoods\": {}, "
      "\"digit_log_likelihoods\": {}}}",
      object.id, ToString(object.shape), ToNanoseconds(object.first_seen),
      ToNanoseconds(object.last_seen), ToNanoseconds(object.time), List(object.state.reshaped()),
      List(object.covariance.reshaped()), object.may_move, object.move_log_odds, object.moves,
      object.detections, object.log_odds, object.color.hue_deg, object.color.saturation,
      object.color.value, List(object.color_log_likelihoods), List(object.digit_log_likelihoods));
}

ObjectShape ParseShape(const YamlReader& reader) {
  const std::string name = reader.Text();
  for (const ObjectShape shape : kShapes) {
    if (name == ToString(shape)) return shape;
  }
  reader.Fail(fmt::format("'{}' is no shape", name));
}

template <std::size_t kSize>
void ParseArray(const YamlReader& reader, std::array<double, kSize>* array) {
  const std::vector<double> numbers = reader.Numbers(kSize);
  std::copy(numbers.begin(), numbers.end(), array->begin());
}

Time ParseTime(const YamlReader& reader) { return TimeFromNanoseconds(reader.Integer()); }

MappedObject ParseObject(const YamlReader& reader) {
  reader.RequireKeys({"id", "shape", "first_seen_ns", "last_seen_ns", "time_ns", "state",
                      "covariance", "may_move", "move_log_odds", "moves", "detections", "log_odds",
                      "color", "color_log_likelihoods", "digit_log_likelihoods"});
  constexpr int kStateSize = MappedObject::kStateSize;
  MappedObject object;
  object.id = reader["id"].Integer();
  object.shape = ParseShape(reader["shape"]);
  object.first_seen = ParseTime(reader["first_seen_ns"]);
  object.last_seen = ParseTime(reader["last_seen_ns"]);
  object.time = ParseTime(reader["time_ns"]);
  object.state = MappedObject::State(reader["state"].Numbers(kStateSize).data());
  object.covariance =
      MappedObject::Covariance(reader["covariance"].Numbers(kStateSize * kStateSize).data());
  const Eigen::Matrix3d position = object.covariance.topLeftCorner<3, 3>();
  if (position.llt().info() != Eigen::Success) {
    reader["covariance"].Fail("expected the covariance of a position, positive definite");
  }
  object.may_move = reader["may_move"].Bool();
  object.move_log_odds = reader["move_log_odds"].Number();
  object.moves = reader["moves"].Bool();
  object.detections = static_cast<int>(
      std::clamp<std::int64_t>(reader["detections"].Integer(), 0, std::int64_t{1} << 30));
  object.log_odds = reader["log_odds"].Number();
  const std::vector<double> color = reader["color"].Numbers(3);
  object.color = {static_cast<float>(color[0]), static_cast<float>(color[1]),
                  static_cast<float>(color[2])};
  ParseArray(reader["color_log_likelihoods"], &object.color_log_likelihoods);
  ParseArray(reader["digit_log_likelihoods"], &object.digit_log_likelihoods);
  return object;
}

// Returns a text as a JSON string.
std::string Quoted(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    if (static_cast<unsigned char>(c) < 0x20) {
      quoted += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
    } else {
      quoted += c;
    }
  }
  return quoted + '"';
}

}  // namespace

std::string PrintObjects(const std::vector<MappedObject>& objects) {
  std::string text = fmt::format("{{\"kestrel_map\": {}, \"objects\": [\n", kFormat);
  for (std::size_t i = 0; i < objects.size(); ++i) {
    text += Print(objects[i]) + (i + 1 < objects.size() ? ",\n" : "\n");
  }
  return text + "]}\n";
}

std::vector<MappedObject> ParseObjects(const std::string& text, const std::string& file) {
  const YamlReader root(text, file);
  root.RequireKeys({"kestrel_map", "objects"});
  if (root["kestrel_map"].Integer() != kFormat) {
    root["kestrel_map"].Fail(fmt::format("expected the format {}", kFormat));
  }
  std::vector<MappedObject> objects;
  for (const YamlReader& item : root["objects"].Items()) objects.push_back(ParseObject(item));
  return objects;
}

void SaveObjects(const std::string& path, const std::vector<MappedObject>& objects) {
  WriteFile(path, PrintObjects(objects));
}

std::vector<MappedObject> LoadObjects(const std::string& path) {
  return ParseObjects(ReadFile(path), path);
}

std::string PrintGeoJson(const std::vector<MappedObject>& objects, const ObjectModel& model,
                         const GeoOrigin& origin) {
  // Radii of curvature of WGS 84 at the origin: along the meridian and across it.
  constexpr double kEquator_m = 6378137;
  constexpr double kEccentricity2 = 0.00669437999014;
  constexpr double kDegrees = 180 / std::numbers::pi;
  const double latitude = origin.latitude_deg / kDegrees;
  const double sine = std::sin(latitude);
  const double w = 1 - kEccentricity2 * sine * sine;
  const double meridian_m = kEquator_m * (1 - kEccentricity2) / (w * std::sqrt(w));
  const double across_m = kEquator_m / std::sqrt(w) * std::cos(latitude);
  std::string text = "{\"type\": \"FeatureCollection\", \"features\": [\n";
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const MappedObject& object = objects[i];
    const auto index = ClassOf(object, model);
    text += fmt::format(
        "{{\"type\": \"Feature\", \"id\": {}, \"geometry\": {{\"type\": \"Point\", "
        "\"coordinates\": [{:.9f}, {:.9f}]}}, \"properties\": {{\"class\": {}, \"score\": {}, "
        "\"sigma_m\": {:.4f}, \"velocity_mps\": [{:.4f}, {:.4f}, {:.4f}], \"moving\": {}}}}}{}\n",
        object.id, origin.longitude_deg + kDegrees * object.position().x() / across_m,
        origin.latitude_deg + kDegrees * object.position().y() / meridian_m,
        Quoted(index ? model.classes[*index].name : ""), ScoreOf(object, model), object.sigma_m(),
        object.velocity().x(), object.velocity().y(), object.velocity().z(), object.moves,
        i + 1 < objects.size() ? "," : "");
  }
  return text + "]}\n";
}

}  // namespace kestrel
