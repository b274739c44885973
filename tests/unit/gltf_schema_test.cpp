// Every key of the schema of glTF 2.0 and of the extensions that are read: changing it changes the scene, or is reported,
// or means nothing for a picture. samples/scenes/gltf.md names them all.
#include <gmock/gmock.h>

#include <algorithm>
#include <sstream>

#include "framework/scene/scene.h"
#include "scene_support.h"

namespace fovea::scene {
namespace {

using test::loadText;
using test::TemporaryFolder;
using testing::HasSubstr;

enum class Effect : uint8_t {
  Scene,    // the scene changes
  Warning,  // `text` is in the warnings
  Error,    // `text` is in the error
  None,     // it means nothing for a picture, and the scene stays the same
  Else      // `text` is the test that covers it
};

struct Key {
  const char *key, *from, *to;  // `from` in the document is replaced by `to`
  Effect effect;
  const char* text = "";
};

constexpr Effect kScene = Effect::Scene, kWarning = Effect::Warning, kError = Effect::Error,
                 kNone = Effect::None, kElse = Effect::Else;
constexpr const char *kMeshoptTest = "gltf_meshopt_test.cpp", *kDracoTest = "gltf_draco_test.cpp";

const Key kKeys[] = {
    // Document and asset
    {"accessors", R"("accessors":[)", R"("accessors":[7,)", kError, "accessors[0]"},
    {"animations", R"("animations":[)", R"("unused":[)", kScene},
    {"asset", R"("asset":{)", R"("unused":{)", kError, "version"},
    {"buffers", R"("buffers":[)", R"("unused":[)", kError, "buffers"},
    {"bufferViews", R"("bufferViews":[)", R"("unused":[)", kError, "bufferViews"},
    {"cameras", R"("cameras":[)", R"("unused":[)", kWarning, "cameras"},
    {"images", R"("images":[)", R"("unused":[)", kWarning, "images"},
    {"materials", R"("materials":[)", R"("unused":[)", kWarning, "materials"},
    {"meshes", R"("meshes":[)", R"("unused":[)", kError, "meshes"},
    {"nodes", R"("nodes":[{)", R"("unused":[{)", kError, "nodes"},
    {"samplers", R"("samplers":[{"magFilter")", R"("unused":[{"magFilter")", kWarning, "samplers"},
    {"scene", R"("scene":0)", R"("scene":1)", kScene},
    {"scenes", R"("scenes":[)", R"("scenes":[{"nodes":[0]},)", kWarning, "2 other scene(s)"},
    {"skins", R"("skins":[)", R"("unused":[)", kWarning, "skins"},
    {"textures", R"("textures":[)", R"("unused":[)", kWarning, "textures"},
    {"extensionsUsed", R"("extensionsUsed":[)", R"("extensionsUsed":["EXT_x",)", kWarning, "EXT_x"},
    {"extensionsRequired", R"("extensionsRequired":[)", R"("extensionsRequired":["EXT_x",)", kError, "EXT_x"},
    {"extensions", R"("mesh":0)", R"("mesh":0,"extensions":{"EXT_x":{}})", kWarning, "EXT_x is ignored"},
    {"extras", R"("extras":{"a":1})", R"("extras":{"b":[2]})", kNone},
    {"asset.copyright", R"("copyright":"c")", R"("copyright":"d")", kNone},
    {"asset.generator", R"("generator":"g")", R"("generator":"h")", kNone},
    {"asset.version", R"("version":"2.0")", R"("version":"3.0")", kError, "3.0"},
    {"asset.minVersion", R"("minVersion":"2.0")", R"("minVersion":"2.1")", kError, "2.1"},
    // Data
    {"accessor.bufferView", R"("bufferView":0,"byteOffset":0)", R"("byteOffset":0)", kScene},
    {"accessor.byteOffset", R"("byteOffset":0,"componentType":5126)",
     R"("byteOffset":4,"componentType":5126)", kScene},
    {"accessor.componentType", R"("componentType":5123)", R"("componentType":5124)", kError,
     "componentType 5124"},
    {"accessor.normalized", R"("normalized":true)", R"("normalized":false)", kScene},
    {"accessor.count", R"("componentType":5123,"count":3)", R"("componentType":5123,"count":2)", kScene},
    {"accessor.type", R"("count":3,"type":"SCALAR")", R"("count":3,"type":"VEC5")", kError, "VEC5"},
    {"accessor.max", R"("max":[1,1,0])", R"("max":[9,9,9])", kNone},
    {"accessor.min", R"("min":[0,0,0])", R"("min":[-9,-9,-9])", kNone},
    {"accessor.name", R"("name":"an accessor")", R"("name":"another accessor")", kNone},
    {"accessor.sparse", R"("sparse":{)", R"("unused":{)", kScene},
    {"accessor.sparse.count", R"("sparse":{"count":1)", R"("sparse":{"count":9)", kError, "count"},
    {"accessor.sparse.indices", R"("indices":{"bufferView")", R"("unused":{"bufferView")", kError, "indices"},
    {"accessor.sparse.indices.bufferView", R"({"bufferView":0,"byteOffset":38,)",
     R"({"bufferView":9,"byteOffset":38,)", kError, "index 9"},
    {"accessor.sparse.indices.byteOffset", R"("byteOffset":38,)", R"("byteOffset":40,)", kScene},
    {"accessor.sparse.indices.componentType", R"("byteOffset":38,"componentType":5123)",
     R"("byteOffset":38,"componentType":5121)", kNone},
    {"accessor.sparse.values", R"("values":{)", R"("unused":{)", kError, "values"},
    {"accessor.sparse.values.bufferView", R"("values":{"bufferView":0)", R"("values":{"bufferView":9)",
     kError, "index 9"},
    {"accessor.sparse.values.byteOffset", R"("byteOffset":296)", R"("byteOffset":300)", kScene},
    {"buffer.uri", R"("uri":"data:)", R"("uri":"gone:)", kError, "uri"},
    {"buffer.byteLength", R"("byteLength":@SIZE@,"uri")", R"("byteLength":40,"uri")", kError, "40 bytes"},
    {"buffer.name", R"("name":"a buffer")", R"("name":"another buffer")", kNone},
    {"bufferView.buffer", R"("buffer":0,"byteLength")", R"("buffer":1,"byteLength")", kError, "index 1"},
    {"bufferView.byteOffset", R"("byteOffset":128,"byteLength":48)", R"("byteOffset":132,"byteLength":48)",
     kScene},
    {"bufferView.byteLength", R"("byteOffset":128,"byteLength":48)", R"("byteOffset":128,"byteLength":44)",
     kWarning, "44 bytes"},
    {"bufferView.byteStride", R"("byteLength":48,"byteStride":16)", R"("byteLength":48,"byteStride":8)",
     kWarning, "byteStride is 8"},
    {"bufferView.target", R"("target":34962)", R"("target":34963)", kNone},
    {"bufferView.name", R"("name":"a view")", R"("name":"another view")", kNone},
    {"image.uri", R"("images":[{)", R"("images":[{"uri":"a.png",)", kWarning, "both"},
    {"image.mimeType", R"("mimeType":"image/png")", R"("mimeType":"image/jpeg")", kNone},
    {"image.bufferView", R"("bufferView":2,"mimeType")", R"("bufferView":9,"mimeType")", kWarning, "index 9"},
    {"image.name", R"("name":"an image")", R"("name":"another image")", kScene},
    // Materials
    {"texture.sampler", R"("textures":[{"sampler":0)", R"("textures":[{"sampler":9)", kWarning, "index 9"},
    {"texture.source", R"("source":0)", R"("source":9)", kWarning, "index 9"},
    {"texture.name", R"("name":"a texture")", R"("name":"another texture")", kNone},
    {"sampler.magFilter", R"("magFilter":9728)", R"("magFilter":9729)", kScene},
    {"sampler.minFilter", R"("minFilter":9984)", R"("minFilter":9987)", kWarning, "minFilter is ignored"},
    {"sampler.wrapS", R"("wrapS":33071)", R"("wrapS":33648)", kScene},
    {"sampler.wrapT", R"("wrapT":33071)", R"("wrapT":33648)", kScene},
    {"sampler.name", R"("name":"a sampler")", R"("name":"another sampler")", kNone},
    {"material.name", R"("name":"a material")", R"("name":"another material")", kScene},
    {"material.pbrMetallicRoughness", R"("pbrMetallicRoughness":{)", R"("unused":{)", kScene},
    {"material.pbrMetallicRoughness.baseColorFactor", R"("baseColorFactor":[1)", R"("baseColorFactor":[0.5)",
     kScene},
    {"material.pbrMetallicRoughness.baseColorTexture", R"("baseColorTexture")", R"("unused")", kScene},
    {"material.pbrMetallicRoughness.metallicFactor", R"("metallicFactor":0.5)", R"("metallicFactor":0.25)",
     kScene},
    {"material.pbrMetallicRoughness.roughnessFactor", R"("roughnessFactor":0.5)", R"("roughnessFactor":0.25)",
     kScene},
    {"material.pbrMetallicRoughness.metallicRoughnessTexture", R"("metallicRoughnessTexture")", R"("unused")",
     kScene},
    {"material.normalTexture", R"("normalTexture")", R"("unused")", kScene},
    {"textureInfo.index", R"("normalTexture":{"index":0)", R"("normalTexture":{"index":9)", kWarning,
     "index 9"},
    {"textureInfo.texCoord", R"("texCoord":1)", R"("texCoord":0)", kScene},
    {"normalTextureInfo.scale", R"("scale":0.5)", R"("scale":0.25)", kScene},
    {"material.occlusionTexture", R"("occlusionTexture":)", R"("occlusionTexture":)", kWarning,
     "occlusionTexture is ignored"},
    {"occlusionTextureInfo.strength", R"("strength":0.5)", R"("strength":"strong")", kWarning, "strength"},
    {"material.emissiveTexture", R"("emissiveTexture")", R"("unused")", kScene},
    {"material.emissiveFactor", R"("emissiveFactor":[1)", R"("emissiveFactor":[2)", kScene},
    {"material.alphaMode", R"("alphaMode":"MASK")", R"("alphaMode":"OPAQUE")", kScene},
    {"material.alphaCutoff", R"("alphaCutoff":0.25)", R"("alphaCutoff":0.5)", kScene},
    {"material.doubleSided", R"("doubleSided":true)", R"("doubleSided":false)", kScene},
    // Meshes
    {"mesh.primitives", R"("primitives":[)", R"("unused":[)", kError, "primitives"},
    {"mesh.weights", R"("name":"a mesh","weights":[0.5])", R"("name":"a mesh","weights":[0.25])", kScene},
    {"mesh.name", R"("name":"a mesh")", R"("name":"another mesh")", kScene},
    {"primitive.attributes", R"("attributes":{)", R"("unused":{)", kError, "attributes"},
    {"primitive.indices", R"("indices":1)", R"("indices":99)", kError, "index 99"},
    {"primitive.material", R"("material":0)", R"("material":9)", kWarning, "index 9"},
    {"primitive.mode", R"("mode":4)", R"("mode":1)", kWarning, "points and lines"},
    {"primitive.targets", R"("targets":[)", R"("unused":[)", kScene},
    {"attributes.POSITION", R"("attributes":{"POSITION":0)", R"("attributes":{"POSITION":2)", kScene},
    {"attributes.NORMAL", R"("NORMAL":2,)", "", kScene},
    {"attributes.TANGENT", R"("TANGENT":6,)", "", kScene},
    {"attributes.TEXCOORD_0", R"("TEXCOORD_0":3,)", "", kScene},
    {"attributes.TEXCOORD_1", R"("TEXCOORD_1":4,)", "", kScene},
    {"attributes.COLOR_0", R"("COLOR_0":5,)", "", kScene},
    {"attributes.COLOR_1", R"("COLOR_0":5,)", R"("COLOR_0":5,"COLOR_1":5,)", kWarning, "COLOR_1 is ignored"},
    {"attributes.JOINTS_0", R"("JOINTS_0":7,)", "", kWarning, "WEIGHTS_0 without JOINTS_0"},
    {"attributes.WEIGHTS_0", R"("WEIGHTS_0":8})", R"("WEIGHTS_0":8,"JOINTS_1":7,"WEIGHTS_1":8})", kScene},
    {"target.POSITION", R"("targets":[{"POSITION":9)", R"("targets":[{"POSITION":0)", kScene},
    {"target.NORMAL", R"("POSITION":9,"NORMAL":9})", R"("POSITION":9})", kScene},
    {"target.TANGENT", R"("targets":[{)", R"("targets":[{"TANGENT":9,)", kWarning, "do not change TANGENT"},
    {"target.COLOR_0", R"("targets":[{)", R"("targets":[{"COLOR_0":9,)", kWarning, "do not change COLOR_0"},
    {"target.TEXCOORD_0", R"("targets":[{)", R"("targets":[{"TEXCOORD_0":9,)", kWarning,
     "do not change TEXCOORD_0"},
    // Nodes
    {"scene.nodes", R"({"nodes":[0,1,2,3,4],)", R"({"nodes":[0,1,2,4],)", kScene},
    {"scene.name", R"("name":"a scene")", R"("name":"another scene")", kNone},
    {"node.camera", R"("camera":0)", R"("unused":0)", kScene},
    {"node.children", R"("children":[5])", R"("unused":[5])", kScene},
    {"node.skin", R"("skin":0)", R"("unused":0)", kScene},
    {"node.matrix", R"("matrix":[1)", R"("matrix":[2)", kScene},
    {"node.mesh", R"("mesh":0,)", "", kScene},
    {"node.rotation", R"("rotation":[0,0,0,1])", R"("rotation":[0,1,0,0])", kScene},
    {"node.scale", R"("scale":[1,1,1])", R"("scale":[2,1,1])", kScene},
    {"node.translation", R"("translation":[0,0,4])", R"("translation":[0,0,5])", kScene},
    {"node.weights", R"("skin":0,"weights":[0.5])", R"("skin":0,"weights":[0.75])", kScene},
    {"node.name", R"("name":"a node")", R"("name":"another node")", kScene},
    {"skin.inverseBindMatrices", R"("inverseBindMatrices":10)", R"("unused":10)", kScene},
    {"skin.skeleton", R"("skeleton":3)", R"("skeleton":4)", kNone},
    {"skin.joints", R"("joints":[3])", R"("joints":[4])", kScene},
    {"skin.name", R"("name":"a skin")", R"("name":"another skin")", kScene},
    // Animations
    {"animation.channels", R"("channels":[)", R"("unused":[)", kWarning, "channels"},
    {"animation.channels.sampler", R"("channels":[{"sampler":0)", R"("channels":[{"sampler":9)", kWarning,
     "sampler"},
    {"animation.channels.target", R"("target":{)", R"("unused":{)", kWarning, "target"},
    {"animation.channels.target.node", R"("target":{"node":4)", R"("target":{"node":3)", kScene},
    {"animation.channels.target.path", R"("path":"translation")", R"("path":"scale")", kScene},
    {"animation.samplers", R"("samplers":[{"input")", R"("unused":[{"input")", kWarning, "samplers"},
    {"animation.samplers.input", R"("input":11)", R"("input":1)", kWarning, "3 keys need 9"},
    {"animation.samplers.interpolation", R"("interpolation":"LINEAR")", R"("interpolation":"STEP")", kScene},
    {"animation.samplers.output", R"("output":12)", R"("output":11)", kWarning, "accessors[11]"},
    {"animation.name", R"("name":"an animation")", R"("name":"another animation")", kScene},
    // Cameras
    {"camera.type", R"("type":"perspective")", R"("type":"orthographic")", kWarning, "orthographic"},
    {"camera.perspective", R"("perspective":{)", R"("unused":{)", kWarning, "perspective"},
    {"camera.perspective.yfov", R"("yfov":0.7)", R"("yfov":0.8)", kScene},
    {"camera.perspective.znear", R"("znear":0.1)", R"("znear":0.2)", kScene},
    {"camera.perspective.zfar", R"("zfar":50)", R"("zfar":60)", kScene},
    {"camera.perspective.aspectRatio", R"("aspectRatio":1.5)", R"("aspectRatio":-1)", kWarning,
     "aspectRatio"},
    {"camera.orthographic", R"("type":"perspective")", R"("orthographic":{},"type":"orthographic")", kWarning,
     "orthographic"},
    {"camera.orthographic.xmag", R"("type":"perspective")",
     R"("orthographic":{"xmag":1,"ymag":1,"znear":1,"zfar":2},"type":"orthographic")", kWarning,
     "orthographic"},
    {"camera.name", R"("name":"a camera")", R"("name":"another camera")", kScene},
    // Extensions
    {"KHR_lights_punctual.lights", R"("lights":[)", R"("unused":[)", kWarning, "lights"},
    {"KHR_lights_punctual.lights.type", R"("type":"spot")", R"("type":"point")", kScene},
    {"KHR_lights_punctual.lights.color", R"("color":[1)", R"("color":[0.5)", kScene},
    {"KHR_lights_punctual.lights.intensity", R"("intensity":10)", R"("intensity":20)", kScene},
    {"KHR_lights_punctual.lights.range", R"("range":7)", R"("range":8)", kScene},
    {"KHR_lights_punctual.lights.name", R"("name":"a light")", R"("name":"another light")", kScene},
    {"KHR_lights_punctual.lights.spot", R"("spot":{)", R"("unused":{)", kWarning, "spot"},
    {"KHR_lights_punctual.lights.spot.innerConeAngle", R"("innerConeAngle":0.1)", R"("innerConeAngle":0.2)",
     kScene},
    {"KHR_lights_punctual.lights.spot.outerConeAngle", R"("outerConeAngle":0.6)", R"("outerConeAngle":0.7)",
     kScene},
    {"KHR_lights_punctual.light", R"("light":0)", R"("light":3)", kWarning, "light"},
    {"KHR_materials_clearcoat.clearcoatFactor", R"("clearcoatFactor":0.5)", R"("clearcoatFactor":0.6)",
     kScene},
    {"KHR_materials_clearcoat.clearcoatTexture", R"("clearcoatTexture")", R"("unused")", kScene},
    {"KHR_materials_clearcoat.clearcoatRoughnessFactor", R"("clearcoatRoughnessFactor":0.5)",
     R"("clearcoatRoughnessFactor":0.6)", kScene},
    {"KHR_materials_clearcoat.clearcoatRoughnessTexture", R"("clearcoatRoughnessTexture")", R"("unused")",
     kScene},
    {"KHR_materials_clearcoat.clearcoatNormalTexture", R"("clearcoatFactor")",
     R"("clearcoatNormalTexture":{"index":0},"clearcoatFactor")", kWarning, "clearcoatNormalTexture"},
    {"KHR_materials_emissive_strength.emissiveStrength", R"("emissiveStrength":2)", R"("emissiveStrength":3)",
     kScene},
    {"KHR_materials_ior.ior", R"("ior":1.4)", R"("ior":1.6)", kScene},
    {"KHR_materials_specular.specularFactor", R"("specularFactor":0.5)", R"("specularFactor":0.6)", kScene},
    {"KHR_materials_specular.specularTexture", R"("specularTexture")", R"("unused")", kScene},
    {"KHR_materials_specular.specularColorFactor", R"("specularColorFactor":[0.5)",
     R"("specularColorFactor":[0.6)", kScene},
    {"KHR_materials_specular.specularColorTexture", R"("specularColorTexture")", R"("unused")", kScene},
    {"KHR_materials_transmission.transmissionFactor", R"("transmissionFactor":0.5)",
     R"("transmissionFactor":0.6)", kScene},
    {"KHR_materials_transmission.transmissionTexture", R"("transmissionTexture")", R"("unused")", kScene},
    {"KHR_materials_unlit", R"("KHR_materials_ior")", R"("KHR_materials_unlit":{},"KHR_materials_ior")",
     kScene},
    {"KHR_texture_transform.offset", R"("offset":[0.5,0])", R"("offset":[0.25,0])", kScene},
    {"KHR_texture_transform.rotation", R"("rotation":0.5)", R"("rotation":0.25)", kScene},
    {"KHR_texture_transform.scale", R"("scale":[2,1])", R"("scale":[3,1])", kScene},
    {"KHR_texture_transform.texCoord", R"("KHR_texture_transform":{)",
     R"("KHR_texture_transform":{"texCoord":1,)", kScene},
    {"KHR_mesh_quantization", "", "", kElse, "gltf_test.cpp"},
    {"EXT_meshopt_compression.buffer", "", "", kElse, kMeshoptTest},
    {"EXT_meshopt_compression.byteOffset", "", "", kElse, kMeshoptTest},
    {"EXT_meshopt_compression.byteLength", "", "", kElse, kMeshoptTest},
    {"EXT_meshopt_compression.byteStride", "", "", kElse, kMeshoptTest},
    {"EXT_meshopt_compression.count", "", "", kElse, kMeshoptTest},
    {"EXT_meshopt_compression.mode", "", "", kElse, kMeshoptTest},
    {"EXT_meshopt_compression.filter", "", "", kElse, kMeshoptTest},
    {"EXT_meshopt_compression.fallback", "", "", kElse, kMeshoptTest},
    {"KHR_draco_mesh_compression.bufferView", "", "", kElse, kDracoTest},
    {"KHR_draco_mesh_compression.attributes", "", "", kElse, kDracoTest},
};

// A valid document with every key that changes a scene.
std::string document() {
  std::string bytes = test::triangleBytes();                                          // 0, indices at 36
  test::appendBytes<float>(bytes, {0, 0, 1, 0, 0, 1, 0, 0, 1});                       // 44: normals
  test::appendBytes<float>(bytes, {0, 0, 1, 0, 0, 1});                                // 80: uvs
  test::appendBytes<float>(bytes, {0, 0.5f, 1, 0, 0.5f, 1});                          // 104: other uvs
  test::appendBytes<float>(bytes, {1, 1, 1, 1, 1, 0, 0, 1, 0, 0, 1, 0.5f});           // 128: colours
  test::appendBytes<float>(bytes, {1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1});              // 176: tangents
  test::appendBytes<uint8_t>(bytes, {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0});            // 224: joints
  for (int i = 0; i < 3; ++i) test::appendBytes<uint16_t>(bytes, {65535, 0, 0, 0});   // 236: weights
  test::appendBytes<float>(bytes, {0, 0, 1, 0, 0, 2, 0, 3, 0});                       // 260: displacements
  test::appendBytes<float>(bytes, {0, 0, 7, 8});                                      // 296: sparse values
  test::appendBytes<float>(bytes, {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 1, 1});  // 312: inverse bind
  test::appendBytes<float>(bytes, {0, 1});                                            // 376: times
  test::appendBytes<float>(bytes, {0, 0, 0, 1, 0, 0});                                // 384: translations
  const unsigned char png[] = {137, 80, 78, 71, 13, 10,  26,  10, 0,  0,  0,  13,  73,  72, 68,  82, 0, 0,
                               0,   1,  0,  0,  0,  1,   8,   2,  0,  0,  0,  144, 119, 83, 222, 0,  0, 0,
                               12,  73, 68, 65, 84, 120, 156, 99, 96, 96, 96, 0,   0,   0,  4,   0,  1, 246,
                               23,  56, 85, 0,  0,  0,   0,   73, 69, 78, 68, 174, 66,  96, 130};
  bytes.append(std::begin(png), std::end(png));  // 408
  const std::string size = std::to_string(bytes.size());
  std::string text =
      R"({"asset":{"version":"2.0","minVersion":"2.0","copyright":"c","generator":"g"},"extras":{"a":1},
"extensionsUsed":["KHR_lights_punctual"],"extensionsRequired":["KHR_lights_punctual"],
"scene":0,"scenes":[{"nodes":[0,1,2,3,4],"name":"a scene"},{"nodes":[0]}],
"nodes":[{"mesh":0,"skin":0,"weights":[0.5],"name":"a node"},{"camera":0,"translation":[0,0,4],"rotation":[0,0,0,1],"scale":[1,1,1]},
{"extensions":{"KHR_lights_punctual":{"light":0}}},{"matrix":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]},{"children":[5]},{"mesh":1}],
"extensions":{"KHR_lights_punctual":{"lights":[{"name":"a light","type":"spot","color":[1,1,1],"intensity":10,"range":7,
"spot":{"innerConeAngle":0.1,"outerConeAngle":0.6}}]}},
"cameras":[{"name":"a camera","type":"perspective","perspective":{"yfov":0.7,"znear":0.1,"zfar":50,"aspectRatio":1.5}}],
"skins":[{"name":"a skin","joints":[3],"skeleton":3,"inverseBindMatrices":10}],
"animations":[{"name":"an animation","channels":[{"sampler":0,"target":{"node":4,"path":"translation"}}],
"samplers":[{"input":11,"output":12,"interpolation":"LINEAR"}]}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0,"NORMAL":2,"TANGENT":6,"TEXCOORD_0":3,"TEXCOORD_1":4,"COLOR_0":5,"JOINTS_0":7,
"WEIGHTS_0":8},"indices":1,"material":0,"mode":4,"targets":[{"POSITION":9,"NORMAL":9}]}],"name":"a mesh","weights":[0.5]},
{"primitives":[{"attributes":{"POSITION":13},"indices":1,"material":1}],"name":"sparse"}],
"materials":[{"name":"a material","alphaMode":"MASK","alphaCutoff":0.25,"doubleSided":true,"emissiveFactor":[1,1,1],
"emissiveTexture":{"index":0},"normalTexture":{"index":0,"scale":0.5},"occlusionTexture":{"index":0,"strength":0.5},
"pbrMetallicRoughness":{"baseColorFactor":[1,1,1,1],"metallicFactor":0.5,"roughnessFactor":0.5,
"baseColorTexture":{"index":0,"extensions":{"KHR_texture_transform":{"offset":[0.5,0],"rotation":0.5,"scale":[2,1]}}},
"metallicRoughnessTexture":{"index":0,"texCoord":1}},
"extensions":{"KHR_materials_emissive_strength":{"emissiveStrength":2},"KHR_materials_ior":{"ior":1.4},
"KHR_materials_clearcoat":{"clearcoatFactor":0.5,"clearcoatTexture":{"index":0},"clearcoatRoughnessFactor":0.5,"clearcoatRoughnessTexture":{"index":0}},
"KHR_materials_specular":{"specularFactor":0.5,"specularTexture":{"index":0},"specularColorFactor":[0.5,1,1],"specularColorTexture":{"index":0}},
"KHR_materials_transmission":{"transmissionFactor":0.5,"transmissionTexture":{"index":0}}}},{}],
"textures":[{"sampler":0,"source":0,"name":"a texture"}],
"samplers":[{"magFilter":9728,"minFilter":9984,"wrapS":33071,"wrapT":33071,"name":"a sampler"}],
"images":[{"bufferView":2,"mimeType":"image/png","name":"an image"}],
"accessors":[{"bufferView":0,"byteOffset":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0],"name":"an accessor"},
{"bufferView":0,"byteOffset":36,"componentType":5123,"count":3,"type":"SCALAR"},
{"bufferView":0,"byteOffset":44,"componentType":5126,"count":3,"type":"VEC3"},
{"bufferView":0,"byteOffset":80,"componentType":5126,"count":3,"type":"VEC2"},
{"bufferView":0,"byteOffset":104,"componentType":5123,"normalized":true,"count":3,"type":"VEC2"},
{"bufferView":1,"componentType":5126,"count":3,"type":"VEC4"},
{"bufferView":0,"byteOffset":176,"componentType":5126,"count":3,"type":"VEC4"},
{"bufferView":0,"byteOffset":224,"componentType":5121,"count":3,"type":"VEC4"},
{"bufferView":0,"byteOffset":236,"componentType":5123,"normalized":true,"count":3,"type":"VEC4"},
{"bufferView":0,"byteOffset":260,"componentType":5126,"count":3,"type":"VEC3"},
{"bufferView":0,"byteOffset":312,"componentType":5126,"count":1,"type":"MAT4"},
{"bufferView":0,"byteOffset":376,"componentType":5126,"count":2,"type":"SCALAR"},
{"bufferView":0,"byteOffset":384,"componentType":5126,"count":2,"type":"VEC3"},
{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","sparse":{"count":1,"indices":{"bufferView":0,"byteOffset":38,"componentType":5123},
"values":{"bufferView":0,"byteOffset":296}}}],
"bufferViews":[{"buffer":0,"byteLength":408,"name":"a view"},{"buffer":0,"byteOffset":128,"byteLength":48,"byteStride":16,"target":34962},
{"buffer":0,"byteOffset":408,"byteLength":)" +
      std::to_string(sizeof png) +
      R"(}],
"buffers":[{"byteLength":@SIZE@,"uri":"data:;base64,)" +
      test::base64(bytes) + R"(","name":"a buffer"}]})";
  text.replace(text.find("@SIZE@"), 6, size);
  return text;
}

