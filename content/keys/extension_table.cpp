#include "content/keys/extension_table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "components/bonded_layer.h"
#include "components/monotone_cubic.h"
#include "content/keys/enum_words.h"
#include "content/level/spawn_soft.h"
#include "content/mesh/mesh_crease.h"
#include "content/tets/tet_file.h"

namespace pliant {

namespace {

// Accessor of a component's member, or of a member of its authored part, from its owner.
template <class Owner, class T, class Part, class Member>
auto at(std::optional<T> Owner::*slot, Member Part::*member) {
  return [slot, member](void* owner) -> Member& { return (*(static_cast<Owner*>(owner)->*slot)).*member; };
}
template <class Owner, class T, class Part, class Member>
auto at(T Owner::*slot, Member Part::*member) {
  return [slot, member](void* owner) -> Member& { return (static_cast<Owner*>(owner)->*slot).*member; };
}

// Key with get and set through conversions to and from JSON.
template <class Access, class ToJson, class FromJson>
Key key(std::string name, std::string unit, KeyType type, std::string doc, Access access, ToJson to_json,
        FromJson from_json) {
  Key out;
  out.name = std::move(name);
  out.unit = std::move(unit);
  out.type = type;
  out.doc = std::move(doc);
  out.get = [access, to_json](const void* owner) { return Json(to_json(access(const_cast<void*>(owner)))); };
  out.set = [access, from_json](void* owner, const Json& value) { access(owner) = from_json(value); };
  return out;
}

template <class Access>
Key number(std::string name, std::string unit, Range range, Access access, std::string doc) {
  Key out = key(
      std::move(name), std::move(unit), KeyType::kNumber, std::move(doc), access, [](double value) { return value; },
      [](const Json& json) { return json.get<double>(); });
  out.range = range;
  return out;
}
// Allowed and usual range of a number.
struct Ranges {
  Ranges(Range may_be, Range usually) : hard(may_be), usual(usually) {}
  Range hard, usual;
};
template <class Access>
Key number(std::string name, std::string unit, Ranges ranges, Access access, std::string doc) {
  Key out = number(std::move(name), std::move(unit), ranges.hard, access, std::move(doc));
  out.usual = ranges.usual;
  return out;
}
template <class Access>
Key text(std::string name, KeyType type, Access access, std::string doc) {
  return key(
      std::move(name), type == KeyType::kNode ? "node" : "", type, std::move(doc), access,
      [](const std::string& value) { return value; }, [](const Json& json) { return json.get<std::string>(); });
}
template <class Access>
Key flag(std::string name, Access access, std::string doc) {
  return key(
      std::move(name), "", KeyType::kFlag, std::move(doc), access, [](bool value) { return value; },
      [](const Json& json) { return json.get<bool>(); });
}
template <class Access>
Key choice(std::string name, Access access, std::string doc) {
  using Enum = std::remove_reference_t<decltype(access(nullptr))>;
  Key out = key(
      std::move(name), "", KeyType::kChoice, std::move(doc), access,
      [](Enum value) {
        const char* const word = word_of(value);
        return std::string(word ? word : "(no such value)");  // for an invalid enumerator set by a program
      },
      [](const Json& json) { return *value_of_word<Enum>(json.get<std::string>()); });
  out.choices = words_of<Enum>;
  return out;
}
template <class Access>
Key pair(std::string name, std::string unit, Access access, std::string doc) {
  Key out = key(
      std::move(name), std::move(unit), KeyType::kPair, std::move(doc), access,
      [](const std::array<double, 2>& value) { return value; },
      [](const Json& json) {
        return std::array<double, 2>{json[0].get<double>(), json[1].get<double>()};
      });
  out.range = kPairRange;
  return out;
}
template <class Access>
Key box(std::string name, Access access, std::string doc) {
  const auto corner = [](vec3 p) { return Json::array({p.x, p.y, p.z}); };
  const auto point = [](const Json& json) {
    return vec3(json[0].get<float>(), json[1].get<float>(), json[2].get<float>());
  };
  return key(
      std::move(name), "m", KeyType::kBox, std::move(doc), access,
      [corner](const Box& value) {
        return value.empty() ? Json() : Json{{"min", corner(value.min)}, {"max", corner(value.max)}};
      },
      [point](const Json& json) {
        return json.is_null() ? Box{} : Box{point(json["min"]), point(json["max"])};
      });
}

template <class Access>
Key double_box(std::string name, Access access, std::string doc) {
  const auto corner = [](dvec3 p) { return Json::array({p.x, p.y, p.z}); };
  const auto point = [](const Json& json) {
    return dvec3(json[0].get<double>(), json[1].get<double>(), json[2].get<double>());
  };
  return key(
      std::move(name), "m", KeyType::kBox, std::move(doc), access,
      [corner](const DBox& value) {
        return value.empty() ? Json() : Json{{"min", corner(value.min)}, {"max", corner(value.max)}};
      },
      [point](const Json& json) {
        return json.is_null() ? DBox{} : DBox{point(json["min"]), point(json["max"])};
      });
}

// One number points down.
template <class Access>
Key vector(std::string name, std::string unit, Ranges ranges, Access access, std::string doc) {
  Key out = key(
      std::move(name), std::move(unit), KeyType::kVector, std::move(doc), access,
      [](dvec3 v) {
        return Json::array({v.x, v.y, v.z});
      },
      [](const Json& json) {
        return json.is_number() ? dvec3(0.0, -json.get<double>(), 0.0)
                                : dvec3(json[0].get<double>(), json[1].get<double>(), json[2].get<double>());
      });
  out.range = ranges.hard;
  out.usual = ranges.usual;
  return out;
}

// Accessor of an item's member.
template <class Item, class Member>
auto of_item(Member Item::*member) {
  return [member](void* owner) -> Member& { return static_cast<Item*>(owner)->*member; };
}

// Keys of an item of `layers`; their owner is a Layer.
std::vector<Key> layer_keys() {
  using R = DeformableRange;
  const auto l = [](auto member) { return of_item<Layer>(member); };
  std::vector<Key> keys;
  keys.push_back(text("name", KeyType::kText, l(&Layer::name), "name in events"));
  keys.push_back(number("thickness", "m", {R::kLayerThickness, {1e-4, 0.1}}, l(&Layer::thickness),
                        "its thickness; the next one begins below"));
  keys.push_back(number("stiffness", "N/m", {R::kStiffness, {1.0, 1e5}}, l(&Layer::stiffness),
                        "small-depth slope of its force below its top, by the law `spring`"));
  keys.push_back(
      number("force", "N", {R::kBreakingForce, {0.05, 20.0}}, l(&Layer::force), "force that breaks it; 0: none"));
  keys.push_back(number("energy", "J", {R::kBreakingEnergy, {1e-5, 1.0}}, l(&Layer::energy),
                        "stored energy that breaks it; 0: none"));
  keys.push_back(number("remains", "1", R::kRemains, l(&Layer::remains),
                        "share of its force, and of the outer layer's dent, left where it is broken"));
  keys.push_back(
      number("grip", "N/m", {R::kGrip, {1.0, 1e3}}, l(&Layer::grip), "friction along a probe in its hole, per length"));
  return keys;
}

// A list of objects of type Item. `always`: the key that is saved even at its default.
template <class Item, class Owner = LevelNode, class Get, class Set>
Key items_key(std::string name, std::string doc, std::vector<Key> items, std::string always, Get list_of,
              Set set_list) {
  Key out;
  out.name = std::move(name);
  out.type = KeyType::kItems;
  out.doc = std::move(doc);
  static const Item usual;
  out.usual_item = &usual;
  out.items = std::move(items);
  out.get = [items = out.items, always, list_of](const void* owner) {
    Json list = Json::array();
    for (const Item& each : list_of(*static_cast<const Owner*>(owner))) {
      Json item = Json::object();
      for (const Key& key : items)
        if (Json value = key.get(&each); !(value == key.get(&usual)) || key.name == always) item[key.name] = value;
      list.push_back(std::move(item));
    }
    return list;
  };
  out.set = [items = out.items, set_list](void* owner, const Json& value) {
    std::vector<Item> list(value.size());
    for (std::size_t i = 0; i < list.size(); ++i)
      for (const Key& key : items)
        if (value[i].contains(key.name)) key.set(&list[i], value[i][key.name]);
    set_list(*static_cast<Owner*>(owner), std::move(list));
  };
  return out;
}

Key layers_key() {
  return items_key<Layer>(
      "layers",
      fmt::format("layers that break, downwards, at most {}; below them: the law of `stiffness`", kMostLayers),
      layer_keys(), "thickness", [](const LevelNode& node) -> const Layers& { return node.deformable->layers; },
      [](LevelNode& node, std::vector<Layer> layers) { node.deformable->layers = Layers(std::move(layers)); });
}

// Keys of an item of `materials`; their owner is a TissuePart.
std::vector<Key> tissue_part_keys() {
  const auto p = [](auto member) { return of_item<TissuePart>(member); };
  const Range young{0.0, SoftBodyRange::kYoung.max}, density{0.0, SoftBodyRange::kDensity.max};
  std::vector<Key> keys;
  keys.push_back(text("name", KeyType::kText, p(&TissuePart::name),
                      "physical group of the file `mesh`, or node whose closed mesh lies in the tissue"));
  keys.push_back(
      number("young", "Pa", {young, {50.0, 1e9}}, p(&TissuePart::young), "its Young's modulus; 0: the body's"));
  keys.push_back(
      number("density", "kg/m3", {density, {10.0, 25e3}}, p(&TissuePart::density), "its density; 0: the body's"));
  keys.push_back(number("damping", "1", {{0.0, 1e6}, {0.1, 100.0}}, p(&TissuePart::damping),
                        "factor on the body's `rayleigh` beta"));
  keys.push_back(number("relaxation", "1", {{0.0, 1e3}, {0.01, 10.0}}, p(&TissuePart::relaxation),
                        "factor on the shares of the body's `prony`; 0: no relaxation"));
  return keys;
}

Key materials_key() {
  return items_key<TissuePart>(
      "materials",
      "parts with another material (a lump, a group of the file); of two that overlap the later one counts",
      tissue_part_keys(), "name",
      [](const LevelNode& node) -> const std::vector<TissuePart>& { return node.soft_body->materials; },
      [](LevelNode& node, std::vector<TissuePart> parts) { node.soft_body->materials = std::move(parts); });
}

Key prony_key() {
  std::vector<Key> keys;
  keys.push_back(number("share", "1", {{0.0, 1.0}, {0.01, 0.99}}, of_item(&Prony::Arm::share),
                        "of the stress at once; all shares together are below 1"));
  keys.push_back(number("time", "s", {{0.0, 1e6, true}, {1e-3, 1e3}}, of_item(&Prony::Arm::time), "relaxation time"));
  Key out = items_key<Prony::Arm>(
      "prony",
      fmt::format("relaxation, at most {} arms: after a step of strain the stress is 1 - sum share (1 - exp(-t/time)) "
                  "of that at once",
                  Prony::kMost),
      std::move(keys), "share",
      [](const LevelNode& node) {
        const Prony& prony = node.soft_body->prony;
        return std::vector<Prony::Arm>(prony.arms.begin(),
                                       prony.arms.begin() + static_cast<std::ptrdiff_t>(prony.count));
      },
      [](LevelNode& node, const std::vector<Prony::Arm>& arms) {
        Prony& prony = node.soft_body->prony;
        prony = {};
        prony.count = std::min(arms.size(), Prony::kMost);
        std::copy_n(arms.begin(), prony.count, prony.arms.begin());
      });
  out.most = Prony::kMost;
  return out;
}

Key cavities_key() {
  std::vector<Key> keys;
  keys.push_back(text("name", KeyType::kText, of_item(&Cavity::name),
                      "node whose closed mesh encloses the hollow; left out: every remaining hollow"));
  keys.push_back(number("pressure", "Pa", {{-1e7, 1e7}, {-5e4, 5e4}}, of_item(&Cavity::pressure),
                        "over that outside, at the volume at rest"));
  keys.push_back(number("bulk", "Pa", {{0.0, 1e12}, {1e3, 1e10}}, of_item(&Cavity::bulk),
                        "rise of pressure per relative loss of volume; 1e9 for a liquid"));
  return items_key<Cavity>(
      "cavities", "closed hollows filled with gas or liquid", std::move(keys), "pressure",
      [](const LevelNode& node) -> const std::vector<Cavity>& { return node.soft_body->cavities; },
      [](LevelNode& node, std::vector<Cavity> cavities) { node.soft_body->cavities = std::move(cavities); });
}

Key rigid_key() {
  std::vector<Key> keys;
  keys.push_back(text("name", KeyType::kText, of_item(&RigidPart::name), "name, for joints"));
  keys.push_back(double_box("box", of_item(&RigidPart::box), "its nodes, in the object frame"));
  Key out = items_key<RigidPart>(
      "rigid", fmt::format("rigid parts besides a handle: bones, at most {}", kMostRigidParts), std::move(keys), "name",
      [](const LevelNode& node) -> const std::vector<RigidPart>& { return node.soft_body->rigid; },
      [](LevelNode& node, std::vector<RigidPart> parts) { node.soft_body->rigid = std::move(parts); });
  out.most = kMostRigidParts;
  return out;
}

void add_fibre_keys(std::vector<Key>& keys) {
  const auto f = [](auto member) {
    return [member](void* owner) -> auto& {
      return static_cast<LevelNode*>(owner)->soft_body->fibres.*member;
    };
  };
  keys.push_back(number("fibres.young", "Pa", {{0.0, 1e12}, {50.0, 1e9}}, f(&Fibres::young),
                        "modulus that fibres add along their direction; 0: none"));
  keys.push_back(
      vector("fibres.direction", "1", {{-1e6, 1e6}, {-1e6, 1e6}}, f(&Fibres::direction), "in the object frame"));
  keys.push_back(flag("fibres.only_tension", f(&Fibres::only_tension), "they bear no compression"));
  keys.push_back(number("fibres.contraction", "1", {{0.0, 0.9}, {0.01, 0.5}}, f(&Fibres::contraction),
                        "their rest length: 1 - contraction, times that of unloaded tissue"));
  keys.push_back(number("fibres.period", "s", {{0.0, 1e6}, {0.05, 100.0}}, f(&Fibres::period),
                        "of a contraction that comes and goes; 0: constant"));
}

std::vector<Key> deformable_keys() {
  using D = Deformable;
  using R = DeformableRange;
  const auto d = [](auto member) { return at(&LevelNode::deformable, member); };
  std::vector<Key> keys;
  keys.push_back(choice("spring", d(&D::spring), "law of the normal force"));
  keys.push_back(number("stiffness", "N/m", {R::kStiffness, {1.0, 1e5}}, d(&D::stiffness),
                        "small-depth slope of normal force against depth"));
  keys.push_back(number("cubic", "N/m3", R::kCubic, d(&D::cubic),
                        "k3 of the cubic law; with `young`: 10,000/m2 of its stiffness"));
  keys.push_back(number("stiffening", "1/m", {R::kStiffening, {-1e3, 1e4}}, d(&D::stiffening),
                        "alpha of the exponential law; below 0 it softens"));
  Key table = key(
      "table", "m, N", KeyType::kTable,
      fmt::format("rows [depth, force] from [0, 0], at most {}; their slope there replaces `stiffness`",
                  ForceTable::kMost),
      d(&D::table),
      [](const ForceTable& rows) {
        Json json = Json::array();
        for (std::size_t i = 0; i < rows.count; ++i) json.push_back(rows.rows[i]);
        return json;
      },
      [](const Json& json) {
        ForceTable rows;
        for (const Json& row : json) rows.rows[rows.count++] = {row[0].get<double>(), row[1].get<double>()};
        return rows;
      });
  table.range = R::kTable;
  keys.push_back(table);
  keys.push_back(number("relaxation.stiffness", "N/m", {R::kRelaxationStiffness, {1.0, 1e5}},
                        d(&D::relaxation_stiffness),
                        "small-depth slope of a relaxing law's arm; with `young`: its stiffness"));
  keys.push_back(number("relaxation.time", "s", {R::kRelaxationTime, {1e-3, 1e3}}, d(&D::relaxation_time),
                        "relaxation time of the arm"));
  keys.push_back(number("damping_ratio", "1", {R::kDampingRatio, {0.01, 20.0}}, d(&D::damping_ratio),
                        "damping ratio of the free surface"));
  keys.push_back(number("settling_time", "s", {R::kSettlingTime, {1e-3, 10.0}}, d(&D::settling_time),
                        "2 % settling time of the free surface"));
  Key damping;
  damping.name = "contact_damping";
  damping.unit = "N s/m";
  damping.type = KeyType::kNumberOrMaterial;
  damping.range = R::kContactDamping;
  damping.doc = "rate term of the probe's force; `material` takes b of the local model, as P1 does";
  damping.get = [](const void* owner) {
    const D& it = *static_cast<const LevelNode*>(owner)->deformable;
    return it.contact_damping_material ? Json("material") : Json(it.contact_damping);
  };
  damping.set = [](void* owner, const Json& value) {
    D& it = *static_cast<LevelNode*>(owner)->deformable;
    it.contact_damping_material = value.is_string();
    it.contact_damping = value.is_string() ? 0.0 : value.get<double>();
  };
  keys.push_back(damping);
  keys.push_back(
      choice("response", d(&D::response), "drawn surface follows a pressing probe, or lags by its settling time"));
  keys.push_back(choice("shape", d(&D::shape), "shape of the dent around the probe"));
  keys.push_back(choice("distance", d(&D::distance), "argument of the shape: straight, or along the surface"));
  keys.push_back(
      number("reach", "m", {R::kReach, {1e-4, 1.0}}, d(&D::reach),
             fmt::format("radius R of the field; 0: {} of the diagonal of the object's box", kDefaultReach)));
  keys.push_back(number("volume", "1", R::kVolume, d(&D::volume), "volume share that the shape `volume` conserves"));
  std::vector<std::string> depending;
  for (std::size_t i = 0; i < std::size(kShapeRows); ++i)
    if (depends_on_contact(static_cast<Shape>(i))) depending.emplace_back(kShapeRows[i].word);
  keys.push_back(
      number("contact_radius", "m", {R::kContactRadius, {1e-4, 1.0}}, d(&D::contact_radius),
             fmt::format("indenter's radius of the shapes {}, beside the probe's contact circle; 0: a fifth of `reach`",
                         listed(depending))));
  keys.push_back(number("friction_static", "1", kFrictionRange, d(&D::friction_static),
                        "coefficient of static friction, at least that of sliding"));
  keys.push_back(
      number("friction_sliding", "1", kFrictionRange, d(&D::friction_sliding), "coefficient of sliding friction"));
  Key both =
      number("friction", "1", kFrictionRange, d(&D::friction_static), "sets friction_static and friction_sliding");
  both.alias = true;
  both.set = [](void* owner, const Json& value) {
    D& it = *static_cast<LevelNode*>(owner)->deformable;
    it.friction_static = it.friction_sliding = value.get<double>();
  };
  keys.push_back(both);
  keys.push_back(number("friction_stribeck", "m/s", {R::kStribeck, {1e-4, 1.0}}, d(&D::friction_stribeck),
                        "speed v_s of the fall from static to sliding, exp(-(v/v_s)^2); 0: at once"));
  keys.push_back(number("friction_viscous", "s/m", {R::kViscous, {0.01, 10.0}}, d(&D::friction_viscous),
                        "rise of sliding friction with speed"));
  keys.push_back(number("texture.amplitude", "m", {R::kTextureAmplitude, {1e-6, 1e-3}}, d(&D::texture_amplitude),
                        "felt roughness, root mean square; 0: smooth"));
  keys.push_back(number("texture.wavelength", "m", {R::kTextureWavelength, {1e-4, 0.05}}, d(&D::texture_wavelength),
                        "length of its waves"));
  keys.push_back(number("texture.seed", "1", R::kTextureSeed, d(&D::texture_seed),
                        "whole number: picks one roughness of this kind"));
  keys.back().whole = true;
  keys.push_back(number("transient.amplitude", "N s/m", {R::kTransientAmplitude, {0.1, 100.0}},
                        d(&D::transient_amplitude), "force of an impact's knock, per speed; 0: none"));
  keys.push_back(number("transient.frequency", "Hz", {R::kTransientFrequency, {20.0, 400.0}},
                        d(&D::transient_frequency), "of the knock; above 0.4 of `touch_rate` there is none"));
  keys.push_back(
      number("transient.decay", "1/s", {R::kTransientDecay, {5.0, 1000.0}}, d(&D::transient_decay), "of the knock"));
  keys.push_back(number("relief", "1", {R::kRelief, {0.01, 2.0}}, d(&D::relief),
                        "share of drawn relief (normal and height maps) that is felt"));
  keys.push_back(layers_key());
  keys.push_back(number("hole_radius", "m", {R::kHoleRadius, {1e-4, 0.05}}, d(&D::hole_radius),
                        "of the hole left in `layers`, at least the probe's"));
  keys.push_back(number("yield.force", "N", {R::kYieldForce, {0.05, 20.0}}, d(&D::yield_force),
                        "normal force above which a dent stays; 0: never"));
  keys.push_back(number("yield.hardening", "N/m", {R::kHardening, {1.0, 1e5}}, d(&D::yield_hardening),
                        "rise of that force with the depth that stays"));
  keys.push_back(number(
      "crease_angle", "rad", {0.0, 3.1416}, d(&D::crease_angle),
      fmt::format("edges whose faces turn by more are creases; 0: where the file's own normals are split, else {}",
                  kCreaseTurn)));
  keys.push_back(number("young", "Pa", {{0.0, 1e12}, {50.0, 1e9}}, d(&D::young),
                        "Young's modulus, instead of `stiffness`; 0: not given"));
  keys.push_back(number("poisson", "1", {0.0, 0.5}, d(&D::poisson), "Poisson's ratio, with `young`"));
  keys.push_back(number("thickness", "m", {{0.0, 1e6}, {1e-4, 1.0}}, d(&D::thickness),
                        "of a layer bonded to something rigid, with `young`; 0: deep"));
  keys.push_back(
      choice("sphere", d(&D::sphere), "with `young`: Hertz's sphere, or Sneddon's exact one on deep tissue"));
  keys.push_back(choice("carries", d(&D::carries),
                        "drawn meshes that are dented with it: none, or those inside or below its node"));
  keys.push_back(number("error", "1", {{0.0, 10.0}, {1e-3, 1.0}}, d(&D::error),
                        "error budget for unstated shape, distance, reach and contact radius; 0: none"));
  return keys;
}

// Constants in N/m and N/m3 are in proportion to the stiffness that follows from `young`, as their defaults are to the
// default stiffness, unless they are stated.
void scale_with_young(LevelNode& node) {
  const Deformable usual;
  Deformable& it = *node.deformable;
  const double last = node.scaled_with_young, share = it.young > 0.0 ? it.stiffness / usual.stiffness : 1.0;
  const auto scale = [&](const char* key, double Deformable::*constant) {
    if (it.*constant == usual.*constant * last && !node.stated.contains(key)) it.*constant = usual.*constant * share;
  };
  scale("deformable.relaxation.stiffness", &Deformable::relaxation_stiffness);
  scale("deformable.cubic", &Deformable::cubic);
  node.scaled_with_young = share;
}

// Keys that layers and yielding cannot be combined with.
std::optional<Note> settle_damage(const Deformable& it) {
  for (std::size_t i = 0; i < it.layers.size(); ++i)
    if (!(it.layers[i].force > 0.0) && !(it.layers[i].energy > 0.0))
      return Note{fmt::format("layer {} has neither `force` nor `energy` and would never break", i + 1),
                  "give one, or leave it out: below the layers is the law of `stiffness`", "key.missing", "layers"};
  const bool yields = it.yield_force > 0.0;
  if (it.layers.empty() && !yields) return std::nullopt;
  const std::string key = yields ? "yield.force" : "layers";
  if (!it.layers.empty() && yields)
    return Note{"gives both layers and yield.force", "keep one", "key.both", "yield.force"};
  if (has_arm(it.spring))
    return Note{fmt::format("{} cannot be combined with the law {}, whose memory is not split by depth", key,
                            word_of(it.spring)),
                "take another `spring`", "key.value", key};
  if (yields && it.response == Response::kLag)
    return Note{"yield.force needs a surface that follows the probe", "set `response` to follow", "key.value", key};
  return std::nullopt;
}

std::optional<Note> settle_deformable(void* owner) {
  LevelNode& node = *static_cast<LevelNode*>(owner);
  Deformable& it = *node.deformable;
  if (std::optional<Note> clash = settle_damage(it)) return clash;
  if (it.friction_sliding > it.friction_static)
    return Note{
        fmt::format("friction_sliding ({}) is above friction_static ({})", it.friction_sliding, it.friction_static),
        "lower it, or set `friction` for both", "key.value", "friction_sliding"};
  if (it.young > 0.0 && it.thickness > 0.0 && it.sphere == SphereForce::kSneddon)
    return Note{"gives both thickness and the sphere sneddon, which is of deep tissue",
                "keep one: on a layer a sphere is Hertz's", "key.both", "sphere"};
  if (stiffness_of_table(node)) {
    if (const char* const fault = fault_of(it.table))
      return Note{std::string("table ") + (it.table.count > 0 ? fault : "is missing"),
                  "give rows of depth and force that rise: [[0, 0], [0.001, 0.3], [0.002, 0.8]]", "key.value", "table"};
    if (it.young > 0.0)
      return Note{"gives both young and a table of force", "keep one: both say the force", "key.both", "table"};
    it.stiffness = stiffness_of(it.table);
    if (!DeformableRange::kStiffness.holds(it.stiffness))
      return Note{fmt::format("table makes a stiffness of {:.3g} N/m at depth 0", it.stiffness),
                  fmt::format("it must be in the range [{}, {}] N/m", DeformableRange::kStiffness.min,
                              DeformableRange::kStiffness.max),
                  "key.value", "table"};
  }
  if (it.young > 0.0) it.stiffness = calibrated_stiffness(it.young, it.poisson, it.thickness);
  if (it.young > 0.0 && !DeformableRange::kStiffness.holds(it.stiffness))
    return Note{fmt::format("young ({:g} Pa) makes a stiffness of {:.3g} N/m", it.young, it.stiffness),
                fmt::format("it must be in the range [{}, {}] N/m", DeformableRange::kStiffness.min,
                            DeformableRange::kStiffness.max),
                "key.value", "young"};
  scale_with_young(node);
  return std::nullopt;
}

std::vector<Key> probe_keys() {
  std::vector<Key> keys;
  keys.push_back(number("radius", "m", {kProbeLengths, {1e-4, 0.1}}, at(&LevelNode::probe, &Probe::radius),
                        "radius of every tip; 0: a point"));
  keys.push_back(number("length", "m", {kProbeLengths, {1e-3, 1.0}}, at(&LevelNode::probe, &Probe::length),
                        "length of a capsule's axis, from the node along its +Y; 0: none"));
  Key points = key(
      "points", "m", KeyType::kPoints,
      fmt::format("tips in the node's frame, at most {}, instead of the one at the node", kMostPoints),
      at(&LevelNode::probe, &Probe::points),
      [](const std::vector<vec3>& places) {
        Json json = Json::array();
        for (const vec3& p : places) json.push_back({p.x, p.y, p.z});
        return json;
      },
      [](const Json& json) {
        std::vector<vec3> places;
        for (const Json& p : json) places.emplace_back(p[0].get<float>(), p[1].get<float>(), p[2].get<float>());
        return places;
      });
  points.range = {-kProbeLengths.max, kProbeLengths.max};
  points.usual = {-0.5, 0.5};
  keys.push_back(points);
  keys.push_back(
      choice("meets", at(&LevelNode::probe, &Probe::meets), "yielding surfaces, soft and rigid bodies, or both"));
  keys.push_back(pair("coupling", "N/m, N s/m", at(&LevelNode::probe, &Probe::coupling),
                      "spring and damper between the device and a probe that meets bodies"));
  Key color = key(
      "color", "linear RGB", KeyType::kColor, "colour it is drawn in", at(&LevelNode::probe, &Probe::color),
      [](vec3 c) {
        return Json::array({c.x, c.y, c.z});
      },
      [](const Json& json) { return vec3(json[0].get<float>(), json[1].get<float>(), json[2].get<float>()); });
  color.range = {0.0, 1.0};
  keys.push_back(color);
  keys.push_back(text(
      "device", KeyType::kNode,
      [](void* owner) -> std::string& { return static_cast<LevelNode*>(owner)->probe_device; },
      "node with a PLIANT_haptic_device, by name or glTF number"));
  return keys;
}

std::vector<Key> device_keys() {
  using H = HapticDevice;
  const auto d = [](auto member) { return at(&LevelNode::device, member); };
  std::vector<Key> keys;
  keys.push_back(choice("driver", d(&H::driver), "source of the motion"));
  keys.push_back(text("file", KeyType::kText, d(&H::file), "script (CSV), relative to the level"));
  keys.push_back(text("id", KeyType::kText, d(&H::id),
                      "device of the driver `external`: DRIVER, any-force, any-pose, any, mouse, or several in turn "
                      "(semicolons), each with wrappers (bars)"));
  keys.push_back(number("scale", "1", {DeviceRange::kScale, {1e-3, 1e3}}, d(&H::scale),
                        "workspace of an `external` device to world"));
  keys.push_back(
      number("max_force", "N", {DeviceRange::kMaxForce, {0.1, 50.0}}, d(&H::max_force), "norm of the force sent"));
  keys.push_back(number("max_stiffness", "N/m", {DeviceRange::kMaxStiffness, {10.0, 1e5}}, d(&H::max_stiffness),
                        "limit on the rise of force with displacement, in the world; 0: none"));
  keys.push_back(number("max_slew", "N/s", {DeviceRange::kMaxSlew, {1.0, 1e6}}, d(&H::max_slew),
                        "limit on the rise of force with time; a released force falls by 1000 N/s at least"));
  return keys;
}

std::vector<Key> soft_body_keys() {
  using S = SoftBody;
  const auto s = [](auto member) { return at(&LevelNode::soft_body, member); };
  std::vector<Key> keys;
  keys.push_back(choice("law", s(&S::law),
                        "`corotational`: linear in the strain, cheap; `neo_hookean`: right at large strain; `fung`: "
                        "stiffens exponentially"));
  keys.push_back(
      number("young", "Pa", {SoftBodyRange::kYoung, {50.0, 1e9}}, s(&S::young), "Young's modulus at small strain"));
  keys.push_back(number(
      "poisson", "1", SoftBodyRange::kPoisson, s(&S::poisson),
      fmt::format("Poisson's ratio; from {} on the tetrahedra lock: tissue is over 10 % too stiff", kLockingPoisson)));
  keys.push_back(number("stiffening", "1", {SoftBodyRange::kStiffening, {0.1, 20.0}}, s(&S::stiffening),
                        "exponent b of `fung`: shear stress grows with exp(b (I1 - 3))"));
  keys.push_back(number("density", "kg/m3", {SoftBodyRange::kDensity, {10.0, 25e3}}, s(&S::density), "density"));
  keys.push_back(pair("rayleigh", "1/s, s", s(&S::rayleigh), "Rayleigh damping: alpha on mass, beta on stiffness"));
  keys.push_back(prony_key());
  keys.push_back(cavities_key());
  keys.push_back(rigid_key());
  add_fibre_keys(keys);
  keys.push_back(number("cell", "m", {SoftBodyRange::kCell, {1e-4, 0.2}}, s(&S::cell),
                        fmt::format("lattice cell; 0: sized for some {} tetrahedra", kUsualTets)));
  keys.push_back(choice("elements", s(&S::elements),
                        "of the lattice: `tetrahedra`, fitted to the surface; `hexahedra`, whole cells that count by "
                        "their part inside it and do not lock"));
  keys.push_back(
      box("focus", s(&S::focus),
          "box in the object frame with cells of `cell`, growing to six times outside; left out: even cells"));
  keys.push_back(choice("fill", s(&S::fill), "all that the surface encloses, or only a wall"));
  keys.push_back(number("thickness", "m", {SoftBodyRange::kThickness, {1e-4, 0.5}}, s(&S::thickness),
                        "of a wall, inwards from the surface; 0: as the surface has it"));
  keys.push_back(text(
      "mesh", KeyType::kText, s(&S::mesh),
      fmt::format("tetrahedra file ({}), instead of `cell`, relative to the level", fmt::join(tet_endings(), ", "))));
  keys.push_back(box("pinned", s(&S::pinned), "pinned part, in the object frame; left out: the attribute _PINNED"));
  keys.push_back(
      number("friction_static", "1", kFrictionRange, s(&S::friction_static), "coefficient of static friction"));
  keys.push_back(
      number("friction_sliding", "1", kFrictionRange, s(&S::friction_sliding), "coefficient of sliding friction"));
  keys.push_back(choice("solver", s(&S::solver), "linear solver; `auto` by size, as measured"));
  keys.push_back(choice("under_gravity", s(&S::under_gravity),
                        "`falls`: the mesh is the shape without weight; `settled`: the same, at rest on its pins at "
                        "first; `modelled`: the shape under its weight"));
  keys.push_back(choice("carries", s(&S::carries),
                        "drawn meshes that go with its tissue: none, or those inside or below its node"));
  keys.push_back(
      choice("contact", s(&S::contact),
             "contact acts on: `lattice`, the nodes beside it, too stiff if small against the cells; `split`, the "
             "lattice, smeared, and an analytic dent in series; `auto`, `split` where measured and in time"));
  keys.push_back(choice("integrator", s(&S::integrator),
                        "`euler` damps; `second_order` keeps swings; `quasi_static`: equilibrium in every step, for "
                        "pinned tissue; the last two not of a tool"));
  keys.push_back(vector("velocity", "m/s", {kVelocityRange, {-10.0, 10.0}}, s(&S::velocity),
                        "initial, in the world, not of a tool; one number points down (-Y)"));
  keys.push_back(materials_key());
  keys.push_back(number("error", "1", {{0.0, 10.0}, {1e-3, 1.0}}, s(&S::error),
                        "error budget for unstated cell, soft step, solver and, of a tool, force; 0: none"));
  return keys;
}

std::vector<Key> handle_keys() {
  using H = Handle6;
  const auto h = [](auto member) { return at(&LevelNode::handle, member); };
  std::vector<Key> keys;
  keys.push_back(
      box("box", h(&H::box), "rigid part of a soft body, in the object frame; left out: the attribute _HANDLE"));
  keys.push_back(choice("attachment", h(&H::attachment), "how tissue joins the handle"));
  keys.push_back(
      pair("coupling.translation", "N/m, N s/m", h(&H::translation), "spring and damper between device and handle"));
  keys.push_back(pair("coupling.rotation", "N m/rad, N m s/rad", h(&H::rotation), "the same for rotation"));
  keys.push_back(number("coupling.max_force", "N", {kSaturationRange, {0.1, 50.0}}, h(&H::max_force),
                        "saturation of the coupling's force"));
  keys.push_back(number("coupling.max_torque", "N m", {kSaturationRange, {1e-3, 10.0}}, h(&H::max_torque),
                        "saturation of the coupling's torque"));
  keys.push_back(flag("carried", h(&H::carried), "the hand does not feel the weight of the tool and of what its grip drives"));
  keys.push_back(
      choice("force", h(&H::force),
             "force in a touch tick: of the last soft step, of a linear model, or of contacts solved again"));
  keys.push_back(
      text("device", KeyType::kNode, h(&H::device), "node with a PLIANT_haptic_device, by name or glTF number"));
  return keys;
}

std::vector<Key> rigid_body_keys() {
  using R = RigidBody;
  const auto r = [](auto member) { return at(&LevelNode::rigid_body, member); };
  std::vector<Key> keys;
  keys.push_back(number("mass", "kg", {SoftBodyRange::kMass, {1e-4, 100.0}}, r(&R::mass), "mass; 0: from density"));
  keys.push_back(number("density", "kg/m3", {SoftBodyRange::kDensity, {10.0, 25e3}}, r(&R::density), "density"));
  keys.push_back(
      number("friction_static", "1", kFrictionRange, r(&R::friction_static), "coefficient of static friction"));
  keys.push_back(
      number("friction_sliding", "1", kFrictionRange, r(&R::friction_sliding), "coefficient of sliding friction"));
  keys.push_back(vector("velocity", "m/s", {kVelocityRange, {-10.0, 10.0}}, r(&R::velocity),
                        "initial, in the world, not of a tool; one number points down (-Y)"));
  keys.push_back(flag("fixed", r(&R::fixed), "does not move"));
  return keys;
}

std::vector<Key> motion_keys() {
  using M = NodeMotion;
  const auto m = [](auto member) { return at(&LevelNode::motion, member); };
  std::vector<Key> keys;
  keys.push_back(
      text("script", KeyType::kText, m(&M::script), "CSV of poses in the parent's frame, instead of animations"));
  keys.push_back(text("animation", KeyType::kText, m(&M::animation),
                      "glTF animation that moves it; left out: every one of the node"));
  keys.push_back(flag("repeat", m(&M::repeat), "starts over at the end; else the end holds"));
  keys.push_back(number("speed", "1", {{0.0, 1e3}, {0.01, 100.0}}, m(&M::speed),
                        "of the motion's clock; 0: stands at its beginning"));
  return keys;
}

std::vector<Key> effect_keys() {
  using E = Effect;
  using R = EffectRange;
  const auto e = [](auto member) { return at(&LevelNode::effect, member); };
  std::vector<Key> keys;
  keys.push_back(choice("kind", e(&E::kind), "what it does to a probe"));
  keys.push_back(key(
      "probes", "", KeyType::kNames, fmt::format("probes that feel it, at most {}; left out: all", kMostNames),
      e(&E::probes), [](const std::vector<std::string>& names) { return names; },
      [](const Json& json) { return json.get<std::vector<std::string>>(); }));
  keys.push_back(choice("region", e(&E::region), "where it acts; `half_space`: below the node's XZ plane"));
  keys.push_back(number("radius", "m", {R::kWidth, {1e-3, 1.0}}, e(&E::radius), "radius of the sphere"));
  keys.push_back(double_box("box", e(&E::box), "the box, in the node's frame"));
  keys.push_back(number("edge", "m", {R::kWidth, {1e-3, 0.1}}, e(&E::edge),
                        "depth below the region's border over which the effect comes in, at most to its middle; of "
                        "detents around, the radius within which they fade"));
  keys.push_back(number("damping", "N s/m", {R::kDamping, {0.1, 20.0}}, e(&E::damping), "drag per speed"));
  keys.push_back(vector("force", "N", {R::kForce, {-20.0, 20.0}}, e(&E::force),
                        "constant force in the node's frame; one number points down (-Y)"));
  keys.push_back(
      choice("target", e(&E::target), "what attracts: the node, a segment from it along its +Y, or its XZ plane"));
  keys.push_back(number("length", "m", {R::kLength, {1e-3, 1.0}}, e(&E::length), "length of the segment"));
  Key size = pair("size", "m", e(&E::size), "of the plane, along X and Z around the node; 0: without end");
  size.range = R::kLength;
  keys.push_back(size);
  keys.push_back(number("stiffness", "N/m", {R::kStiffness, {1.0, 5e3}}, e(&E::stiffness),
                        "of a spring to the target or path, near it; of the wall of what is forbidden"));
  keys.push_back(
      number("range", "m", {R::kWidth, {1e-3, 1.0}}, e(&E::range),
             "distance from target or path beyond which nothing pulls; the largest force is at 0.447 `range`"));
  keys.push_back(
      text("path", KeyType::kText, e(&E::path), "CSV of the guiding path in the node's frame; its times do not count"));
  keys.push_back(choice("detents", e(&E::detents), "detents along the node's +Y, or around it"));
  keys.push_back(number("spacing", "m", {R::kWidth, {1e-4, 0.1}}, e(&E::spacing), "of detents along"));
  keys.push_back(
      number("count", "1", {R::kCount, {2.0, 100.0}}, e(&E::count), "of detents around, a whole number per turn"));
  keys.back().whole = true;
  keys.push_back(number("peak", "N", {R::kPeak, {0.05, 5.0}}, e(&E::peak), "largest force from a detent to the next"));
  return keys;
}

std::vector<Key> joint_keys() {
  using J = Joint;
  using R = JointRange;
  const auto j = [](auto member) { return at(&LevelNode::joint, member); };
  std::vector<Key> keys;
  keys.push_back(choice("kind", j(&J::kind),
                        "leaves free: nothing, turning, turning about +Y, sliding along +Y, all but stretching"));
  keys.push_back(text("a", KeyType::kText, j(&J::a), "name of the soft or rigid body that it holds"));
  keys.push_back(text("b", KeyType::kText, j(&J::b), "name of the body that holds it; left out: the world"));
  const char* const part = "rigid part of that body, by its name; `handle`: a tool's handle; left out: its tissue";
  keys.push_back(text("part_a", KeyType::kText, j(&J::part_a), part));
  keys.push_back(text("part_b", KeyType::kText, j(&J::part_b), part));
  Key limits = pair("limits", "rad, m", j(&J::limits),
                    "least and largest angle or travel of a against b, from the beginning; equal: none");
  limits.range = R::kLimits;
  keys.push_back(limits);
  keys.push_back(number("stiffness", "N m/rad, N/m", {R::kStiffness, {0.0, 1e5}}, j(&J::stiffness),
                        "of a spring to `rest`; of a rope, 0: it does not stretch"));
  keys.push_back(number("damping", "N m s/rad, N s/m", {R::kDamping, {0.0, 1e3}}, j(&J::damping), "of that spring"));
  keys.push_back(
      number("rest", "rad, m", R::kLimits, j(&J::rest), "where that spring is at rest; an animation may vary it"));
  keys.push_back(number("closed", "rad, m", R::kLimits, j(&J::closed), "the same while the grip is closed"));
  keys.push_back(text("grip", KeyType::kText, j(&J::grip),
                      "name of a tool or probe: its device's grip moves the spring's rest to `closed`"));
  keys.push_back(number("max_force", "N m, N", {R::kMaxForce, {0.0, 100.0}}, j(&J::max_force),
                        "largest torque or force of that spring; 0: no bound"));
  keys.push_back(vector("end", "m", {R::kPlace, {-1.0, 1.0}}, j(&J::end),
                        "where a rope is tied to b, in the node's frame; to a: at the node"));
  keys.push_back(number("length", "m", {R::kLength, {1e-3, 1.0}}, j(&J::length),
                        "of a rope; 0: the initial distance of its ends"));
  keys.push_back(number("strength", "N", {R::kStrength, {0.01, 1e4}}, j(&J::strength),
                        "a larger force breaks the joint; 0: never"));
  return keys;
}

std::optional<Note> settle_joint(void* owner) {
  const Joint& it = *static_cast<LevelNode*>(owner)->joint;
  if (!it.a.empty() && it.a == it.b && it.part_a == it.part_b)
    return Note{"names the same body twice", "name two, or leave out `b`", "key.value", "b"};
  if (it.limits[0] > it.limits[1])
    return Note{"has a least limit above its largest", "exchange them", "key.value", "limits"};
  if (it.limits[0] < it.limits[1] && (it.limits[0] > 0.0 || it.limits[1] < 0.0))
    return Note{"begins outside of its limits", "let them enclose 0, where it begins", "key.value", "limits"};
  if (it.kind == JointKind::kRope && it.stiffness == 0.0 && it.length > 0.0 &&
      it.length < (1.0 - 1e-6) * length(it.end))
    return Note{"is a rope that is shorter than the distance at which its ends begin",
                "lengthen it, or give it `stiffness`", "key.value", "length"};
  if (!it.grip.empty() && it.stiffness == 0.0)
    return Note{"is driven by a grip without `stiffness`, so nothing moves it", "give one", "key.missing", "stiffness"};
  return std::nullopt;
}

std::vector<Key> environment_keys() {
  using E = LevelEnvironment;
  const auto e = [](auto member) { return at(&Level::environment, member); };
  std::vector<Key> keys;
  keys.push_back(
      text("panorama", KeyType::kText, e(&E::panorama), "latitude-longitude OpenEXR file, relative to the level"));
  keys.push_back(number("intensity", "1", {{0.0, 1e6}, {1e-3, 1e3}}, e(&E::intensity), "factor on the panorama"));
  keys.push_back(number("rotation", "rad", {{-1e3, 1e3}, {-6.3, 6.3}}, e(&E::rotation), "about +Y"));
  return keys;
}

Key expose_key() {
  std::vector<Key> keys;
  keys.push_back(text("key", KeyType::kText, of_item(&ExposedKey::key),
                      "NODE.EXTENSION.KEY: a number that a session can set (belly.deformable.stiffness)"));
  keys.push_back(text("name", KeyType::kText, of_item(&ExposedKey::name), "label; left out: from `key`"));
  Key range = pair("range", "", of_item(&ExposedKey::range), "least and largest value; equal: the key's usual range");
  range.range = {-1e15, 1e15};
  keys.push_back(range);
  keys.push_back(number("step", "", Range{0.0, 1e15}, of_item(&ExposedKey::step), "between values; 0: continuous"));
  Key out = items_key<ExposedKey, Level>(
      "expose", fmt::format("sliders of the run's window, at most {}", kMostSliders), std::move(keys), "key",
      [](const Level& level) -> const std::vector<ExposedKey>& { return level.simulation.expose; },
      [](Level& level, std::vector<ExposedKey> list) { level.simulation.expose = std::move(list); });
  out.most = kMostSliders;
  return out;
}

std::vector<Key> simulation_keys() {
  using S = Simulation;
  const auto s = [](auto member) { return at(&Level::simulation, member); };
  std::vector<Key> keys;
  keys.push_back(
      number("touch_rate", "Hz", {kTouchRateRange, {100.0, 1e4}}, s(&S::touch_rate), "rate of the touch clock"));
  keys.push_back(number("soft_step", "s", {kSoftStepRange, {5e-4, 0.05}}, s(&S::soft_step), "step of the soft clock"));
  keys.push_back(vector("gravity", "m/s2", {kGravityRange, {-30.0, 30.0}}, s(&S::gravity),
                        "acceleration of gravity; one number points down (-Y)"));
  keys.push_back(expose_key());
  return keys;
}

template <class Owner, class T>
Extension extension(std::string name, std::string doc, std::optional<T> Owner::*slot, std::vector<Key> keys) {
  Extension out;
  out.name = std::move(name);
  out.doc = std::move(doc);
  out.on_scene = std::is_same_v<Owner, Level>;
  out.keys = std::move(keys);
  out.present = [slot](const void* owner) { return (static_cast<const Owner*>(owner)->*slot).has_value(); };
  out.add = [slot](void* owner) { (static_cast<Owner*>(owner)->*slot).emplace(); };
  out.settle = [](void*) { return std::optional<Note>(); };
  return out;
}

std::optional<Note> settle_device(void* owner) {
  const HapticDevice& it = *static_cast<LevelNode*>(owner)->device;
  if (it.driver != DriverKind::kScript || !it.file.empty()) return std::nullopt;
  return Note{"has the driver script without a `file`", "name the CSV file", "key.missing", "file"};
}

template <class T>
std::optional<Note> settle_friction(const T& it) {
  if (!(it.friction_sliding > it.friction_static)) return std::nullopt;
  return Note{"friction_sliding is above friction_static", "lower it", "key.value", "friction_sliding"};
}

// Something of the stress of every part stays.
std::optional<Note> settle_prony(const SoftBody& it) {
  double most = 1.0;
  for (const TissuePart& part : it.materials) most = std::max(most, part.relaxation);
  const double lost = 1.0 - it.prony.remains();
  if (most * lost < 1.0) return std::nullopt;
  return Note{fmt::format("loses all of its stress: its shares are {:g} together{}", lost,
                          most > 1.0 ? fmt::format(", and a part has {:g} times these", most) : std::string()),
              "lower them, so that they are below 1 together", "key.value", "prony"};
}

std::optional<Note> settle_soft_body(void* owner) {
  const SoftBody& it = *static_cast<LevelNode*>(owner)->soft_body;
  if (std::optional<Note> fault = settle_friction(it)) return fault;
  if (it.fibres.young > 0.0 && !(length(it.fibres.direction) > 0.0))
    return Note{"has no direction", "give a vector other than zero", "key.value", "fibres.direction"};
  return settle_prony(it);
}

std::optional<Note> settle_motion(void* owner) {
  const NodeMotion& it = *static_cast<LevelNode*>(owner)->motion;
  if (it.script.empty() || it.animation.empty()) return std::nullopt;
  return Note{"gives both script and animation", "keep one", "key.both", {}};
}

std::vector<Extension> make_table() {
  std::vector<Extension> table;
  table.push_back(extension("deformable", "The node's mesh is a deformable surface (P1).", &LevelNode::deformable,
                            deformable_keys()));
  table.back().settle = settle_deformable;
  table.push_back(extension("probe", "Touches surfaces and bodies.", &LevelNode::probe, probe_keys()));
  table.push_back(extension("haptic_device", "Moves a probe, and may push back.", &LevelNode::device, device_keys()));
  table.back().settle = settle_device;
  table.push_back(
      extension("soft_body", "The node's mesh is tissue with inertia.", &LevelNode::soft_body, soft_body_keys()));
  table.back().settle = settle_soft_body;
  table.push_back(extension("handle", "The rigid part of a tool: of a soft body a part, of a rigid one the whole.",
                            &LevelNode::handle, handle_keys()));
  table.push_back(extension("rigid_body", "The node's mesh is rigid.", &LevelNode::rigid_body, rigid_body_keys()));
  table.back().settle = [](void* owner) { return settle_friction(*static_cast<LevelNode*>(owner)->rigid_body); };
  table.push_back(extension("motion", "How an animation or a script carries the node, and all below it.",
                            &LevelNode::motion, motion_keys()));
  table.back().settle = settle_motion;
  table.push_back(
      extension("effect", "Acts on probes in space, without a surface.", &LevelNode::effect, effect_keys()));
  table.push_back(extension("joint", "Connects two bodies, or a body and the world.", &LevelNode::joint, joint_keys()));
  table.back().settle = settle_joint;
  table.push_back(extension("environment", "Surroundings of the scene.", &Level::environment, environment_keys()));
  Extension simulation;
  simulation.name = "simulation";
  simulation.doc = "Clocks, gravity, sliders.";
  simulation.on_scene = true;
  simulation.keys = simulation_keys();
  simulation.present = [](const void*) { return true; };
  simulation.add = [](void*) {};
  simulation.settle = [](void*) { return std::optional<Note>(); };
  table.push_back(simulation);
  return table;
}

}  // namespace

double calibrated_stiffness(double young, double poisson, double thickness) {
  const double layer = thickness > 0.0 ? bonded_layer_factor(kYoungRadius / thickness, poisson) : 1.0;
  return 2.0 * young / (1.0 - poisson * poisson) * kYoungRadius * layer;
}

bool stiffness_of_table(const LevelNode& node) {
  return node.deformable && reads_key(node.deformable->spring, "table");
}

std::string listed(const std::vector<std::string>& words) {
  std::string out;
  for (std::size_t i = 0; i < words.size(); ++i)
    out += (i == 0 ? "" : i + 1 < words.size() ? ", " : " and ") + words[i];
  return out;
}

void scale_defaults(LevelNode& fresh, const LevelNode& node) {
  if (!fresh.deformable) return;
  fresh.deformable->relaxation_stiffness *= node.scaled_with_young;
  fresh.deformable->cubic *= node.scaled_with_young;
}

const std::vector<Extension>& extension_table() {
  static const std::vector<Extension> table = make_table();
  return table;
}

const Extension* find_extension(const std::string& name) {
  for (const Extension& each : extension_table())
    if (each.name == name) return &each;
  return nullptr;
}

void note_stated(const Extension& extension, const Key& key, void* owner) {
  std::set<std::string>& stated =
      extension.on_scene ? static_cast<Level*>(owner)->stated : static_cast<LevelNode*>(owner)->stated;
  stated.insert(extension.name + "." + key.name);
}

const Key* find_key(const Extension& extension, const std::string& name) {
  for (const Key& each : extension.keys)
    if (each.name == name) return &each;
  return nullptr;
}

const Key* find_key_of_path(const std::string& path) {
  for (std::size_t dot = path.find('.'); dot != std::string::npos; dot = path.find('.', dot + 1)) {
    const std::size_t end = path.find('.', dot + 1);
    if (end == std::string::npos) break;
    const Extension* extension = find_extension(path.substr(dot + 1, end - dot - 1));
    if (const Key* key = extension ? find_key(*extension, path.substr(end + 1)) : nullptr) return key;
  }
  return nullptr;
}

}  // namespace pliant
