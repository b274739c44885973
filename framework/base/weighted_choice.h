// A choice among things that are offered one after the other, each in proportion to its weight.
#pragma once

namespace fovea {

// One random number suffices, as it is rescaled after each decision.
class WeightedChoice {
 public:
  // u: uniform in [0, 1).
  explicit WeightedChoice(float u) : u_(u) {}

  // Whether what is offered now replaces what was chosen before. weight: above 0.
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
  // 1 over the probability of what was chosen; only if there is anything.
  float inverseProbability() const { return sum_ / chosen_; }

 private:
  float u_, sum_ = 0, chosen_ = 0;
};

}  // namespace fovea
