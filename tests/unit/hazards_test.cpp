// Tests what accesses to the same memory wait for.
#include "framework/graph/compile/hazards.h"

#include <gtest/gtest.h>

namespace fovea::graph {
namespace {

const AccessScope kFill{VK_PIPELINE_STAGE_2_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT};
const AccessScope kRead{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_READ_BIT};

// The readers' barrier has made the first write available, so the second barrier names no access before it. The one
// after it has to be named: the two barriers are a dependency between the writes only with it.
TEST(Hazards, AWriteAfterReadersComesAfterTheEarlierWrite) {
  AccessHistory history;
  beforeWrite(history, kFill, false);
  const Dependency read = beforeRead(history, kRead);
  EXPECT_EQ(read.srcAccess, kFill.access);
  settle(history, read);
  const Dependency again = beforeWrite(history, kFill, false);
  EXPECT_EQ(again.srcStage, kRead.stage);
  EXPECT_EQ(again.dstStage, kFill.stage);
  EXPECT_EQ(again.srcAccess, VK_ACCESS_2_NONE);
  EXPECT_EQ(again.dstAccess, kFill.access);
}

TEST(Hazards, AWriteAfterReadersOfNothingWrittenIsAMatterOfOrder) {
  AccessHistory history;
  beforeRead(history, kRead);
  const Dependency write = beforeWrite(history, kFill, false);
  EXPECT_EQ(write.srcStage, kRead.stage);
  EXPECT_EQ(write.srcAccess | write.dstAccess, VK_ACCESS_2_NONE);
}

TEST(Hazards, TheFirstWriteWaitsForNothing) {
  AccessHistory history;
  EXPECT_FALSE(beforeWrite(history, kFill, false));
}

}  // namespace
}  // namespace fovea::graph
