#include "framework/scene/device/animator.h"

#include <algorithm>
#include <cstring>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "fovea/error.h"
#include "framework/gpu/barrier.h"
#include "framework/gpu/device.h"
#include "framework/gpu/pipeline.h"
#include "framework/gpu/resources.h"
#include "framework/gpu/shader/shader.h"
#include "framework/scene/device/named_buffers.h"
#include "framework/scene/device/subdivider.h"
#include "framework/scene/device/texel_table.h"
#include "framework/scene/motion/deform.h"
#include "framework/scene/motion/motion.h"

namespace fovea::scene {
namespace {

// Push constants of animate.comp.
struct AnimateConstants {
  uint32_t count, vertices, firstVertex, firstPose, firstJoint, firstWeight;
};

constexpr uint32_t kObjectTexels = 4, kJointTexels = 3;

// The tables of animate.comp.
struct Shapes {
  std::vector<glm::vec4> rest, skinWeights, targets;
  std::vector<glm::uvec4> shapes;
  std::vector<glm::u16vec4> skinJoints;

  uint32_t vertices() const { return uint32_t(rest.size() / 2); }

  template <class Shape>  // a Primitive or a SubdivisionCage
  void add(const Shape& shape, const std::vector<glm::vec3>* normals, const std::vector<glm::vec4>& colors,
           const Object& object, uint32_t index) {
    const uint32_t number = uint32_t(shapes.size() / 2), count = uint32_t(shape.positions.size());
    const bool bent = object.jointCount > 0 && !shape.joints.empty();
    const uint32_t morphs = std::min(uint32_t(shape.targets.size()), object.weightCount);
    const uint32_t sets = bent ? uint32_t(shape.joints.size()) / count : 0;
    shapes.emplace_back(object.firstJoint, object.firstWeight, morphs, index | sets << 16);
    shapes.emplace_back(bent ? uint32_t(skinJoints.size()) + 1 : 0, uint32_t(targets.size()), vertices(),
                        count);
    for (uint32_t i = 0; i < count; ++i) {
      rest.emplace_back(shape.positions[i], float(number));
      rest.emplace_back(normals ? (*normals)[i] : glm::vec3(0, 1, 0), colors.empty() ? 1.0f : colors[i].a);
    }
    if (bent) {
      skinJoints.insert(skinJoints.end(), shape.joints.begin(), shape.joints.end());
      skinWeights.insert(skinWeights.end(), shape.weights.begin(), shape.weights.end());
    }
    const auto at = [](const std::vector<glm::vec3>& list, uint32_t i) {
      return glm::vec4(list.empty() ? glm::vec3(0) : list[i], 0);
    };
    for (uint32_t t = 0; t < morphs; ++t)
      for (uint32_t i = 0; i < count; ++i) {
        targets.push_back(at(shape.targets[t].positions, i));
        targets.push_back(at(shape.targets[t].normals, i));
      }
  }

  // Number of vertices that stencils make.
  void skip(uint32_t count, uint32_t index) {
    const float number = float(shapes.size() / 2);
    shapes.emplace_back(0, 0, 0, index);
    shapes.emplace_back(0, 0, vertices(), 0);
    rest.insert(rest.end(), 2 * size_t(count), glm::vec4(0, 0, 0, number));
  }
};

constexpr const char* kFewerVertices = "let fewer vertices move, or drop morph targets";

void storeRows(glm::vec4* texels, const glm::mat4& m) {
  const glm::mat4 rows = glm::transpose(m);
  for (int i = 0; i < 3; ++i) texels[i] = rows[i];
}

}  // namespace

struct Animator::Impl {
  gpu::Device& device;
  const uint32_t firstVertex, vertices;  // the vertices that move
  uint32_t sources = 0, objectCount = 0, jointCount = 0, weightCount = 0;
  ObjectPoses still;  // at time 0
  gpu::Pipeline pipeline;
  gpu::Buffer rest, shapes, skinJoints, skinWeights, targets, points;
  std::vector<gpu::Buffer> poses;  // one per slot: the poses of this frame, then those of the previous one
  std::vector<glm::vec4> now, before;  // of the current frame
  std::vector<glm::vec4> last;         // poses of the vertices in the buffers, once `known`
  bool known = false;
  std::optional<Subdivider> subdivider;
  struct Surface {
    Subdivider::Surface surface;
    uint32_t object = 0, joint = 0;
    bool bent = false;  // bent by joints
  };
  std::vector<Surface> caged;
  struct Slot {
    bool follows = false;  // the buffers hold the vertices of the previous frame
    std::vector<Subdivider::Surface> now, before;
  };
  std::vector<Slot> slots;

