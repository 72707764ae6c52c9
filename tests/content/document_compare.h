// Two Levels, member by member and bit by bit.
#pragma once

#include <cstring>
#include <string>

#include "content/level/level.h"

namespace pliant::test {

class Difference {
 public:
  // The first difference of `a` and `b`, or ""; ignores names and paths of the files.
  static std::string of(const Level& a, const Level& b) {
    Difference d;
    d.same("node count", a.nodes.size(), b.nodes.size());
    d.same("mesh count", a.meshes.size(), b.meshes.size());
    d.same("material count", a.materials.size(), b.materials.size());
    d.same("image count", a.images.size(), b.images.size());
    if (!d.first_.empty()) return d.first_;
    for (std::size_t i = 0; i < a.nodes.size(); ++i) d.node("node " + std::to_string(i), a.nodes[i], b.nodes[i]);
    for (std::size_t i = 0; i < a.meshes.size(); ++i) d.mesh("mesh " + std::to_string(i), a.meshes[i], b.meshes[i]);
    for (std::size_t i = 0; i < a.materials.size(); ++i)
      d.material("material " + std::to_string(i), a.materials[i], b.materials[i]);
    for (std::size_t i = 0; i < a.images.size(); ++i) {
      const std::string at = "image " + std::to_string(i);
      d.same(at + " name", a.images[i].name, b.images[i].name);
      d.same(at + " width", a.images[i].width, b.images[i].width);
      d.same(at + " height", a.images[i].height, b.images[i].height);
      d.array(at + " pixels", a.images[i].rgba, b.images[i].rgba);
    }
    d.same("animation count", a.animations.size(), b.animations.size());
    for (std::size_t i = 0; d.first_.empty() && i < a.animations.size(); ++i)
      d.animation("animation " + std::to_string(i), a.animations[i], b.animations[i]);
    d.same("environment", a.environment.has_value(), b.environment.has_value());
    if (a.environment && b.environment) {
      d.same("panorama", a.environment->panorama, b.environment->panorama);
      d.same("intensity", a.environment->intensity, b.environment->intensity);
      d.same("rotation", a.environment->rotation, b.environment->rotation);
    }
    d.same("touch rate", a.simulation.touch_rate, b.simulation.touch_rate);
    d.same("soft step", a.simulation.soft_step, b.simulation.soft_step);
    d.same("gravity", a.simulation.gravity, b.simulation.gravity);
    return d.first_;
  }

