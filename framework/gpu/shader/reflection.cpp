#include <algorithm>
#include <map>
#include <spirv_cross.hpp>
#include <tuple>

#include "fovea/error.h"
#include "framework/gpu/shader/shader.h"
#include "framework/gpu/shader/spirv_bindings.h"

namespace fovea::gpu {
namespace {

std::optional<VkFormat> imageFormat(spv::ImageFormat format) {
  switch (format) {
    case spv::ImageFormatRgba32f:
      return VK_FORMAT_R32G32B32A32_SFLOAT;
    case spv::ImageFormatRgba16f:
      return VK_FORMAT_R16G16B16A16_SFLOAT;
    case spv::ImageFormatR32f:
      return VK_FORMAT_R32_SFLOAT;
    case spv::ImageFormatRgba8:
      return VK_FORMAT_R8G8B8A8_UNORM;
    case spv::ImageFormatRgba8Snorm:
      return VK_FORMAT_R8G8B8A8_SNORM;
    case spv::ImageFormatRg32f:
      return VK_FORMAT_R32G32_SFLOAT;
    case spv::ImageFormatRg16f:
      return VK_FORMAT_R16G16_SFLOAT;
    case spv::ImageFormatR11fG11fB10f:
      return VK_FORMAT_B10G11R11_UFLOAT_PACK32;
    case spv::ImageFormatR16f:
      return VK_FORMAT_R16_SFLOAT;
    case spv::ImageFormatRgba16:
      return VK_FORMAT_R16G16B16A16_UNORM;
    case spv::ImageFormatRgb10A2:
      return VK_FORMAT_A2B10G10R10_UNORM_PACK32;
    case spv::ImageFormatRg16:
      return VK_FORMAT_R16G16_UNORM;
    case spv::ImageFormatRg8:
      return VK_FORMAT_R8G8_UNORM;
    case spv::ImageFormatR16:
      return VK_FORMAT_R16_UNORM;
    case spv::ImageFormatR8:
      return VK_FORMAT_R8_UNORM;
    case spv::ImageFormatRgba16Snorm:
      return VK_FORMAT_R16G16B16A16_SNORM;
    case spv::ImageFormatRg16Snorm:
      return VK_FORMAT_R16G16_SNORM;
    case spv::ImageFormatRg8Snorm:
      return VK_FORMAT_R8G8_SNORM;
    case spv::ImageFormatR16Snorm:
      return VK_FORMAT_R16_SNORM;
    case spv::ImageFormatR8Snorm:
      return VK_FORMAT_R8_SNORM;
    case spv::ImageFormatRgba32i:
      return VK_FORMAT_R32G32B32A32_SINT;
    case spv::ImageFormatRgba16i:
      return VK_FORMAT_R16G16B16A16_SINT;
    case spv::ImageFormatRgba8i:
      return VK_FORMAT_R8G8B8A8_SINT;
    case spv::ImageFormatR32i:
      return VK_FORMAT_R32_SINT;
    case spv::ImageFormatRg32i:
      return VK_FORMAT_R32G32_SINT;
    case spv::ImageFormatRg16i:
      return VK_FORMAT_R16G16_SINT;
    case spv::ImageFormatRg8i:
      return VK_FORMAT_R8G8_SINT;
    case spv::ImageFormatR16i:
      return VK_FORMAT_R16_SINT;
    case spv::ImageFormatR8i:
      return VK_FORMAT_R8_SINT;
    case spv::ImageFormatRgba32ui:
      return VK_FORMAT_R32G32B32A32_UINT;
    case spv::ImageFormatRgba16ui:
      return VK_FORMAT_R16G16B16A16_UINT;
    case spv::ImageFormatRgba8ui:
      return VK_FORMAT_R8G8B8A8_UINT;
    case spv::ImageFormatR32ui:
      return VK_FORMAT_R32_UINT;
    case spv::ImageFormatRgb10a2ui:
      return VK_FORMAT_A2B10G10R10_UINT_PACK32;
    case spv::ImageFormatRg32ui:
      return VK_FORMAT_R32G32_UINT;
    case spv::ImageFormatRg16ui:
      return VK_FORMAT_R16G16_UINT;
    case spv::ImageFormatRg8ui:
      return VK_FORMAT_R8G8_UINT;
    case spv::ImageFormatR16ui:
      return VK_FORMAT_R16_UINT;
    case spv::ImageFormatR8ui:
      return VK_FORMAT_R8_UINT;
    case spv::ImageFormatR64ui:
      return VK_FORMAT_R64_UINT;
    case spv::ImageFormatR64i:
      return VK_FORMAT_R64_SINT;
    default:
      return std::nullopt;
  }
}

uint32_t arraySize(const spirv_cross::SPIRType& type) {
  uint32_t count = 1;
  for (uint32_t n : type.array) count *= n;
  return count;
}

class Reflector {
 public:
  explicit Reflector(const std::vector<uint32_t>& spirv) : compiler_(spirv) {}

