#include "tests/support/failure_pictures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <exception>
#include <filesystem>

#include "framework/image/error_picture.h"

namespace fovea::test {

std::string failurePictures(const std::vector<float>& picture, const std::vector<float>& reference,
                            uint32_t width, float exposure) {
  const uint32_t height = uint32_t(reference.size() / 4 / width);
  const auto shown = [&](const std::vector<float>& rgba) {
    return image::fromRadiance({width, height, 4, rgba}, exposure);
  };
  try {
    const char* chosen = std::getenv("FOVEA_FAILURES");
    const std::filesystem::path folder =
        chosen ? std::filesystem::path(chosen) : std::filesystem::temp_directory_path() / "fovea-failures";
    std::filesystem::create_directories(folder);
    const testing::TestInfo& test = *testing::UnitTest::GetInstance()->current_test_info();
    std::string name = std::string(test.test_suite_name()) + "." + test.name();
    std::replace(name.begin(), name.end(), '/', '-');  // of parameterised tests
    const image::Picture a = shown(picture), b = shown(reference);
    image::write(folder / (name + "-picture.png"), {{"", a.display}});
    image::write(folder / (name + "-reference.png"), {{"", b.display}});
    image::write(folder / (name + "-error.png"),
                 {{"", image::errorPicture(image::pixelErrors(a, b), width, 0.1)}});
    return "pictures: " + (folder / name).string() + "-{picture,reference,error}.png";
  } catch (const std::exception& e) {  // a NaN, or a full disk: the comparison's own failure matters more
    return std::string("no pictures: ") + e.what();
  }
}

}  // namespace fovea::test
