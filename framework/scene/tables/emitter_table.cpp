#include "framework/scene/tables/emitter_table.h"

#include <bit>
#include <cstring>
#include <span>

#include "framework/scene/environment/environment_map.h"
#include "framework/scene/frame.h"
#include "framework/scene/lights.h"
#include "framework/scene/rays/emitters.h"
#include "shaders/records/emitters.h"

namespace fovea::scene {
namespace {

using Texels = std::vector<glm::uvec4>;

template <class Record>
void append(std::span<const Record> records, Texels& texels) {
  static_assert(sizeof(Record) % sizeof(glm::uvec4) == 0);
  if (records.empty()) return;
  const size_t first = texels.size();
  texels.resize(first + records.size_bytes() / sizeof(glm::uvec4));
  std::memcpy(texels.data() + first, records.data(), records.size_bytes());
}

}  // namespace

std::vector<glm::uvec4> emitterTable(const Scene& scene, const Geometry& geometry, bool fullMaterials) {
  Frame frame;
  frame.scene = &scene;
  frame.geometry = &geometry;
  frame.preExposure = preExposure(scene);
  const Emitters emitters(frame, fullMaterials);
  const std::vector<EmitterRecord> records = emitters.records();
  EmitterHeader header;
  header.count = uint32_t(records.size());
  Texels texels(1);
  append(std::span<const EmitterRecord>(records), texels);
  header.firstNode = uint32_t(texels.size());
  append(emitters.nodes(), texels);
  if (const EnvironmentMap* map = scene.environmentMap.get()) {
    header.firstMap = uint32_t(texels.size());
    std::vector<float> values = map->columns();
    values.insert(values.end(), map->rows().begin(), map->rows().end());
    values.resize((values.size() + 3) / 4 * 4);
    for (size_t i = 0; i < values.size(); i += 4)
      texels.emplace_back(std::bit_cast<uint32_t>(values[i]), std::bit_cast<uint32_t>(values[i + 1]),
                          std::bit_cast<uint32_t>(values[i + 2]), std::bit_cast<uint32_t>(values[i + 3]));
  }
  std::memcpy(texels.data(), &header, sizeof header);
  return texels;
}

}  // namespace fovea::scene
