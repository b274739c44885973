// Tests that a file of the cache is used as it was written or not at all.
#include "framework/gpu/shader/disk_cache.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

namespace fovea::gpu {
namespace {

namespace fs = std::filesystem;

class DiskCache : public testing::Test {
 protected:
  void SetUp() override { ASSERT_TRUE(writeCacheFile(file_, payload_)); }
  void TearDown() override { fs::remove_all(folder_); }

  std::string content() const {
    std::ifstream in(file_, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  void replace(const std::string& content) const { std::ofstream(file_, std::ios::binary) << content; }

  const fs::path folder_ = fs::path(testing::TempDir()) / "fovea-disk-cache";
  const fs::path file_ = folder_ / "entry";
  const std::vector<std::byte> payload_{std::byte(7), std::byte(0), std::byte(255), std::byte(16)};
};

TEST_F(DiskCache, ReadsWhatWasWritten) {
  EXPECT_EQ(readCacheFile(file_), payload_);
  EXPECT_EQ(readCacheFile(folder_ / "another"), std::nullopt);
}

TEST_F(DiskCache, RefusesEveryFlippedBit) {
  const std::string whole = content();
  for (size_t bit = 0; bit < 8 * whole.size(); ++bit) {
    std::string damaged = whole;
    damaged[bit / 8] = char(damaged[bit / 8] ^ (1 << bit % 8));
    replace(damaged);
    EXPECT_EQ(readCacheFile(file_), std::nullopt) << "bit " << bit;
  }
}

TEST_F(DiskCache, RefusesEveryOtherLength) {
  const std::string whole = content();
  for (size_t bytes = 0; bytes < whole.size(); ++bytes) {
    replace(whole.substr(0, bytes));
    EXPECT_EQ(readCacheFile(file_), std::nullopt) << bytes << " bytes";
  }
  replace(whole + '\0');
  EXPECT_EQ(readCacheFile(file_), std::nullopt);
}

TEST_F(DiskCache, LeavesNothingElseBehind) {
  ASSERT_TRUE(writeCacheFile(file_, {}));
  EXPECT_EQ(readCacheFile(file_), std::vector<std::byte>{});
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 1);
}

}  // namespace
}  // namespace fovea::gpu
