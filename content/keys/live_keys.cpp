#include "content/keys/live_keys.h"

namespace pliant {
namespace {

constexpr const char* kOpenAgain = "; change it in the scene and open that again";

struct Fixed {
  const char* key;  // EXTENSION.KEY
  const char* why;
};
constexpr Fixed kFixed[] = {
    {"deformable.response", "the field of the surface is kept in another way"},
    {"deformable.distance", "what finds it is laid out when the session opens"},
    {"deformable.crease_angle", "the mesh is built with it"},
    {"deformable.table", "its rows are laid out when the session opens"},
    {"deformable.error", "the model is chosen by it when the session opens"},
    {"deformable.carries", "what goes with it is laid out when the session opens"},
    {"deformable.layers", "holes in them are kept from then on"},
    {"deformable.hole_radius", "holes are kept from then on"},
    {"deformable.yield.force", "the dents that stay are laid out when the session opens"},
    {"deformable.yield.hardening", "the dents that stay are laid out when the session opens"},
    {"deformable.relief", "the drawn maps are made heights when the session opens"},
    {"soft_body.carries", "what goes with it is laid out when the session opens"},
    {"soft_body.under_gravity", "how the body begins is worked out when the session opens"},
    {"soft_body.density", "the tissue's masses are laid out when the session opens"},
    {"soft_body.cell", "the tetrahedra are made with it"},
    {"soft_body.elements", "the lattice is made of them"},
    {"soft_body.materials", "the tissue's elements are weighed when the session opens"},
    {"soft_body.prony", "the memory of its arms is laid out when the session opens"},
    {"soft_body.cavities", "their walls are found when the session opens"},
    {"soft_body.rigid", "the tissue's unknowns are laid out when the session opens"},
    {"soft_body.focus", "the tetrahedra are made with it"},
    {"soft_body.fill", "the tetrahedra are made with it"},
    {"soft_body.thickness", "the tetrahedra are made with it"},
    {"soft_body.mesh", "the tetrahedra are read when the session opens"},
    {"soft_body.pinned", "the tissue's unknowns are laid out when the session opens"},
    {"soft_body.solver", "it is made when the session opens"},
    {"soft_body.contact", "what contacts act on is laid out when the session opens"},
    {"soft_body.integrator", "its step is laid out when the session opens"},
    {"soft_body.velocity", "the body moves with it from the beginning"},
    {"soft_body.error", "the model is chosen by it when the session opens"},
    {"rigid_body.velocity", "the body moves with it from the beginning"},
    {"rigid_body.fixed", "what moves is laid out when the session opens"},
    {"probe.length", "its tips are laid out when the session opens"},
    {"probe.points", "its tips are laid out when the session opens"},
    {"probe.meets", "what it meets is laid out when the session opens"},
    {"probe.color", "a session draws nothing"},
    {"handle.box", "the tissue's unknowns are laid out when the session opens"},
    {"handle.attachment", "the tissue's unknowns are laid out when the session opens"},
    {"handle.carried", "the tool's weight is laid out when the session opens"},
    {"handle.force", "its reduced model is laid out when the session opens"},
    {"effect.kind", "its memory is of that kind"},
    {"effect.probes", "what feels it is laid out when the session opens"},
    {"effect.region", "a probe may be in it"},
    {"effect.box", "a probe may be in it"},
    {"effect.target", "a probe may be at it"},
    {"effect.path", "the path is read when the session opens"},
    {"effect.detents", "a probe may be at them"},
    {"haptic_device.scale", "it goes with the driver, whose workspace is set when it is connected"},
};

}  // namespace

std::string why_not_live(const Extension& extension, const Key& key) {
  const std::string name = extension.name + "." + key.name;
  for (const Fixed& each : kFixed)
    if (name == each.key) return std::string("is read when the session opens: ") + each.why + kOpenAgain;
  if (key.name == "device" || key.name == "driver" || key.name == "file" || key.name == "id")
    return "is read when the session opens: it says what moves it; call Session::release() and then connect(), "
           "follow() or move()";
  return "";
}

const std::vector<LiveKey>& live_keys() {
  using D = DeformableParameters;
  using H = DeviceParameters;
  static const std::vector<LiveKey> keys{
      {"young", &D::young, nullptr},  // before the key that it sets
      {"poisson", &D::poisson, nullptr},
      {"thickness", &D::thickness, nullptr},
      {"stiffness", &D::stiffness, nullptr},
      {"cubic", &D::cubic, nullptr},
      {"stiffening", &D::stiffening, nullptr},
      {"relaxation.stiffness", &D::relaxation_stiffness, nullptr},
      {"relaxation.time", &D::relaxation_time, nullptr},
      {"damping_ratio", &D::damping_ratio, nullptr},
      {"settling_time", &D::settling_time, nullptr},
      {"contact_damping", &D::contact_damping, nullptr},
      {"reach", &D::reach, nullptr},
      {"volume", &D::volume, nullptr},
      {"contact_radius", &D::contact_radius, nullptr},
      {"friction_static", &D::friction_static, nullptr},
      {"friction_sliding", &D::friction_sliding, nullptr},
      {"friction_stribeck", &D::friction_stribeck, nullptr},
      {"friction_viscous", &D::friction_viscous, nullptr},
      {"texture.amplitude", &D::texture_amplitude, nullptr},
      {"texture.wavelength", &D::texture_wavelength, nullptr},
      {"texture.seed", &D::texture_seed, nullptr},
      {"transient.amplitude", &D::transient_amplitude, nullptr},
      {"transient.frequency", &D::transient_frequency, nullptr},
      {"transient.decay", &D::transient_decay, nullptr},
      {"max_force", nullptr, &H::max_force},
      {"max_stiffness", nullptr, &H::max_stiffness},
      {"max_slew", nullptr, &H::max_slew},
  };
  return keys;
}

}  // namespace pliant