// All that a loader has found: content and names.
std::string contentOf(const Scene& s) {
  std::ostringstream out;
  out << s.hash << flatten(s).stillKey;
  for (const Node& n : s.nodes) out << n.name << '|' << n.camera << '|' << n.light << '|';
  for (const Material& m : s.materials) out << m.name << '|';
  for (const Texture& t : s.textures) out << t.name << '|';
  for (const Mesh& m : s.meshes) out << m.name << '|';
  for (const Skin& k : s.skins) out << k.name << '|';
  for (const Camera& c : s.cameras) out << c.name << '|';
  for (const Light& l : s.lights) out << l.name << '|';
  for (const Animation& a : s.animations) out << a.name << '|';
  return out.str();
}

class GltfSchema : public testing::TestWithParam<Key> {};

TEST_P(GltfSchema, IsReadOrTold) {
  const Key& k = GetParam();
  if (k.effect == Effect::Else) {
    EXPECT_TRUE(std::filesystem::exists(std::filesystem::path(FOVEA_SOURCE_DIR) / "tests/unit" / k.text));
    return;
  }
  const std::string good = document();
  std::string text = good, from = k.from;
  if (const size_t at = from.find("@SIZE@"); at != std::string::npos) {
    const size_t size = good.find(R"("byteLength":)", good.find(R"("buffers":)")) + 13;
    from.replace(at, 6, good.substr(size, good.find(',', size) - size));
  }
  const size_t place = text.find(from);
  ASSERT_NE(place, std::string::npos) << from;
  text.replace(place, from.size(), k.to);
  TemporaryFolder folder;
  Diagnostics warnings, changedWarnings;
  const Scene before = loadText(folder, good, warnings);
  EXPECT_THAT(warnings.format(), testing::Not(HasSubstr("left out")));
  std::string error;
  Scene after;
  try {
    after = loadText(folder, text, changedWarnings);
  } catch (const Error& e) {
    error = e.what();
  }
  if (k.effect == Effect::Error) {
    EXPECT_THAT(error, HasSubstr(k.text));
    return;
  }
  ASSERT_EQ(error, "");
  if (k.effect == Effect::Warning)
    EXPECT_THAT(changedWarnings.format(), HasSubstr(k.text));
  else
    EXPECT_EQ(contentOf(before) != contentOf(after), k.effect == Effect::Scene) << changedWarnings.format();
}

INSTANTIATE_TEST_SUITE_P(All, GltfSchema, testing::ValuesIn(kKeys), [](const auto& info) {
  std::string name = info.param.key;
  std::ranges::replace(name, '.', '_');
  return name;
});

TEST(GltfSchemaPage, NamesEveryKey) {
  std::ifstream in(std::filesystem::path(FOVEA_SOURCE_DIR) / "samples/scenes/gltf.md");
  const std::string page((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  for (const Key& k : kKeys) {
    const std::string key = k.key;
    EXPECT_THAT(page, HasSubstr("`" + key.substr(key.rfind('.') + 1) + "`")) << key;
  }
}

}  // namespace
}  // namespace fovea::scene
