// Keys of caches: every byte counts, also in large arrays, which are hashed in four streams.
#include "framework/base/hash.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <vector>

namespace fovea {
namespace {

uint64_t hashOf(const std::vector<uint8_t>& bytes) {
  Hasher hash;
  hash.add(bytes);
  return hash.value();
}

TEST(Hash, EveryByteCounts) {
  for (const size_t size : {size_t(7), size_t(64), size_t(4095), size_t(4096), size_t(5003)}) {
    std::vector<uint8_t> bytes(size);
    std::set<uint64_t> seen{hashOf(bytes)};
    for (uint8_t& byte : bytes) {
      byte = 1;
      EXPECT_TRUE(seen.insert(hashOf(bytes)).second) << size;
      byte = 0;
    }
  }
}

TEST(Hash, ThePlaceCounts) {
  std::vector<uint8_t> bytes(8192);
  for (size_t i = 0; i < bytes.size(); ++i) bytes[i] = uint8_t(i * 37 + (i >> 8));
  const uint64_t first = hashOf(bytes);
  for (const size_t apart : {8, 16, 32, 64, 4096}) {
    std::vector<uint8_t> swapped = bytes;
    std::swap_ranges(swapped.begin(), swapped.begin() + 8, swapped.begin() + ptrdiff_t(apart));
    EXPECT_NE(hashOf(swapped), first) << apart;
  }
}

TEST(Hash, AnArrayIsNotItsNeighbour) {
  Hasher one, two;
  one.add(std::vector<uint8_t>(4096)), one.add(std::vector<uint8_t>(4097));
  two.add(std::vector<uint8_t>(4097)), two.add(std::vector<uint8_t>(4096));
  EXPECT_NE(one.value(), two.value());
}

}  // namespace
}  // namespace fovea