  Reflection run() {
    readStage();
    // Only what the entry point reaches, because shared includes declare more than any one shader uses.
    const spirv_cross::ShaderResources r =
        compiler_.get_shader_resources(compiler_.get_active_interface_variables());
    for (const auto& b : r.uniform_buffers) addBlock(b, BindingKind::UniformBuffer);
    for (const auto& b : r.storage_buffers) addBlock(b, BindingKind::StorageBuffer);
    for (const auto& i : r.separate_images)
      addOpaque(i, isBuffer(i) ? BindingKind::UniformTexelBuffer : BindingKind::SampledImage);
    for (const auto& i : r.sampled_images)
      addOpaque(i, isBuffer(i) ? BindingKind::UniformTexelBuffer : BindingKind::CombinedImageSampler);
    for (const auto& i : r.storage_images)
      addOpaque(i, isBuffer(i) ? BindingKind::StorageTexelBuffer : BindingKind::StorageImage);
    for (const auto& s : r.separate_samplers) addOpaque(s, BindingKind::Sampler);
    for (const auto& a : r.acceleration_structures) addOpaque(a, BindingKind::AccelerationStructure);
    for (const auto& p : r.push_constant_buffers) addConstants(p);
    for (const spv::Capability c : compiler_.get_declared_capabilities()) {
      if (c == spv::CapabilityGeometry) out_.features.emplace_back("geometryShader");
      if (c == spv::CapabilityRayQueryKHR) out_.features.emplace_back("VK_KHR_ray_query");
      if (c == spv::CapabilityInt64) out_.features.emplace_back("shaderInt64");
      if (c == spv::CapabilityDrawParameters) out_.features.emplace_back("shaderDrawParameters");
      if (c == spv::CapabilityShaderLayer || c == spv::CapabilityShaderViewportIndexLayerEXT)
        out_.features.emplace_back("shaderOutputLayer");
    }
    std::sort(out_.bindings.begin(), out_.bindings.end(),
              [](const ReflectedBinding& a, const ReflectedBinding& b) {
                return std::tie(a.set, a.binding, a.name) < std::tie(b.set, b.binding, b.name);
              });
    return std::move(out_);
  }

 private:
  void readStage() {
    switch (compiler_.get_execution_model()) {
      case spv::ExecutionModelVertex:
        out_.stage = VK_SHADER_STAGE_VERTEX_BIT;
        return;
      case spv::ExecutionModelFragment:
        out_.stage = VK_SHADER_STAGE_FRAGMENT_BIT;
        return;
      case spv::ExecutionModelGLCompute:
        out_.stage = VK_SHADER_STAGE_COMPUTE_BIT;
        break;
      default:
        throw Error(ExitCode::BadInput, "only vertex, fragment and compute shaders are supported");
    }
    for (uint32_t i = 0; i < 3; ++i)
      out_.localSize[i] = compiler_.get_execution_mode_argument(spv::ExecutionModeLocalSize, i);
  }

  bool isBuffer(const spirv_cross::Resource& r) const {
    return compiler_.get_type(r.type_id).image.dim == spv::DimBuffer;
  }

  ReflectedBinding base(const spirv_cross::Resource& r, BindingKind kind) const {
    ReflectedBinding b;
    b.name = compiler_.get_name(r.id);
    if (b.name.empty()) b.name = compiler_.get_name(r.base_type_id);
    b.set = compiler_.get_decoration(r.id, spv::DecorationDescriptorSet);
    b.binding = compiler_.get_decoration(r.id, spv::DecorationBinding);
    b.automatic = b.binding >= kAutomaticBinding;
    b.count = arraySize(compiler_.get_type(r.type_id));
    b.kind = kind;
    return b;
  }

  void addBlock(const spirv_cross::Resource& r, BindingKind kind) {
    ReflectedBinding b = base(r, kind);
    const spirv_cross::SPIRType& type = compiler_.get_type(r.base_type_id);
    b.blockBytes = compiler_.get_declared_struct_size(type);
    const spirv_cross::Bitset flags = compiler_.get_buffer_block_flags(r.id);
    b.readOnly = kind == BindingKind::UniformBuffer || flags.get(spv::DecorationNonWritable);
    b.writeOnly = flags.get(spv::DecorationNonReadable);
    addElement(type, b);
    out_.bindings.push_back(std::move(b));
  }

