// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Enums are words in Python: "ring", "tracking". They are those of the tables and the command.

#include <array>
#include <string>

#include "casters.h"
#include "kestrel/frame.h"
#include "kestrel/hunt_pipeline.h"
#include "kestrel/landing_pipeline.h"

namespace kestrel::python {

// The values of an enum with their words.
template <class Enum>
struct Words;

template <class Enum, auto... values>
struct WordsByToString {
  static constexpr std::array kValues = {values...};
  static const char* Of(Enum value) { return ToString(value); }
};

template <>
struct Words<DetectionMethod> {
  static constexpr auto kValues = kDetectionMethods;
  static const char* Of(DetectionMethod value) { return ToString(value); }
};
template <>
struct Words<LandingStage>
    : WordsByToString<LandingStage, LandingStage::kBinarize, LandingStage::kAreas,
                      LandingStage::kRing, LandingStage::kCross, LandingStage::kMatch,
                      LandingStage::kLocate, LandingStage::kFound> {};
template <>
struct Words<MeasurementFate>
    : WordsByToString<MeasurementFate, MeasurementFate::kStarted, MeasurementFate::kAccepted,
                      MeasurementFate::kInvalid, MeasurementFate::kTooOld,
                      MeasurementFate::kFarFromTrack> {};
template <>
struct Words<TrackState>
    : WordsByToString<TrackState, TrackState::kSearching, TrackState::kTracking,
                      TrackState::kPredicting, TrackState::kLost> {};
template <>
struct Words<PoseLookup>
    : WordsByToString<PoseLookup, PoseLookup::kFound, PoseLookup::kEmpty, PoseLookup::kTooOld,
                      PoseLookup::kTooNew, PoseLookup::kGap, PoseLookup::kPredicted> {};
template <>
struct Words<PositionMethod>
    : WordsByToString<PositionMethod, PositionMethod::kSize, PositionMethod::kAltitude> {};
template <>
struct Words<Completeness> : WordsByToString<Completeness, Completeness::kWhole,
                                             Completeness::kCutOff, Completeness::kMerged> {};
template <>
struct Words<ObjectShape>
    : WordsByToString<ObjectShape, ObjectShape::kDisc, ObjectShape::kCuboid, ObjectShape::kBar> {};

template <>
struct Words<PoseStatus> {
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
  static constexpr std::array kValues = {DistortionModel::kNone, DistortionModel::kRadialTangential,
                                         DistortionModel::kEquidistant};
  static const char* Of(DistortionModel value) {
    static constexpr std::array kWords = {"none", "radial-tangential", "equidistant"};
    return kWords[static_cast<std::size_t>(value)];
  }
};
template <>
struct Words<PixelFormat> {
  static constexpr std::array kValues = {PixelFormat::kGray, PixelFormat::kBgr};
  static const char* Of(PixelFormat value) { return value == PixelFormat::kGray ? "gray" : "bgr"; }
};

template <class Enum>
struct EnumCaster {
  PYBIND11_TYPE_CASTER(Enum, pybind11::detail::const_name("str"));

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
    return pybind11::str(Words<Enum>::Of(enumerator)).release();
  }
};

}  // namespace kestrel::python

namespace pybind11::detail {

template <class Enum>
struct type_caster<Enum, enable_if_t<(sizeof(kestrel::python::Words<Enum>) > 0)>>
    : kestrel::python::EnumCaster<Enum> {};

}  // namespace pybind11::detail
