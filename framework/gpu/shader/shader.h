// Compiles GLSL to SPIR-V at run time, with includes, a disk cache keyed by content, and reflection.
#pragma once

#include <vulkan/vulkan.h>

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "fovea/graph.h"

namespace fovea::gpu {

using Defines = std::map<std::string, std::string>;

enum class BindingKind {
  UniformBuffer,
  StorageBuffer,
  UniformTexelBuffer,
  StorageTexelBuffer,
  SampledImage,
  CombinedImageSampler,
  StorageImage,
  Sampler,
  AccelerationStructure
};

using ReflectedMember = graph::RecordField;  // of a block or of a struct in one

struct ReflectedBinding {
  std::string name;  // instance name, or block name if the block has no instance name
  uint32_t set = 0, binding = 0, count = 1;
  BindingKind kind{};
  bool readOnly = false, writeOnly = false;  // storage buffers and images
  uint64_t blockBytes = 0;                   // uniform and storage blocks: size of the fixed part
  std::optional<VkFormat> imageFormat;       // storage images
  bool integerTexels = false;                // images and texel buffers: isampler2D, usamplerBuffer
  bool automatic = false;                    // no layout(binding): the compiler chose the number
  // Blocks: what an element of the array at the end consists of, or the block itself if it does not end in one. Structs
  // inside of it are taken apart ("start.position"); numbers and vectors have no name.
  std::vector<ReflectedMember> element;
  uint32_t elementBytes = 0;  // from one element to the next
};

struct Reflection {
  VkShaderStageFlagBits stage{};
  std::vector<ReflectedBinding> bindings;  // what the entry point uses; sorted by set, then binding
  std::vector<ReflectedMember> constants;  // members of the push constant block
  uint32_t pushConstantBytes = 0;
  uint32_t localSize[3] = {1, 1, 1};
  std::vector<std::string> features;  // what it uses of gpu::dispensableFeatures()
};

struct CompiledShader {
  std::string file;  // as the user knows it, e.g. "shaders/blur/blur.comp"
  std::vector<uint32_t> spirv;
  Reflection reflection;
  uint64_t hash = 0;  // of the source with all includes, the defines and the compiler version
};

// The stage follows from the file name: .comp, .vert or .frag. Without #version, a shader is GLSL 4.60. #include,
// #pragma once and texelFetch on plain textures (GL_EXT_samplerless_texture_functions) are always available.
// Resources of set 0 need no layout(binding): `uniform texture2D radiance;` is found by its name, and pipelines make
// the numbers of their stages consistent. Resources of set 1 (shaders/scene/scene.glsl) have explicit numbers. Safe
// to call from several threads.
class ShaderCompiler {
 public:
  // Without a cacheDirectory there is no disk cache. `always` is defined in every shader.
  explicit ShaderCompiler(std::filesystem::path cacheDirectory, Defines always = {});
  ~ShaderCompiler();
  // Adds a folder that is searched for shader files and #include; the first match wins. The including file's own
  // folder is searched before these.
  void addSearchPath(std::filesystem::path path);
  // `name` is relative to a search path ("blur/blur.comp"). Results are kept, so that a second call is a look-up.
  // Throws Error(BadInput) with file and line of every compiler message, also inside included files.
  std::shared_ptr<const CompiledShader> compile(const std::string& name, const Defines& defines = {});
  // Forgets the results, so that files are looked at again. What was handed out stays valid.
  void forget();
  // Compiles source text instead of a file (tests).
  std::shared_ptr<const CompiledShader> compileSource(const std::string& name, const std::string& source,
                                                      const Defines& defines = {});

  // The number of results so far, by origin.
  struct Statistics {
    uint32_t compiled = 0, fromDisk = 0, fromMemory = 0;
  };
  Statistics statistics() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// Throws Error(BadInput) if `spirv` is not SPIR-V.
Reflection reflect(const std::vector<uint32_t>& spirv);

}  // namespace fovea::gpu
