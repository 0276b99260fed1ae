// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/console/messages/console_json.h"

#include <cmath>
#include <utility>

#include <nlohmann/json.hpp>

#include "kestrel/app/console/messages/calibration_json.h"
#include "kestrel/app/console/messages/color_json.h"
#include "kestrel/app/console/messages/lens_json.h"
#include "kestrel/app/console/messages/study_json.h"

namespace kestrel {
namespace {

using Json = nlohmann::json;

std::string Text(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

// Null where unknown.
Json Milliseconds(std::optional<Duration> time) {
  return time ? Json(time->count() / 1e6) : Json();
}

std::string TimeText(Time time) { return std::to_string(ToNanoseconds(time)); }

// Rounds to a twentieth of a pixel: the drawing is no finer, and the text is half as long.
double Rounded(double px) { return std::round(px * 20) / 20; }

Json Numbers(const Eigen::Vector2d& vector) { return {vector.x(), vector.y()}; }

Json Shape(const OverlayShape& shape) {
  Json outline = Json::array();
  for (const cv::Point2f& point : shape.outline) {
    outline.push_back(Rounded(point.x));
    outline.push_back(Rounded(point.y));
  }
  return {{"layer", ToString(shape.layer)},
          {"label", shape.label},
          {"outline", std::move(outline)},
          {"closed", shape.is_closed},
          {"run", shape.run}};
}

Json Object(const ViewMapObject& object) {
  const Eigen::Matrix2d& c = object.covariance;
  return {{"label", object.label},
          {"color", object.color},
          {"position", Numbers(object.position)},
          {"covariance", {c(0, 0), c(0, 1), c(1, 1)}}};
}

Json Objects(const std::vector<ViewMapObject>& objects) {
  Json list = Json::array();
  for (const ViewMapObject& object : objects) list.push_back(Object(object));
  return list;
}

Json Message(const ViewSample& sample) {
  return {{"kind", "sample"}, {"time", TimeText(sample.time)}, {"values", sample.values}};
}

Json Message(const ConsoleSources& sources) {
  Json ages = Json::array();
  for (const ConsoleSources::Age& one : sources.ages) {
    ages.push_back({{"name", ToString(one.source)}, {"age_ms", Milliseconds(one.age)}});
  }
  return {{"kind", "sources"}, {"time", TimeText(sources.time)}, {"sources", std::move(ages)}};
}

Json Message(const ViewStatus& status) {
  return {{"kind", "status"},        {"state", status.state},
          {"reason", status.reason}, {"recording", status.is_recording},
          {"over", status.is_over},  {"replay", status.replay}};
}

Json Message(const ViewMap& map) {
  return {{"kind", "map"},
          {"uav", map.uav ? Numbers(*map.uav) : Json()},
          {"heading", map.uav_heading},
          {"target", map.target ? Object(*map.target) : Json()},
          {"velocity", Numbers(map.target_velocity)},
          {"prediction", Objects(map.prediction)},
          {"objects", Objects(map.objects)},
          {"mapped", Objects(map.mapped)}};
}

Json Message(const ViewedTeam& team) {
  Json objects = Json::array();
  for (const ViewedTeamObject& known : team.objects) {
    Json object = Object(known.object);
    object["uavs"] = known.uavs;
    object["holder"] = known.holder;
    objects.push_back(std::move(object));
  }
  return {{"kind", "team"}, {"objects", std::move(objects)}};
}

Json Checks(const std::vector<ConsoleCheck>& checks) {
  Json list = Json::array();
  for (const ConsoleCheck& check : checks) {
    list.push_back({{"name", check.name},
                    {"verdict", check.verdict},
                    {"measured", check.measured},
                    {"advice", check.advice}});
  }
  return list;
}

Json Message(const ConsoleHealth& health) {
  return {{"kind", "health"}, {"checks", Checks(health.checks)}};
}

Json Message(const ConsoleVehicle& vehicle) {
  Json limits = Json::array();
  for (const ConsoleVehicle::Use& use : vehicle.limits) {
    limits.push_back({{"limit", use.limit}, {"share", use.share}});
  }
  return {{"kind", "vehicle"},
          {"facts", Checks(vehicle.facts)},
          {"limits", std::move(limits)},
          {"cannot_follow", vehicle.cannot_follow}};
}

Json Message(const ConsoleDoctor& doctor) {
  return {{"kind", "doctor"}, {"checks", Checks(doctor.checks)}};
}

Json Message(const SessionEvent& event) {
  static constexpr const char* kLevels[] = {"info", "warning", "error"};
  return {{"kind", "event"},
          {"time", TimeText(event.time)},
          {"level", kLevels[static_cast<int>(event.level)]},
          {"text", event.text}};
}

Json Message(const ConsoleLog& log) {
  Json events = Json::array();
  for (const SessionEvent& event : log.events) events.push_back(Message(event));
  return {{"kind", "log"}, {"events", std::move(events)}};
}

// One character per frame.
std::string Marks(const std::vector<FrameMark>& marks) {
  std::string text;
  for (const FrameMark mark : marks) text += "-flx"[static_cast<int>(mark)];
  return text;
}

Json WholeMilliseconds(const std::vector<Duration>& times) {
  Json list = Json::array();
  for (const Duration time : times) {
    list.push_back(std::chrono::duration_cast<std::chrono::milliseconds>(time).count());
  }
  return list;
}

Json Message(const ConsoleSeries& series) {
  return {
      {"kind", "series"}, {"times_ms", WholeMilliseconds(series.times)}, {"values", series.values}};
}

Json Message(const ConsoleTimeline& timeline) {
  return {{"kind", "timeline"},
          {"begin", TimeText(timeline.begin)},
          {"times_ms", WholeMilliseconds(timeline.times)},
          {"marks", Marks(timeline.marks)}};
}

Json Message(const ConsolePlayback& playback) {
  return {{"kind", "playback"}, {"frame", playback.frame}, {"speed", playback.speed}};
}

Json Message(const ConsoleOptionList& list) {
  Json options = Json::array();
  for (const ConsoleOption& option : list.options) {
    options.push_back({{"name", option.name},
                       {"value", option.value},
                       {"unit", option.unit},
                       {"meaning", option.meaning}});
  }
  return {{"kind", "options"}, {"options", std::move(options)}};
}

Json Message(const ConsoleSecondRun& run) {
  static constexpr const char* kStates[] = {"none", "running", "done", "cancelled", "failed"};
  return {{"kind", "second"},         {"state", kStates[static_cast<int>(run.state)]},
          {"settings", run.settings}, {"done", run.done},
          {"error", run.error},       {"marks", Marks(run.marks)}};
}

Json Message(const ConsoleFindings& findings) {
  Json runs = Json::array();
  for (const std::vector<ViewFact>& facts : findings.runs) {
    Json& run = runs.emplace_back(Json::array());
    for (const ViewFact& fact : facts) {
      run.push_back({{"name", fact.name}, {"value", fact.value}});
    }
  }
  return {{"kind", "findings"}, {"frame", findings.frame}, {"runs", std::move(runs)}};
}

Json Message(const ConsoleSettings& state) {
  Json settings = Json::array();
  for (const ConsoleSetting& one : state.settings) {
    settings.push_back({{"name", one.name},
                        {"label", one.label},
                        {"value", one.value},
                        {"unit", one.unit},
                        {"meaning", one.meaning},
                        {"choices", one.choices},
                        {"given", one.is_given}});
  }
  return {{"kind", "settings"},
          {"file", state.file},
          {"settings", std::move(settings)},
          {"saved", state.saved},
          {"error", state.error}};
}

Json Message(const ConsoleClip& clip) {
  return {{"kind", "clip"}, {"done", clip.done}, {"frames", clip.frames}};
}

// NaN becomes null, as in all messages.
Json Message(const ConsoleCalibration& calibration) { return CalibrationJson(calibration); }

}  // namespace

std::string ToJson(const ConsoleFeed::Description& description) {
  Json series = Json::array(), layers = Json::array(), offers = Json::array();
  Json views = Json::array();
  for (const SeriesDescription& one : description.series) {
    Json sources = Json::array();
    for (const ValueSource source : one.sources) sources.push_back(ToString(source));
    series.push_back({{"name", one.name},
                      {"unit", one.unit},
                      {"label", one.label},
                      {"sources", std::move(sources)},
                      {"is_count", one.is_count}});
  }
  for (const OverlayLayer layer : description.layers) layers.push_back(ToString(layer));
  for (const ImageView& view : description.views) views.push_back(view.name);
  for (const ConsoleCommandKind kind : description.offers) offers.push_back(ToString(kind));
  return Text({{"kind", "hello"},
               {"title", description.title},
               {"live", description.is_live},
               {"series", std::move(series)},
               {"layers", std::move(layers)},
               {"views", std::move(views)},
               {"offers", std::move(offers)},
               {"exports", description.has_exports},
               {"colors", description.has_colors}});
}

std::string ToJson(const ConsoleUpdate& update) {
  return Text(std::visit([](const auto& one) { return Message(one); }, update));
}

std::string FrameJson(const ConsoleFrame& frame, const std::string& view,
                      std::optional<Duration> age) {
  Json shapes = Json::array();
  for (const OverlayShape& shape : frame.shapes) shapes.push_back(Shape(shape));
  return Text({{"sequence", frame.sequence},
               {"time", TimeText(frame.captured)},
               {"age_ms", Milliseconds(age)},
               {"view", view},
               {"width", frame.image.cols},
               {"height", frame.image.rows},
               {"shapes", std::move(shapes)}});
}

std::string ToJson(const LinkReport& report) {
  return Text({{"kind", "link"},
               {"dropped", report.dropped_messages},
               {"images", report.images},
               {"draw_ms", Milliseconds(report.draw_time)},
               {"clients", report.clients}});
}

}  // namespace kestrel
