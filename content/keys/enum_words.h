// Names of enumerators in level files and arguments, defined once. A new enumerator without a name does not compile
// (-Wswitch).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "components/deformable.h"
#include "components/effect.h"
#include "components/haptic_device.h"
#include "components/joint.h"
#include "components/probe.h"
#include "components/registered.h"
#include "components/soft_body.h"

namespace pliant {

// Returns nullptr after the last enumerator. Enumerators count from 0 without gaps.
constexpr const char* word_of(Response response) {
  switch (response) {
    case Response::kFollow:
      return "follow";
    case Response::kLag:
      return "lag";
  }
  return nullptr;
}

constexpr const char* word_of(Distance distance) {
  switch (distance) {
    case Distance::kChord:
      return "chord";
    case Distance::kSurface:
      return "surface";
  }
  return nullptr;
}

constexpr const char* word_of(SphereForce sphere) {
  switch (sphere) {
    case SphereForce::kHertz:
      return "hertz";
    case SphereForce::kSneddon:
      return "sneddon";
  }
  return nullptr;
}

constexpr const char* word_of(Fill fill) {
  switch (fill) {
    case Fill::kSolid:
      return "solid";
    case Fill::kWall:
      return "wall";
  }
  return nullptr;
}

constexpr const char* word_of(UnderGravity shape) {
  switch (shape) {
    case UnderGravity::kFalls:
      return "falls";
    case UnderGravity::kSettled:
      return "settled";
    case UnderGravity::kModelled:
      return "modelled";
  }
  return nullptr;
}

constexpr const char* word_of(TissueLaw law) {
  switch (law) {
    case TissueLaw::kCorotational:
      return "corotational";
    case TissueLaw::kNeoHookean:
      return "neo_hookean";
    case TissueLaw::kFung:
      return "fung";
  }
  return nullptr;
}

constexpr const char* word_of(SoftContact contact) {
  switch (contact) {
    case SoftContact::kLattice:
      return "lattice";
    case SoftContact::kSplit:
      return "split";
    case SoftContact::kAuto:
      return "auto";
  }
  return nullptr;
}

constexpr const char* word_of(StepMethod method) {
  switch (method) {
    case StepMethod::kEuler:
      return "euler";
    case StepMethod::kSecondOrder:
      return "second_order";
    case StepMethod::kQuasiStatic:
      return "quasi_static";
  }
  return nullptr;
}

constexpr const char* word_of(Elements elements) {
  switch (elements) {
    case Elements::kTetrahedra:
      return "tetrahedra";
    case Elements::kHexahedra:
      return "hexahedra";
  }
  return nullptr;
}

constexpr const char* word_of(Carries carries) {
  switch (carries) {
    case Carries::kNothing:
      return "nothing";
    case Carries::kInside:
      return "inside";
  }
  return nullptr;
}

constexpr const char* word_of(ProbeMeets meets) {
  switch (meets) {
    case ProbeMeets::kAll:
      return "all";
    case ProbeMeets::kSurfaces:
      return "surfaces";
    case ProbeMeets::kBodies:
      return "bodies";
  }
  return nullptr;
}

constexpr const char* word_of(DriverKind driver) {
  switch (driver) {
    case DriverKind::kNull:
      return "null";
    case DriverKind::kScript:
      return "script";
    case DriverKind::kOrbit:
      return "orbit";
    case DriverKind::kMouse:
      return "mouse";
    case DriverKind::kExternal:
      return "external";
  }
  return nullptr;
}

constexpr const char* word_of(Attachment attachment) {
  switch (attachment) {
    case Attachment::kSpring:
      return "spring";
    case Attachment::kSlave:
      return "slave";
  }
  return nullptr;
}

constexpr const char* word_of(ToolForce force) {
  switch (force) {
    case ToolForce::kHeld:
      return "held";
    case ToolForce::kLinear:
      return "linear";
    case ToolForce::kContacts:
      return "contacts";
  }
  return nullptr;
}

constexpr const char* word_of(EffectKind kind) {
  return static_cast<std::size_t>(kind) < std::size(kEffectRows) ? row_of(kind).word : nullptr;
}

constexpr const char* word_of(JointKind kind) {
  return static_cast<std::size_t>(kind) < std::size(kJointRows) ? kJointRows[static_cast<std::size_t>(kind)].word
                                                                : nullptr;
}

constexpr const char* word_of(EffectRegion region) {
  switch (region) {
    case EffectRegion::kEverywhere:
      return "everywhere";
    case EffectRegion::kSphere:
      return "sphere";
    case EffectRegion::kBox:
      return "box";
    case EffectRegion::kHalfSpace:
      return "half_space";
  }
  return nullptr;
}

constexpr const char* word_of(EffectTarget target) {
  switch (target) {
    case EffectTarget::kPoint:
      return "point";
    case EffectTarget::kSegment:
      return "segment";
    case EffectTarget::kPlane:
      return "plane";
  }
  return nullptr;
}

constexpr const char* word_of(DetentAxis axis) {
  switch (axis) {
    case DetentAxis::kAlong:
      return "along";
    case DetentAxis::kAround:
      return "around";
  }
  return nullptr;
}

// All names of an enumeration, in the order of its values.
template <class Enum>
std::vector<std::string> words_of() {
  std::vector<std::string> words;
  while (const char* word = word_of(static_cast<Enum>(words.size()))) words.emplace_back(word);
  return words;
}

template <class Enum>
std::optional<Enum> value_of_word(const std::string& word) {
  const std::vector<std::string> words = words_of<Enum>();
  for (std::size_t i = 0; i < words.size(); ++i)
    if (words[i] == word) return static_cast<Enum>(i);
  return std::nullopt;
}

}  // namespace pliant
