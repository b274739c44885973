// Writes the pictures of a failed comparison to files.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace fovea::test {

// Writes SUITE.TEST-picture.png, -reference.png and -error.png (as displayed at `exposure`) into the folder
// fovea-failures among the temporary files, or FOVEA_FAILURES, and says so. RGBA radiance, rows of `width`.
// At the end of a test:
//   if (HasFailure()) ADD_FAILURE() << failurePictures(got, wanted, side, scene.exposure);
std::string failurePictures(const std::vector<float>& picture, const std::vector<float>& reference,
                            uint32_t width, float exposure);

}  // namespace fovea::test
