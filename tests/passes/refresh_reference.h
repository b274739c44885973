// A plain CPU version of how pass `shadow-atlas` chooses the maps that it draws.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "shaders/records/vpl.h"

namespace fovea::test {

// A plain version of the rule, over slots in order.
struct RefreshReference {
  std::vector<uint32_t> drawnIn;  // frame + 1; 0 if there is no map

  std::vector<bool> frame(const std::vector<scene::Vpl>& vpls, const std::vector<scene::VplState>& state,
                          uint32_t frame, double share, const std::string& policy) {
    drawnIn.resize(vpls.size());
    std::vector<bool> draw(vpls.size());
    std::vector<uint32_t> kept;
    for (uint32_t i = 0; i < vpls.size(); ++i) {
      if (vpls[i].intensity == glm::vec3(0))
        drawnIn[i] = 0;
      else if (state[i].life <= 1 || drawnIn[i] == 0)
        draw[i] = true;
      else
        kept.push_back(i);
    }
    const size_t budget = std::min(kept.size(), size_t(std::ceil(float(share) * float(kept.size()))));
    const size_t first = policy == "split" ? (budget + 1) / 2 : budget;
    auto choose = [&](size_t count, auto higher) {
      std::stable_sort(kept.begin(), kept.end(), higher);
      for (size_t k = 0; k < count; ++k) draw[kept[k]] = true;
      kept.erase(kept.begin(), kept.begin() + long(count));
      std::sort(kept.begin(), kept.end());
    };
    auto urgency = [&](uint32_t i) { return (state[i].importance + 0.05f) * float(frame + 1 - drawnIn[i]); };
    choose(first, [&](uint32_t a, uint32_t b) {
      return policy == "stale" ? urgency(a) > urgency(b) : state[a].importance > state[b].importance;
    });
    choose(budget - first, [&](uint32_t a, uint32_t b) { return drawnIn[a] < drawnIn[b]; });
    for (uint32_t i = 0; i < vpls.size(); ++i)
      if (draw[i]) drawnIn[i] = frame + 1;
    return draw;
  }
};

}  // namespace fovea::test
