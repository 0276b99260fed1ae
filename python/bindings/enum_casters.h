// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Enums are enums in Python, too. The values of their members are words, "ring" or "tracking",
// those of the tables and the command; a word is accepted in place of a member.

#include <array>
#include <string>

#include "casters.h"
#include "kestrel/frame.h"
#include "kestrel/hunt_pipeline.h"
#include "kestrel/landing_pipeline.h"

namespace kestrel::python {

// The values of an enum with their words, and its name.
template <class Enum>
struct Words;

// The class of an enum in Python. BindEnums sets it; the interpreter keeps it.
template <class Enum>
pybind11::handle& EnumClass() {
  static pybind11::handle enum_class;
  return enum_class;
}

template <class Enum, auto... values>
struct WordsByToString {
  static constexpr std::array kValues = {values...};
  static const char* Of(Enum value) { return ToString(value); }
};

template <>
struct Words<DetectionMethod> {
  static constexpr char kName[] = "DetectionMethod";
  static constexpr auto kValues = kDetectionMethods;
  static const char* Of(DetectionMethod value) { return ToString(value); }
};
template <>
struct Words<LandingStage>
    : WordsByToString<LandingStage, LandingStage::kBinarize, LandingStage::kAreas,
                      LandingStage::kRing, LandingStage::kCross, LandingStage::kMatch,
                      LandingStage::kLocate, LandingStage::kFound> {
  static constexpr char kName[] = "LandingStage";
};
template <>
struct Words<MeasurementFate>
    : WordsByToString<MeasurementFate, MeasurementFate::kStarted, MeasurementFate::kAccepted,
                      MeasurementFate::kInvalid, MeasurementFate::kTooOld,
                      MeasurementFate::kFarFromTrack> {
  static constexpr char kName[] = "MeasurementFate";
};
template <>
struct Words<TrackState>
    : WordsByToString<TrackState, TrackState::kSearching, TrackState::kTracking,
                      TrackState::kPredicting, TrackState::kLost> {
  static constexpr char kName[] = "TrackState";
};
template <>
struct Words<PoseLookup>
    : WordsByToString<PoseLookup, PoseLookup::kFound, PoseLookup::kEmpty, PoseLookup::kTooOld,
                      PoseLookup::kTooNew, PoseLookup::kGap, PoseLookup::kPredicted,
                      PoseLookup::kNoGimbal> {
  static constexpr char kName[] = "PoseLookup";
};
template <>
struct Words<PositionMethod>
    : WordsByToString<PositionMethod, PositionMethod::kSize, PositionMethod::kAltitude> {
  static constexpr char kName[] = "PositionMethod";
};
template <>
struct Words<Completeness> : WordsByToString<Completeness, Completeness::kWhole,
                                             Completeness::kCutOff, Completeness::kMerged> {
  static constexpr char kName[] = "Completeness";
};
template <>
struct Words<ObjectShape>
    : WordsByToString<ObjectShape, ObjectShape::kDisc, ObjectShape::kCuboid, ObjectShape::kBar> {
  static constexpr char kName[] = "ObjectShape";
};

template <>
struct Words<PoseStatus> {
  static constexpr char kName[] = "PoseStatus";
  static constexpr std::array kValues = {PoseStatus::kOk, PoseStatus::kOutOfOrder,
                                         PoseStatus::kInvalid};
  static const char* Of(PoseStatus value) {
    static constexpr std::array kWords = {"ok", "out of order", "invalid"};
    return kWords[static_cast<std::size_t>(value)];
  }
};
// The words of a calibration file.
template <>
struct Words<DistortionModel> {
  static constexpr char kName[] = "DistortionModel";
  static constexpr std::array kValues = {DistortionModel::kNone, DistortionModel::kRadialTangential,
                                         DistortionModel::kEquidistant};
  static const char* Of(DistortionModel value) {
    static constexpr std::array kWords = {"none", "radial-tangential", "equidistant"};
    return kWords[static_cast<std::size_t>(value)];
  }
};
template <>
struct Words<PixelFormat> {
  static constexpr char kName[] = "PixelFormat";
  static constexpr std::array kValues = {PixelFormat::kGray, PixelFormat::kBgr};
  static const char* Of(PixelFormat value) { return value == PixelFormat::kGray ? "gray" : "bgr"; }
};

template <class Enum>
struct EnumCaster {
  PYBIND11_TYPE_CASTER(Enum, pybind11::detail::const_name(Words<Enum>::kName));

  bool load(pybind11::handle source, bool /*convert*/) {
    if (!pybind11::isinstance<pybind11::str>(source)) return false;
    const auto word = source.cast<std::string>();
    for (const Enum candidate : Words<Enum>::kValues) {
      if (word != Words<Enum>::Of(candidate)) continue;
      value = candidate;
      return true;
    }
    return false;
  }
  static pybind11::handle cast(Enum enumerator, pybind11::return_value_policy /*policy*/,
                               pybind11::handle /*parent*/) {
    return EnumClass<Enum>()(Words<Enum>::Of(enumerator)).release();
  }
};

}  // namespace kestrel::python

namespace pybind11::detail {

template <class Enum>
struct type_caster<Enum, enable_if_t<(sizeof(kestrel::python::Words<Enum>) > 0)>>
    : kestrel::python::EnumCaster<Enum> {};

}  // namespace pybind11::detail