 private:
  template <class T>
  void same(const std::string& what, const T& a, const T& b) {
    if (first_.empty() && !(a == b)) first_ = what;
  }
  template <class T>
  void array(const std::string& what, const std::vector<T>& a, const std::vector<T>& b) {
    if (first_.empty() &&
        (a.size() != b.size() || (!a.empty() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) != 0)))
      first_ = what;
  }
  void animation(const std::string& at, const LevelAnimation& a, const LevelAnimation& b) {
    same(at + " name", a.name, b.name);
    same(at + " length", a.length, b.length);
    same(at + " channels", a.channels.size(), b.channels.size());
    for (std::size_t i = 0; first_.empty() && i < a.channels.size(); ++i) {
      const LevelChannel &x = a.channels[i], &y = b.channels[i];
      same(at + " node", x.node, y.node);
      same(at + " property", x.property, y.property);
      same(at + " interpolation", x.track.interpolation, y.track.interpolation);
      array(at + " times", x.track.times, y.track.times);
      array(at + " values", x.track.values, y.track.values);
    }
  }
  void node(const std::string& at, const LevelNode& a, const LevelNode& b) {
    same(at + " name", a.name, b.name);
    same(at + " parent", a.parent, b.parent);
    same(at + " children", a.children, b.children);
    same(at + " translation", a.local.translation, b.local.translation);
    same(at + " rotation", a.local.rotation, b.local.rotation);
    same(at + " scale", a.local.scale, b.local.scale);
    same(at + " in scene", a.in_scene, b.in_scene);
    same(at + " mesh", a.mesh, b.mesh);
    same(at + " light", a.light.has_value(), b.light.has_value());
    if (a.light && b.light) {
      same(at + " light kind", a.light->kind, b.light->kind);
      same(at + " light color", a.light->color, b.light->color);
      same(at + " light intensity", a.light->intensity, b.light->intensity);
      same(at + " light range", a.light->range, b.light->range);
      same(at + " light inner cone", a.light->inner_cone, b.light->inner_cone);
      same(at + " light outer cone", a.light->outer_cone, b.light->outer_cone);
    }
    same(at + " camera", a.camera.has_value(), b.camera.has_value());
    if (a.camera && b.camera) {
      same(at + " yfov", a.camera->yfov, b.camera->yfov);
      same(at + " znear", a.camera->znear, b.camera->znear);
      same(at + " zfar", a.camera->zfar, b.camera->zfar);
    }
    same(at + " deformable", a.deformable.has_value(), b.deformable.has_value());
    if (a.deformable && b.deformable) {
      const Deformable &p = *a.deformable, &q = *b.deformable;
      same(at + " spring", p.spring, q.spring);
      same(at + " table", p.table, q.table);
      same(at + " sphere", p.sphere, q.sphere);
      for (double Deformable::*member : {&Deformable::stiffness,
                                         &Deformable::cubic,
                                         &Deformable::stiffening,
                                         &Deformable::relaxation_stiffness,
                                         &Deformable::relaxation_time,
                                         &Deformable::damping_ratio,
                                         &Deformable::settling_time,
                                         &Deformable::contact_damping,
                                         &Deformable::reach,
                                         &Deformable::volume,
                                         &Deformable::friction_static,
                                         &Deformable::friction_sliding,
                                         &Deformable::friction_stribeck,
                                         &Deformable::friction_viscous,
                                         &Deformable::texture_amplitude,
                                         &Deformable::texture_wavelength,
                                         &Deformable::texture_seed,
                                         &Deformable::transient_amplitude,
                                         &Deformable::transient_frequency,
                                         &Deformable::transient_decay,
                                         &Deformable::relief,
                                         &Deformable::young,
                                         &Deformable::poisson,
                                         &Deformable::thickness})
        same(at + " a number of deformable", p.*member, q.*member);
      same(at + " contact damping of the material", p.contact_damping_material, q.contact_damping_material);
      same(at + " response", p.response, q.response);
      same(at + " shape", p.shape, q.shape);
      same(at + " distance", p.distance, q.distance);
    }
    same(at + " probe", a.probe.has_value(), b.probe.has_value());
    same(at + " probe device", a.probe_device, b.probe_device);
    if (a.probe && b.probe) {
      same(at + " radius", a.probe->radius, b.probe->radius);
      same(at + " color", a.probe->color, b.probe->color);
    }
    same(at + " device", a.device.has_value(), b.device.has_value());
    if (a.device && b.device) {
      same(at + " driver", a.device->driver, b.device->driver);
      same(at + " file", a.device->file, b.device->file);
      same(at + " id", a.device->id, b.device->id);
      same(at + " scale", a.device->scale, b.device->scale);
      same(at + " max force", a.device->max_force, b.device->max_force);
      same(at + " max stiffness", a.device->max_stiffness, b.device->max_stiffness);
      same(at + " max slew", a.device->max_slew, b.device->max_slew);
    }
    same(at + " soft body", a.soft_body.has_value(), b.soft_body.has_value());
    if (a.soft_body && b.soft_body) {
      const SoftBody &p = *a.soft_body, &q = *b.soft_body;
      same(at + " young", p.young, q.young);
      same(at + " poisson", p.poisson, q.poisson);
      same(at + " density", p.density, q.density);
      same(at + " rayleigh", p.rayleigh, q.rayleigh);
      same(at + " cell", p.cell, q.cell);
      same(at + " tetrahedra", p.mesh, q.mesh);
      same(at + " pinned min", p.pinned.min, q.pinned.min);
      same(at + " pinned max", p.pinned.max, q.pinned.max);
    }
    same(at + " handle", a.handle.has_value(), b.handle.has_value());
    if (a.handle && b.handle) {
      same(at + " handle box", a.handle->box.min, b.handle->box.min);
      same(at + " attachment", a.handle->attachment, b.handle->attachment);
      same(at + " translation coupling", a.handle->translation, b.handle->translation);
      same(at + " rotation coupling", a.handle->rotation, b.handle->rotation);
      same(at + " max torque", a.handle->max_torque, b.handle->max_torque);
      same(at + " force", a.handle->force == b.handle->force, true);
      same(at + " handle device", a.handle->device, b.handle->device);
    }
    same(at + " motion", a.motion.has_value(), b.motion.has_value());
    if (a.motion && b.motion) {
      same(at + " motion script", a.motion->script, b.motion->script);
      same(at + " motion animation", a.motion->animation, b.motion->animation);
      same(at + " motion repeat", a.motion->repeat, b.motion->repeat);
      same(at + " motion speed", a.motion->speed, b.motion->speed);
    }
    same(at + " rigid body", a.rigid_body.has_value(), b.rigid_body.has_value());
    if (a.rigid_body && b.rigid_body) {
      same(at + " mass", a.rigid_body->mass, b.rigid_body->mass);
      same(at + " fixed", a.rigid_body->fixed, b.rigid_body->fixed);
    }
  }
  void mesh(const std::string& at, const LevelMesh& a, const LevelMesh& b) {
    same(at + " name", a.name, b.name);
    same(at + " primitives", a.primitives.size(), b.primitives.size());
    for (std::size_t i = 0; first_.empty() && i < a.primitives.size(); ++i) {
      const Primitive &p = a.primitives[i], &q = b.primitives[i];
      array(at + " positions", p.position, q.position);
      array(at + " normals", p.normal, q.normal);
      array(at + " tangents", p.tangent, q.tangent);
      array(at + " uv", p.uv, q.uv);
      array(at + " stiffness", p.stiffness, q.stiffness);
      array(at + " friction", p.friction, q.friction);
      array(at + " damping", p.damping, q.damping);
      array(at + " relaxation", p.relaxation, q.relaxation);
      array(at + " pinned", p.pinned, q.pinned);
      array(at + " handle", p.handle, q.handle);
      array(at + " indices", p.index, q.index);
      same(at + " material", p.material, q.material);
    }
  }
  void material(const std::string& at, const Material& a, const Material& b) {
    same(at + " name", a.name, b.name);
    same(at + " base color", a.base_color, b.base_color);
    for (float Material::*member : {&Material::metallic, &Material::roughness, &Material::normal_scale,
                                    &Material::occlusion_strength, &Material::ior, &Material::transmission,
                                    &Material::thickness, &Material::attenuation_distance, &Material::alpha_cutoff})
      same(at + " a factor", a.*member, b.*member);
    for (std::int32_t Material::*member :
         {&Material::base_color_texture, &Material::metallic_roughness_texture, &Material::normal_texture,
          &Material::occlusion_texture, &Material::emissive_texture, &Material::transmission_texture,
          &Material::thickness_texture})
      same(at + " a texture", a.*member, b.*member);
    same(at + " emissive", a.emissive, b.emissive);
    same(at + " attenuation color", a.attenuation_color, b.attenuation_color);
    same(at + " alpha", a.alpha, b.alpha);
    same(at + " double sided", a.double_sided, b.double_sided);
  }

  std::string first_;
};

}  // namespace pliant::test