  Impl(gpu::Device& d, const Scene& scene, const Geometry& g, uint32_t slotCount)
      : device(d),
        firstVertex(g.staticVertices()),
        vertices(uint32_t(g.positions.size()) - g.staticVertices()),
        objectCount(uint32_t(g.objects.size())),
        still(objectsAt(scene, g, 0, 0)),
        pipeline(d, gpu::ComputePipelineDesc{d.shaders().compile("scene/animate.comp")}) {
    jointCount = uint32_t(still.joints.size()), weightCount = uint32_t(still.weights.size());
    makeTables(scene, g);
    slots.resize(slotCount);
    for (Slot& slot : slots) {
      slot.now.reserve(caged.size()), slot.before.reserve(caged.size());
      poses.emplace_back(device,
                         gpu::BufferDesc{"poses", 2 * poseTexels() * sizeof(glm::vec4),
                                         VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT, gpu::MemoryKind::Upload});
    }
    for (auto* list : {&now, &before, &last}) list->resize(poseTexels(), glm::vec4(0));
  }

  void makeTables(const Scene& scene, const Geometry& g) {
    Shapes list;
    std::map<const Stencils*, uint32_t> tableOf;
    std::vector<Stencils> tables;
    for (uint32_t i = 0; i < g.objects.size(); ++i) {
      const Object& object = g.objects[i];
      if (!object.dynamic) continue;
      if (object.stencils) {
        list.skip(object.vertexCount, i);
        continue;
      }
      for (const Primitive& p : scene.meshes[scene.nodes[object.node].mesh].primitives)
        list.add(p, &p.normals, p.colors, object, i);
    }
    if (list.vertices() != vertices)
      throw Error(ExitCode::Internal, "the moving vertices of the scene are not those of its geometry");
    for (uint32_t i = 0; i < g.objects.size(); ++i) {
      const Object& object = g.objects[i];
      if (!object.stencils) continue;
      const SubdivisionCage& cage = *scene.meshes[scene.nodes[object.node].mesh].cage;
      const auto [entry, isNew] = tableOf.try_emplace(object.stencils.get(), uint32_t(tables.size()));
      if (isNew) tables.push_back(*object.stencils);
      Surface s;
      s.surface = {entry->second, list.vertices() - vertices, object.firstVertex, false};
      s.object = i;
      s.joint = object.firstJoint;
      s.bent = object.jointCount > 0;
      caged.push_back(s);
      list.add(cage, nullptr, {}, object, i);
    }
    sources = list.vertices();
    upload(std::move(list));
    if (!tables.empty()) subdivider.emplace(device, tables);
    const uint64_t pointCount = std::max(1u, sources - vertices);
    points =
        gpu::Buffer(device, {"points of cages", pointCount * sizeof(glm::vec4),
                             VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT,
                             gpu::MemoryKind::Device});
  }

  void upload(Shapes list) {
    rest = texelTable(device, "vertices at rest", std::move(list.rest), kFewerVertices);
    shapes = texelTable(device, "shapes that move", std::move(list.shapes), kFewerVertices);
    skinJoints = texelTable(device, "joints of vertices", std::move(list.skinJoints), kFewerVertices);
    skinWeights = texelTable(device, "weights of joints", std::move(list.skinWeights), kFewerVertices);
    targets = texelTable(device, "morph targets", std::move(list.targets), kFewerVertices);
  }

  uint32_t jointTexel() const { return kObjectTexels * objectCount; }
  uint32_t weightTexel() const { return jointTexel() + kJointTexels * jointCount; }
  uint32_t poseTexels() const { return std::max(1u, weightTexel() + (weightCount + 3) / 4); }

