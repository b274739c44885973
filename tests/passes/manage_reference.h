// The management of VPLs as a plain serial algorithm (passes/vpls.md, manage); pass manage must give the same bits.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "framework/base/random.h"
#include "shaders/records/vpl.h"

namespace fovea::test {

struct ManageSettings {
  std::string reuse = "linear", order = "literal";
  uint32_t keep = 0, limit = 0, maxDensity = 0;
  double densityConstant = 1, cell = 1.0 / 48;
  std::string placement = "importance";
  double lightFloor = 0.25, turnover = 1, changeTurnover = 0, saccadeTurnover = 0, randomShare = 0;
};

struct ManageInput {
  std::vector<scene::Candidate> candidates;
  std::vector<float> candidateImportance;
  std::vector<scene::VplState> vpls;
  std::vector<float> vplImportance;
  uint32_t seed = 1, frame = 0;
  glm::vec3 boundsMin{0}, boundsMax{1};
  float exposure = 1, saccade = 0, lost = 0;
};

struct ManageOutput {
  std::vector<scene::VplState> vpls;
  uint32_t kept = 0, deleted = 0, added = 0, candidates = 0, rejected = 0, alive = 0, dense = 0;
};

inline constexpr uint32_t kManageStream = 0x6d616e61u, kThinStream = 0x7468696eu;

inline uint32_t importance24(float importance) {
  if (!(importance > 0)) return 0;
  return std::min(uint32_t(std::min(double(importance), 1.0) * 0x1p24), 0xffffffu);
}

// 2^24 (1 - cos(pi/2 x)), x in units of 2^-24, x < 2^24: six terms of the power series in fixed point.
inline uint32_t cosineProbability24(uint64_t x) {
  const uint64_t coefficients[] = {423, 15423, 350031, 4255868, 20698061};
  const uint64_t y = x * x >> 24;
  uint64_t p = 8;
  for (uint64_t c : coefficients) p = c - (y * p >> 24);
  return uint32_t(y * p >> 24);
}

class ManageReference {
 public:
  ManageReference(const ManageSettings& settings, const ManageInput& input) : s_(settings), in_(input) {
    limit_ = s_.limit > 0 ? std::min<size_t>(s_.limit, in_.vpls.size()) : in_.vpls.size();
    alive_.resize(in_.vpls.size());
    stays_.resize(in_.vpls.size());
    for (size_t i = 0; i < in_.vpls.size(); ++i) alive_[i] = in_.vpls[i].life > 0;
  }

  ManageOutput run() {
    for (size_t i = 0; i < in_.candidates.size(); ++i)
      if (in_.candidates[i].side != scene::kNoSide) valid_.push_back(uint32_t(i));
    out_.candidates = uint32_t(valid_.size());
    reuse();
    algorithm2(thin());
    return fill();
  }

 private:
  uint32_t oldImportance(uint32_t slot) const { return importance24(in_.vplImportance[slot]); }
  uint32_t newImportance(uint32_t i) const {
    if (s_.placement == "light") return importance24(in_.candidates[i].luminance * in_.exposure * 0.015625f);
    return importance24(in_.candidateImportance[i]);
  }
  uint32_t random(uint32_t slot, uint32_t draw) const {
    return hashCombine(randomStream(in_.seed, in_.frame, kManageStream, slot), draw) >> 8;
  }
  uint32_t total() const { return out_.kept + uint32_t(added_.size()); }

  // Cells repeat every 64.
  uint32_t cellOf(glm::vec3 position) const {
    const float perMetre = 1.0f / (float(s_.cell) * glm::length(in_.boundsMax - in_.boundsMin));
    const glm::vec3 p = (position - in_.boundsMin) * perMetre;
    uint32_t cell = 0;
    for (int axis = 0; axis < 3; ++axis)
      if (p[axis] > -1e6f && p[axis] < 1e6f) cell |= (uint32_t(int(std::floor(p[axis]))) & 63u) << 6 * axis;
    return cell;
  }
  uint32_t cellOfVpl(uint32_t slot) const { return cellOf(in_.vpls[slot].position); }
  uint32_t cellOfCandidate(uint32_t i) const { return cellOf(in_.candidates[i].position); }

