// Checks pictures, cameras, lights and material variants against glTF 2.0. Called by check_meaning.
#include <fmt/format.h>

#include <set>

#include "content/gltf/check/gltf_meaning.h"

namespace pliant {

void check_images(const Json& json, Meaning& check) {
  const Json& images = array_of(json, "images");
  for (std::size_t i = 0; i < images.size(); ++i) {
    const std::string pointer = fmt::format("/images/{}", i);
    if (images[i].contains("uri") == images[i].contains("bufferView"))
      check.error(pointer, "needs either uri or bufferView, and one of them only");
    if (!images[i].contains("bufferView")) continue;
    if (!images[i].contains("mimeType")) check.error(pointer + "/bufferView", "needs a mimeType beside it");
    check.use_view(images[i]["bufferView"].get<std::size_t>(), BufferUse::kImage, pointer + "/bufferView");
  }
  const Json& textures = array_of(json, "textures");
  for (std::size_t i = 0; i < textures.size(); ++i) {
    for (const auto& [name, type] :
         {std::pair("EXT_texture_webp", "image/webp"), {"KHR_texture_basisu", "image/ktx2"}}) {
      const Json* extension = extension_of(textures[i], name);
      if (!extension || !extension->contains("source")) continue;
      if (value_of<std::string>(images[(*extension)["source"].get<std::size_t>()], "mimeType", type) != type)
        check.error(fmt::format("/textures/{}/extensions/{}/source", i, name),
                    std::string("is of another type than ") + type, "convert the picture");
    }
    if (!textures[i].contains("source")) continue;
    const std::string mime =
        value_of<std::string>(images[textures[i]["source"].get<std::size_t>()], "mimeType", "image/png");
    if (mime != "image/png" && mime != "image/jpeg")
      check.error(fmt::format("/textures/{}/source", i), "is neither PNG nor JPEG", "convert the picture");
  }
}

void check_cameras(const Json& json, Meaning& check) {
  const Json& cameras = array_of(json, "cameras");
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    const Json& camera = cameras[i];
    const std::string pointer = fmt::format("/cameras/{}", i);
    const std::string type = camera["type"].get<std::string>();
    if (camera.contains("perspective") && camera.contains("orthographic"))
      check.error(pointer, "is both perspective and orthographic");
    if ((type == "perspective" || type == "orthographic") && !camera.contains(type))
      check.error(pointer, "lacks '" + type + "', the type it says it has");
    for (const char* kind : {"perspective", "orthographic"}) {
      if (!camera.contains(kind)) continue;
      const Json& lens = camera[kind];
      const std::string where = pointer + "/" + kind;
      if (lens.contains("zfar") && lens["zfar"].get<double>() <= lens["znear"].get<double>())
        check.error(where, "has its zfar before its znear");
      for (const char* magnification : {"xmag", "ymag"})
        if (lens.contains(magnification) && lens[magnification].get<double>() == 0.0)
          check.error(where + "/" + magnification, "is zero");
    }
  }
}

// KHR_materials_ior: an index of refraction is at least 1, or 0.
void check_materials(const Json& json, Meaning& check) {
  const Json& materials = array_of(json, "materials");
  for (std::size_t i = 0; i < materials.size(); ++i)
    if (const Json* extension = extension_of(materials[i], "KHR_materials_ior"))
      if (const double ior = value_of(*extension, "ior", 1.5); ior > 0.0 && ior < 1.0)
        check.error(fmt::format("/materials/{}/extensions/KHR_materials_ior/ior", i), "is between 0 and 1",
                    "give 1 or more, or 0 for none");
}

void check_lights_and_variants(const Json& json, Meaning& check) {
  check_materials(json, check);
  if (const Json* extension = extension_of(json, "KHR_lights_punctual")) {
    const Json& lights = (*extension)["lights"];
    for (std::size_t i = 0; i < lights.size(); ++i) {
      const std::string pointer = fmt::format("/extensions/KHR_lights_punctual/lights/{}", i);
      if (lights[i]["type"] == "spot" && !lights[i].contains("spot")) check.error(pointer, "is a spot without 'spot'");
      if (!lights[i].contains("spot")) continue;
      if (value_of(lights[i]["spot"], "innerConeAngle", 0.0) >=
          value_of(lights[i]["spot"], "outerConeAngle", 0.7853981633974483))
        check.error(pointer + "/spot", "has an inner cone that is not inside its outer cone");
    }
  }
  const Json& meshes = array_of(json, "meshes");
  for (std::size_t m = 0; m < meshes.size(); ++m)
    for (std::size_t p = 0; p < meshes[m]["primitives"].size(); ++p)
      if (const Json* extension = extension_of(meshes[m]["primitives"][p], "KHR_materials_variants")) {
        std::set<std::size_t> seen;
        for (const Json& mapping : (*extension)["mappings"])
          for (const Json& variant : mapping["variants"])
            if (!seen.insert(variant.get<std::size_t>()).second)
              check.error(fmt::format("/meshes/{}/primitives/{}/extensions/KHR_materials_variants", m, p),
                          "uses a variant twice");
      }
}

}  // namespace pliant
