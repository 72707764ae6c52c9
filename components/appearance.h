// Appearance: materials, textures, lights, cameras, the environment. Rate: visual. Writer: content at spawn.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "components/math.h"
#include "components/mesh.h"
#include "runtime/store.h"

namespace pliant {

// Pixels as loaded: 8-bit RGBA, rows top to bottom.
struct Image {
  std::string name;
  std::uint32_t width = 0, height = 0;
  std::vector<std::uint8_t> rgba;
};

// A latitude-longitude panorama, linear RGB, rows top (+Y) to bottom.
struct Panorama {
  std::string name;
  std::uint32_t width = 0, height = 0;
  std::vector<float> rgb;  // [cd/m2, relative] finite, >= 0
};

// glTF 2.0 metallic-roughness. Texture members are indices into World::images, -1: none.
struct Material {
  std::string name;
  vec4 base_color{0.8f, 0.8f, 0.8f, 1.0f};
  float metallic = 0.0f;
  float roughness = 0.6f;
  vec3 emissive{0};
  float normal_scale = 1.0f;
  float occlusion_strength = 1.0f;
  std::int32_t base_color_texture = -1;
  std::int32_t metallic_roughness_texture = -1;
  std::int32_t normal_texture = -1;
  std::int32_t occlusion_texture = -1;
  std::int32_t emissive_texture = -1;
  std::int32_t transmission_texture = -1;  // KHR_materials_transmission: its red channel scales `transmission`
  std::int32_t thickness_texture = -1;     // KHR_materials_volume: its green channel scales `thickness`
  std::int32_t height_texture = -1;        // extras.height_texture: relief finer than the mesh, in its red channel
  float height_scale = 0.0f;               // [m] extras.height_scale: white above black
  float ior = 1.5f;                        // KHR_materials_ior
  float transmission = 0.0f;               // KHR_materials_transmission
  float thickness = 0.0f;                  // [m] KHR_materials_volume
  vec3 attenuation_color{1};
  float attenuation_distance = 0.0f;       // [m] 0: none
  float specular = 1.0f;                   // KHR_materials_specular, without textures
  vec3 specular_color{1};
  float clearcoat = 0.0f;                  // [1] KHR_materials_clearcoat, without textures: a wet film, say
  float clearcoat_roughness = 0.0f;
  float diffuse_transmission = 0.0f;       // [1] KHR_materials_diffuse_transmission, without textures; with
  vec3 diffuse_transmission_color{1};      // `thickness`, light scatters below the surface
  enum class Alpha : std::uint8_t { kOpaque, kMask, kBlend } alpha = Alpha::kOpaque;
  float alpha_cutoff = 0.5f;
  bool double_sided = false;
};

// A mesh that is drawn: vertices in the object frame of the entity's Pose (deformables) or WorldTransform.
struct Drawable {
  Handle<DrawMesh> mesh;
};

// KHR_lights_punctual, at the entity's WorldTransform, shining along its -Z.
struct Light {
  enum class Kind : std::uint8_t { kDirectional, kPoint, kSpot } kind = Kind::kDirectional;
  vec3 color{1};
  float intensity = 1.0f;                            // [lx] directional, [cd] point and spot
  float range = 0.0f;                                // [m] 0: unlimited
  float inner_cone = 0.0f, outer_cone = 0.7853982f;  // [rad]
};

// A glTF perspective camera, at the entity's WorldTransform, looking along its -Z.
struct Camera {
  float yfov = 0.7f;                    // [rad]
  float znear = 0.001f, zfar = 100.0f;  // [m]
};

// The surroundings of the scene. One per level, in World::environment.
struct Environment {
  Panorama panorama;       // width 0: none, a plain gradient is drawn
  float intensity = 1.0f;  // [1]
  float rotation = 0.0f;   // [rad] about +Y
};

}  // namespace pliant