  bool acceptedByEq1(uint32_t slot) const {
    const uint64_t now = oldImportance(slot), before = importance24(in_.vpls[slot].previousImportance);
    const uint64_t u = random(slot, 0);
    if (s_.reuse == "cosine" && now < before) return u < cosineProbability24((now << 24) / before);
    return u * before < now << 24;
  }

  // VPLs that lose their place because light is lost.
  size_t outdated() const {
    return size_t(float(s_.changeTurnover) * in_.lost * in_.lost * float(alive_.size()));
  }

  // Most VPLs that may be deleted for failing Eq. 1.
  size_t mostRejected() const {
    return std::max(size_t(std::ceil(s_.turnover * double(alive_.size()))), outdated());
  }

  void reuse() {
    std::vector<uint32_t> order;
    uint32_t accepted = 0;
    const bool random = s_.reuse == "random";
    for (uint32_t slot = 0; slot < alive_.size(); ++slot) {
      if (!alive_[slot]) continue;
      const bool passed = acceptedByEq1(slot);
      accepted += passed;
      out_.rejected += !passed;
      if (passed || random) order.push_back(slot);
    }
    const size_t most = mostRejected();
    const bool limited = most < alive_.size();
    if (limited && !random) {  // those that failed after those that passed, the most important first
      for (uint32_t slot = 0; slot < alive_.size(); ++slot)
        if (alive_[slot] && !acceptedByEq1(slot)) order.push_back(slot);
      std::stable_sort(order.begin(), order.end());
    }
    const auto key = [&](uint32_t slot) {
      return (0xffffffu - oldImportance(slot)) >> 1 | (acceptedByEq1(slot) ? 0u : 0x800000u);
    };
    const size_t alive = size_t(std::count(alive_.begin(), alive_.end(), true));
    accepted = uint32_t(std::max<size_t>(accepted, alive - std::min(alive, most)));
    if (random && s_.randomShare > 0)
      accepted = uint32_t(std::floor(double(alive) * std::round(s_.randomShare * 1024) / 1024 + 0.5));
    std::stable_sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
      if (limited && !random) return key(a) < key(b);
      return random ? this->random(a, 1) < this->random(b, 1) : oldImportance(a) > oldImportance(b);
    });
    const double contested = std::ceil(s_.saccadeTurnover * in_.saccade * double(alive_.size()));
    const size_t reused = std::min<size_t>(accepted, limit_);
    order.resize(std::min(reused - std::min(reused, size_t(contested)), alive - std::min(alive, outdated())));
    for (uint32_t slot : order) stay(slot);
  }

  void stay(uint32_t slot) {
    stays_[slot] = true;
    ++density_[cellOfVpl(slot)];
    ++out_.kept;
  }

  // Inverse of the CDF at K equidistant points with a common random offset.
  std::vector<uint32_t> thin() const {
    const bool light = s_.placement == "light";
    const uint64_t keep = s_.keep > 0 ? s_.keep : light ? limit_ - out_.kept : limit_;
    uint64_t sum = 0, cdf = 0;
    for (uint32_t i : valid_) sum += newImportance(i);
    uint64_t floor = 0;
    if (light && !valid_.empty())
      floor = sum > 0 ? sum * uint64_t(std::lround(64 * s_.lightFloor)) / (64 * valid_.size()) : 1;
    sum += floor * valid_.size();
    std::vector<uint32_t> chosen;
    if (sum == 0) return chosen;
    const uint64_t start = sum * (randomStream(in_.seed, in_.frame, kThinStream, 0) >> 8) >> 24;
    uint64_t sample = sum - start;  // next sample on [0, K sum); candidate i covers (K cdf, K (cdf + I)]
    for (uint32_t i : valid_) {
      cdf += newImportance(i) + floor;
      if (sample > keep * cdf) continue;
      chosen.push_back(i);
      while (sample <= keep * cdf) sample += sum;
    }
    return chosen;
  }

  uint32_t weight(uint32_t importance, uint32_t cell) {
    const uint32_t constant64ths = uint32_t(std::lround(64 * s_.densityConstant));
    return (importance + (1u << 30) / (64 * density_[cell] + constant64ths)) >> 2;
  }

  uint32_t densityLimit() const {
    if (s_.maxDensity > 0) return s_.maxDensity;
    std::map<uint32_t, int> cells;
    for (uint32_t slot = 0; slot < alive_.size(); ++slot)
      if (alive_[slot]) ++cells[cellOfVpl(slot)];
    for (uint32_t i : valid_) ++cells[cellOfCandidate(i)];
    if (cells.empty()) return 2;
    return std::max<uint32_t>(2, uint32_t((3 * limit_ + cells.size() - 1) / cells.size()));
  }

  // Whether there is room in the list and in the cell.
  bool room(uint32_t cell, uint32_t densityLimit) {
    if (total() >= limit_) return false;
    if (density_[cell] < densityLimit) return true;
    ++out_.dense;
    return false;
  }

  void algorithm2(const std::vector<uint32_t>& fresh) {
    struct Entry {
      uint32_t index, weight;
    };
    std::vector<Entry> lc, lo;
    for (uint32_t i : fresh) lc.push_back({i, weight(newImportance(i), cellOfCandidate(i))});
    for (uint32_t slot = 0; slot < alive_.size(); ++slot)
      if (s_.placement != "light" && alive_[slot] && !stays_[slot])
        lo.push_back({slot, weight(oldImportance(slot), cellOfVpl(slot))});
    std::stable_sort(lc.begin(), lc.end(),
                     [](const Entry& a, const Entry& b) { return a.weight > b.weight; });
    std::stable_sort(lo.begin(), lo.end(),
                     [](const Entry& a, const Entry& b) { return a.weight < b.weight; });

    const uint32_t most = densityLimit();
    auto addFresh = [&](uint32_t i) {
      if (!room(cellOfCandidate(i), most)) return;
      ++density_[cellOfCandidate(i)];
      added_.push_back(i);
    };
    auto addOld = [&](uint32_t slot) {
      if (room(cellOfVpl(slot), most)) stay(slot);
    };
    const size_t pairs = std::min(lc.size(), lo.size());
    for (size_t j = 0; j < pairs; ++j) {
      if (lc[j].weight > lo[j].weight)
        addFresh(lc[j].index);
      else
        addOld(lo[j].index);
    }
    for (size_t j = pairs; j < lc.size(); ++j) addFresh(lc[j].index);
    if (s_.order == "fixed")
      for (size_t j = lo.size(); j > pairs; --j) addOld(lo[j - 1].index);
  }

  ManageOutput fill() {
    size_t next = 0;
    out_.vpls.resize(in_.vpls.size());
    for (uint32_t slot = 0; slot < alive_.size(); ++slot) {
      scene::VplState& vpl = out_.vpls[slot];
      out_.deleted += alive_[slot] && !stays_[slot];
      if (stays_[slot]) {
        vpl = in_.vpls[slot];
        const bool limited = mostRejected() < alive_.size();
        vpl.importance =
            limited && !acceptedByEq1(slot) ? in_.vpls[slot].previousImportance : in_.vplImportance[slot];
      } else if (next < added_.size()) {
        const uint32_t i = added_[next++];
        const scene::Candidate& c = in_.candidates[i];
        vpl.position = c.position;
        vpl.normal = vpl.localNormal = c.normal;
        vpl.importance = vpl.previousImportance = in_.candidateImportance[i];
        vpl.life = 1;
        vpl.reflectance = c.reflectance;
        vpl.side = c.side;
        vpl.localPosition = c.localPosition;
        vpl.object = c.object;
      }
    }
    out_.added = uint32_t(added_.size());
    out_.alive = total();
    return out_;
  }

  const ManageSettings& s_;
  const ManageInput& in_;
  size_t limit_;
  std::vector<bool> alive_, stays_;
  std::vector<uint32_t> valid_, added_;
  std::map<uint32_t, uint32_t> density_;
  ManageOutput out_;
};

}  // namespace fovea::test
