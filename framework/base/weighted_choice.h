// Weighted reservoir sampling: chooses one of several items that are offered one after the other, in proportion to
// their weights.
#pragma once

namespace fovea {

// One random number suffices, as it is rescaled after each decision.
class WeightedChoice {
 public:
  // u: uniform in [0, 1).
  explicit WeightedChoice(float u) : u_(u) {}

  // Whether the item offered now replaces the one chosen before. weight: above 0.
  bool takes(float weight) {
    sum_ += weight;
    const float chance = weight / sum_;
    if (u_ < chance) {
      u_ /= chance;
      chosen_ = weight;
      return true;
    }
    u_ = (u_ - chance) / (1.0f - chance);
    return false;
  }
  bool any() const { return sum_ > 0; }
  // 1 over the probability of the chosen item; only if an item was offered.
  float inverseProbability() const { return sum_ / chosen_; }

 private:
  float u_, sum_ = 0, chosen_ = 0;
};

}  // namespace fovea
