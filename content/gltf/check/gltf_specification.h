// Types, ranges and references of glTF 2.0 and the supported extensions, as a table for a small interpreter. A line is
//
//   object  key[!]  kind [arguments]          ! = required
//   string [a|b]       one of a list, if given (another value: a warning, as in the Khronos validator)
//   int RANGE, number RANGE, numbers COUNT RANGE          RANGE: 0..  >0..  0..1  ..; COUNT: 3 or 1+
//   ints a|b           an integer of a list (another value: a warning)
//   index COLLECTION, indices COLLECTION      into a root array; indices are unique and at least one
//   object TYPE, objects TYPE                 a nested object, an array of at least one
//   map COLLECTION, maps COLLECTION           names -> indices, an array of such
//   ext TYPE           this extension is allowed on this object only
#pragma once

namespace pliant {

inline constexpr const char* kSpecification = R"(
root asset! object asset
root accessors objects accessor
root animations objects animation
root buffers objects buffer
root bufferViews objects bufferView
root cameras objects camera
root images objects image
root materials objects material
root meshes objects mesh
root nodes objects node
root samplers objects sampler
root scenes objects scene
root skins objects skin
root textures objects texture
root scene index scenes
root extensionsUsed strings
root extensionsRequired strings
root KHR_lights_punctual ext lights
root KHR_materials_variants ext variants
root KHR_xmp_json_ld ext any
asset version! string
asset minVersion string
asset copyright string
asset generator string
accessor bufferView index bufferViews
accessor byteOffset int 0..
accessor componentType! ints 5120|5121|5122|5123|5125|5126
accessor normalized bool
accessor count! int 1..
accessor type! string SCALAR|VEC2|VEC3|VEC4|MAT2|MAT3|MAT4
accessor min numbers 1+ ..
accessor max numbers 1+ ..
accessor sparse object sparse
sparse count! int 1..
sparse indices! object sparseIndices
sparse values! object sparseValues
sparseIndices bufferView! index bufferViews
sparseIndices byteOffset int 0..
sparseIndices componentType! ints 5121|5123|5125
sparseValues bufferView! index bufferViews
sparseValues byteOffset int 0..
buffer uri string
buffer byteLength! int 1..
bufferView buffer! index buffers
bufferView byteOffset int 0..
bufferView byteLength! int 1..
bufferView byteStride int 4..252
bufferView target ints 34962|34963
camera type! string perspective|orthographic
camera perspective object perspective
camera orthographic object orthographic
perspective aspectRatio number >0..
perspective yfov! number >0..
perspective zfar number >0..
perspective znear! number >0..
orthographic xmag! number ..
orthographic ymag! number ..
orthographic zfar! number >0..
orthographic znear! number 0..
image uri string
image mimeType string image/png|image/jpeg|image/webp|image/ktx2
image bufferView index bufferViews
sampler magFilter ints 9728|9729
sampler minFilter ints 9728|9729|9984|9985|9986|9987
sampler wrapS ints 33071|33648|10497
sampler wrapT ints 33071|33648|10497
texture sampler index samplers
texture source index images
texture EXT_texture_webp ext textureSource
texture KHR_texture_basisu ext textureSource
textureSource source index images
textureInfo index! index textures
textureInfo texCoord int 0..
textureInfo KHR_texture_transform ext textureTransform
textureInfo scale number ..
textureInfo strength number 0..1
textureTransform offset numbers 2 ..
textureTransform rotation number ..
textureTransform scale numbers 2 ..
textureTransform texCoord int 0..
material pbrMetallicRoughness object pbr
material normalTexture object textureInfo
material occlusionTexture object textureInfo
material emissiveTexture object textureInfo
material emissiveFactor numbers 3 0..1
material alphaMode string OPAQUE|MASK|BLEND
material alphaCutoff number 0..
material doubleSided bool
pbr baseColorFactor numbers 4 0..1
pbr baseColorTexture object textureInfo
pbr metallicFactor number 0..1
pbr roughnessFactor number 0..1
pbr metallicRoughnessTexture object textureInfo
material KHR_materials_anisotropy ext anisotropy
anisotropy anisotropyStrength number 0..1
anisotropy anisotropyRotation number ..
anisotropy anisotropyTexture object textureInfo
material KHR_materials_clearcoat ext clearcoat
clearcoat clearcoatFactor number 0..1
clearcoat clearcoatTexture object textureInfo
clearcoat clearcoatRoughnessFactor number 0..1
clearcoat clearcoatRoughnessTexture object textureInfo
clearcoat clearcoatNormalTexture object textureInfo
material KHR_materials_diffuse_transmission ext diffuseTransmission
diffuseTransmission diffuseTransmissionFactor number 0..1
diffuseTransmission diffuseTransmissionTexture object textureInfo
diffuseTransmission diffuseTransmissionColorFactor numbers 3 0..
diffuseTransmission diffuseTransmissionColorTexture object textureInfo
material KHR_materials_dispersion ext dispersion
dispersion dispersion number 0..
material KHR_materials_emissive_strength ext emissiveStrength
emissiveStrength emissiveStrength number 0..
material KHR_materials_ior ext ior
ior ior number 0..
material KHR_materials_iridescence ext iridescence
iridescence iridescenceFactor number 0..1
iridescence iridescenceTexture object textureInfo
iridescence iridescenceIor number 1..
iridescence iridescenceThicknessMinimum number 0..
iridescence iridescenceThicknessMaximum number 0..
iridescence iridescenceThicknessTexture object textureInfo
material KHR_materials_pbrSpecularGlossiness ext specularGlossiness
specularGlossiness diffuseFactor numbers 4 0..1
specularGlossiness diffuseTexture object textureInfo
specularGlossiness specularFactor numbers 3 0..1
specularGlossiness glossinessFactor number 0..1
specularGlossiness specularGlossinessTexture object textureInfo
material KHR_materials_sheen ext sheen
sheen sheenColorFactor numbers 3 0..1
sheen sheenColorTexture object textureInfo
sheen sheenRoughnessFactor number 0..1
sheen sheenRoughnessTexture object textureInfo
material KHR_materials_specular ext specular
specular specularFactor number 0..1
specular specularTexture object textureInfo
specular specularColorFactor numbers 3 0..
specular specularColorTexture object textureInfo
material KHR_materials_transmission ext transmission
transmission transmissionFactor number 0..1
transmission transmissionTexture object textureInfo
material KHR_materials_unlit ext any
material KHR_materials_volume ext volume
volume thicknessFactor number 0..
volume thicknessTexture object textureInfo
volume attenuationDistance number >0..
volume attenuationColor numbers 3 0..1
mesh primitives! objects primitive
mesh weights numbers 1+ ..
primitive attributes! map accessors
primitive indices index accessors
primitive material index materials
primitive mode ints 0|1|2|3|4|5|6
primitive targets maps accessors
primitive KHR_draco_mesh_compression ext draco
primitive KHR_materials_variants ext variantMappings
draco bufferView! index bufferViews
draco attributes! map
variants variants! objects variant
variant name! string
variantMappings mappings! objects variantMapping
variantMapping variants! indices extensions/KHR_materials_variants/variants
variantMapping material! index materials
variantMapping name string
node camera index cameras
node children indices nodes
node skin index skins
node matrix numbers 16 ..
node mesh index meshes
node rotation numbers 4 -1..1
node scale numbers 3 ..
node translation numbers 3 ..
node weights numbers 1+ ..
node KHR_lights_punctual ext lightReference
node KHR_node_visibility ext visibility
node EXT_mesh_gpu_instancing ext any
visibility visible bool
lightReference light! index extensions/KHR_lights_punctual/lights
lights lights! objects light
light color numbers 3 0..1
light intensity number 0..
light range number >0..
light type! string directional|point|spot
light spot object spot
spot innerConeAngle number 0..1.5707963267948966
spot outerConeAngle number >0..1.5707963267948966
scene nodes indices nodes
skin inverseBindMatrices index accessors
skin skeleton index nodes
skin joints! indices nodes
animation channels! objects channel
animation samplers! objects animationSampler
channel sampler! int 0..
channel target! object target
target node index nodes
target path! string translation|rotation|scale|weights|pointer
target KHR_animation_pointer ext animationPointer
animationPointer pointer! string
animationSampler input! index accessors
animationSampler output! index accessors
animationSampler interpolation string LINEAR|STEP|CUBICSPLINE
node PLIANT_deformable ext any
node PLIANT_probe ext any
node PLIANT_haptic_device ext any
node PLIANT_soft_body ext any
node PLIANT_handle ext any
node PLIANT_rigid_body ext any
node PLIANT_motion ext any
scene PLIANT_environment ext any
scene PLIANT_simulation ext any
)";

}  // namespace pliant