  void storePoses(glm::vec4* texels, const Frame& frame, bool before) const;
  void push(VkCommandBuffer cmd, uint32_t slot, gpu::Buffer& positions, gpu::Buffer& attributes);
  void evaluate(VkCommandBuffer cmd, uint32_t slot, gpu::Buffer& positions, gpu::Buffer& attributes,
                bool before);
};

void Animator::Impl::storePoses(glm::vec4* texels, const Frame& frame, bool before) const {
  for (uint32_t i = 0; i < objectCount; ++i) {
    const ObjectTransform& o = i < frame.objects.size() ? frame.objects[i] : still.objects[i];
    storeRows(texels + kObjectTexels * i, before ? o.previousToWorld : o.toWorld);
    texels[kObjectTexels * i + 3] = glm::vec4(before ? o.previousVisible : o.visible, 0, 0, 0);
  }
  const auto& fromFrame = before ? frame.previousJoints : frame.joints;
  const auto& joints = fromFrame.size() == jointCount ? fromFrame : still.joints;
  for (uint32_t i = 0; i < jointCount; ++i) storeRows(texels + jointTexel() + kJointTexels * i, joints[i]);
  const auto& weightsOfFrame = before ? frame.previousWeights : frame.weights;
  const auto& weights = weightsOfFrame.size() == weightCount ? weightsOfFrame : still.weights;
  for (uint32_t i = 0; i < weightCount; ++i) texels[weightTexel() + i / 4][int(i % 4)] = weights[i];
}

void Animator::Impl::push(VkCommandBuffer cmd, uint32_t slot, gpu::Buffer& positions,
                          gpu::Buffer& attributes) {
  constexpr VkFormat kFloats = VK_FORMAT_R32G32B32A32_SFLOAT;
  bindNamed(device, cmd, pipeline,
            {{"rest", rest.texelView(kFloats)},
             {"shapes", shapes.texelView(VK_FORMAT_R32G32B32A32_UINT)},
             {"skinJoints", skinJoints.texelView(VK_FORMAT_R16G16B16A16_UINT)},
             {"skinWeights", skinWeights.texelView(kFloats)},
             {"targets", targets.texelView(kFloats)},
             {"poses", poses[slot].texelView(kFloats)}},
            {{"Positions", &positions}, {"Attributes", &attributes}, {"Points", &points}});
}

void Animator::Impl::evaluate(VkCommandBuffer cmd, uint32_t slot, gpu::Buffer& positions,
                              gpu::Buffer& attributes, bool before) {
  push(cmd, slot, positions, attributes);
  const uint32_t first = before ? poseTexels() : 0;
  const AnimateConstants constants{
      sources, vertices, firstVertex, first, first + jointTexel(), first + weightTexel()};
  vkCmdPushConstants(cmd, pipeline.layout(), pipeline.interface().stages, 0, sizeof constants, &constants);
  const uint32_t groups = (sources + 63) / 64;
  dispatchRows(cmd, groups);
  if (!subdivider) return;
  constexpr auto kCompute = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
  gpu::memoryBarrier(cmd, kCompute, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT, kCompute,
                     VK_ACCESS_2_SHADER_SAMPLED_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_READ_BIT |
                         VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT);
  subdivider->record(cmd, points, positions, attributes, before ? slots[slot].before : slots[slot].now);
}

Animator::Animator(gpu::Device& device, const Scene& scene, const Geometry& geometry, uint32_t slots)
    : impl_(std::make_unique<Impl>(device, scene, geometry, slots)) {}
Animator::~Animator() = default;

void Animator::update(const Frame& frame, uint32_t slot) {
  Impl& s = *impl_;
  Impl::Slot& state = s.slots.at(slot);
  const size_t texels = s.poseTexels();
  s.storePoses(s.now.data(), frame, false);
  s.storePoses(s.before.data(), frame, true);
  state.follows = s.known && std::memcmp(s.last.data(), s.before.data(), texels * sizeof(glm::vec4)) == 0;
  s.known = true;
  s.last = s.now;
  auto* mapped = static_cast<glm::vec4*>(s.poses[slot].mapped());
  std::copy(s.now.begin(), s.now.end(), mapped);
  std::copy(s.before.begin(), s.before.end(), mapped + texels);
  // Whether a cage is turned inside out, as mirrored() of deform.h defines it.
  const auto mirrored = [&](const glm::vec4* texel) {
    return glm::dot(glm::vec3(texel[0]), glm::cross(glm::vec3(texel[1]), glm::vec3(texel[2]))) < 0.0f;
  };
  state.now.clear(), state.before.clear();
  for (const Impl::Surface& c : s.caged) {
    const uint32_t texel = c.bent ? s.jointTexel() + kJointTexels * c.joint : kObjectTexels * c.object;
    Subdivider::Surface surface = c.surface;
    surface.mirrored = mirrored(&s.now[texel]);
    state.now.push_back(surface);
    surface.mirrored = mirrored(&s.before[texel]);
    state.before.push_back(surface);
  }
}

void Animator::record(VkCommandBuffer cmd, uint32_t slot, gpu::Buffer& positions, gpu::Buffer& attributes,
                      gpu::Buffer& previous) {
  Impl& s = *impl_;
  constexpr auto kCompute = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
  constexpr auto kCopy = VK_PIPELINE_STAGE_2_COPY_BIT;
  if (!s.slots.at(slot).follows) {
    s.evaluate(cmd, slot, positions, attributes, true);
    gpu::memoryBarrier(cmd, kCompute, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT, kCopy | kCompute,
                       VK_ACCESS_2_TRANSFER_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_READ_BIT |
                           VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT);
  }
  const VkBufferCopy moving{s.firstVertex * sizeof(glm::vec4), 0, s.vertices * sizeof(glm::vec4)};
  vkCmdCopyBuffer(cmd, positions.handle(), previous.handle(), 1, &moving);
  gpu::memoryBarrier(cmd, kCopy, 0, kCompute, 0);
  s.evaluate(cmd, slot, positions, attributes, false);
}

}  // namespace fovea::scene
