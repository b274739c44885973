// Suites whose tests run twice, with rays on the host and on the device. A suite derives from WhereRaysRun and is
// instantiated with testing::Bool() and nameOfPlace; its tests run passes with RayPassTest.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "fovea/test.h"

namespace fovea::test {

// Parameter: whether rays run on the host.
class WhereRaysRun : public testing::TestWithParam<bool> {};

inline std::string nameOfPlace(const testing::TestParamInfo<bool>& test) {
  return test.param ? "Host" : "Device";
}

struct RayPassTest : PassTest {
  explicit RayPassTest(const char* type) : PassTest(type) { raysOnHost(WhereRaysRun::GetParam()); }
};

}  // namespace fovea::test