  void addOpaque(const spirv_cross::Resource& r, BindingKind kind) {
    ReflectedBinding b = base(r, kind);
    if (kind != BindingKind::Sampler && kind != BindingKind::AccelerationStructure) {
      const spirv_cross::SPIRType& texel = compiler_.get_type(compiler_.get_type(r.type_id).image.type);
      b.integerTexels = texel.basetype != spirv_cross::SPIRType::Float;
    }
    if (kind == BindingKind::StorageImage || kind == BindingKind::StorageTexelBuffer) {
      b.readOnly = compiler_.has_decoration(r.id, spv::DecorationNonWritable);
      b.writeOnly = compiler_.has_decoration(r.id, spv::DecorationNonReadable);
      b.imageFormat = imageFormat(compiler_.get_type(r.type_id).image.format);
    } else {
      b.readOnly = true;
    }
    out_.bindings.push_back(std::move(b));
  }

  ReflectedMember member(const spirv_cross::SPIRType& type, uint32_t bytes) const {
    ReflectedMember m;
    m.bytes = bytes;
    m.components = type.vecsize * type.columns * arraySize(type);
    switch (type.basetype) {
      case spirv_cross::SPIRType::Int:
        m.type = ReflectedMember::Type::Int;
        break;
      case spirv_cross::SPIRType::UInt:
        m.type = ReflectedMember::Type::Uint;
        break;
      case spirv_cross::SPIRType::Float:
        m.type = ReflectedMember::Type::Float;
        break;
      default:
        m.type = ReflectedMember::Type::Other;
    }
    if (m.components * 4 != m.bytes) {  // padded between columns or elements, or not of 32 bits
      m.type = ReflectedMember::Type::Other;
      m.components = 1;
    }
    return m;
  }

  ReflectedMember memberOf(const spirv_cross::SPIRType& block, uint32_t index) const {
    ReflectedMember m = member(compiler_.get_type(block.member_types[index]),
                               uint32_t(compiler_.get_declared_struct_member_size(block, index)));
    m.name = compiler_.get_member_name(block.self, index);
    m.offset = compiler_.type_struct_member_offset(block, index);
    return m;
  }

  void addElement(const spirv_cross::SPIRType& block, ReflectedBinding& b) const {
    const auto last = uint32_t(block.member_types.size()) - 1;
    const spirv_cross::SPIRType& array = compiler_.get_type(block.member_types[last]);
    if (array.array.empty()) {
      b.elementBytes = uint32_t(b.blockBytes);
      addMembers(block, "", 0, b.element);
      return;
    }
    b.elementBytes = compiler_.type_struct_member_array_stride(block, last);
    const spirv_cross::SPIRType& element = compiler_.get_type(array.parent_type);
    if (element.basetype == spirv_cross::SPIRType::Struct && element.array.empty())
      addMembers(element, "", 0, b.element);
    else
      b.element.push_back(member(element, element.vecsize * element.columns * arraySize(element) * 4));
  }

  void addMembers(const spirv_cross::SPIRType& type, const std::string& prefix, uint32_t offset,
                  std::vector<ReflectedMember>& list) const {
    for (uint32_t i = 0; i < type.member_types.size(); ++i) {
      ReflectedMember m = memberOf(type, i);
      m.name = prefix + m.name;
      m.offset += offset;
      const spirv_cross::SPIRType& inner = compiler_.get_type(type.member_types[i]);
      if (inner.basetype == spirv_cross::SPIRType::Struct && inner.array.empty())
        addMembers(inner, m.name + ".", m.offset, list);
      else
        list.push_back(std::move(m));
    }
  }

  void addConstants(const spirv_cross::Resource& r) {
    const spirv_cross::SPIRType& block = compiler_.get_type(r.base_type_id);
    out_.pushConstantBytes = uint32_t(compiler_.get_declared_struct_size(block));
    for (uint32_t i = 0; i < block.member_types.size(); ++i) out_.constants.push_back(memberOf(block, i));
  }

  spirv_cross::Compiler compiler_;
  Reflection out_;
};

}  // namespace

Reflection reflect(const std::vector<uint32_t>& spirv) {
  try {
    return Reflector(spirv).run();
  } catch (const spirv_cross::CompilerError& e) {
    throw Error(ExitCode::BadInput, std::string("cannot reflect SPIR-V: ") + e.what());
  }
}

std::vector<BindingDecoration> bindingDecorations(const std::vector<uint32_t>& spirv) {
  constexpr uint32_t kHeaderWords = 5;
  std::vector<BindingDecoration> list;
  std::map<uint32_t, uint32_t> sets;
  for (size_t i = kHeaderWords; i < spirv.size();) {
    const uint32_t words = spirv[i] >> 16, op = spirv[i] & 0xffffu;
    if (words == 0 || words > spirv.size() - i) break;
    if (op == spv::OpDecorate && words == 4) {
      if (spirv[i + 2] == spv::DecorationBinding) list.push_back({spirv[i + 1], 0, spirv[i + 3], i + 3});
      if (spirv[i + 2] == spv::DecorationDescriptorSet) sets[spirv[i + 1]] = spirv[i + 3];
    }
    i += words;
  }
  for (BindingDecoration& d : list) d.set = sets[d.variable];
  return list;
}

}  // namespace fovea::gpu
