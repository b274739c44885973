// Reads cameras. Values that no camera can have are replaced, with a warning, since the rest of the model does not
// depend on them.
#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "framework/scene/gltf/internal.h"

namespace fovea::scene::gltf {
namespace {

constexpr double kLeastFov = 1e-3, kMostFov = 3.14159;  // radians
constexpr double kLeastNear = 1e-6, kMostAspect = 1e3;

class CameraReader {
 public:
  CameraReader(const Context& c, const json::Value& perspective, std::string place)
      : c_(c), perspective_(perspective), place_(std::move(place)) {}

  void read(Camera& camera) {
    const double yfov = number("yfov");
    camera.verticalFov = float(yfov);
    if (!(yfov >= kLeastFov && yfov <= kMostFov)) {
      camera.verticalFov = Camera{}.verticalFov;
      replace("yfov", "a vertical field of view lies between 0 and pi radians",
              fmt::format("{:.2g} radians are used", camera.verticalFov));
    }
    planes(camera);
    if (!perspective_.find("aspectRatio")) return;
    const double aspect = number("aspectRatio");
    if (aspect >= 1 / kMostAspect && aspect <= kMostAspect)
      camera.aspectRatio = float(aspect);
    else
      replace("aspectRatio",
              fmt::format("a picture's width over its height lies between {:g} and {:g}", 1 / kMostAspect,
                          kMostAspect),
              "it is ignored");
  }

 private:
  // 0 if it is missing, which no member may be.
  double number(std::string_view key) const {
    const json::Value* v = perspective_.find(key);
    return v ? v->real : 0;
  }

  void replace(std::string_view key, const std::string& rule, const std::string& instead) const {
    const json::Value* v = perspective_.find(key);
    c_.warn(json::joinPath(place_, key),
            fmt::format("{}, but it is {}: {}", rule, v ? fmt::format("{:g}", v->real) : "missing", instead));
  }

  void planes(Camera& camera) const {
    double near = number("znear"), far = std::max(number("zfar"), 0.0);
    if (number("zfar") < 0 || (perspective_.find("zfar") && far == 0))
      replace("zfar", "the far plane lies before the camera", "the size of the scene decides");
    if (!(near >= kLeastNear)) {
      const double instead = far > 0 ? std::max(1e-4 * far, kLeastNear) : double(Camera{}.zNear);
      replace("znear", fmt::format("the near plane lies at least {:g} m before the camera", kLeastNear),
              fmt::format("{:g} m are used", instead));
      near = instead;
    }
    if (far > 0 && far <= near) {
      c_.warn(json::joinPath(place_, "zfar"),
              fmt::format("zfar ({:g}) has to be greater than znear ({:g}): {}", far, near,
                          far < near && far >= kLeastNear ? "the two are exchanged"
                                                          : "the size of the scene decides on zfar"));
      if (far < near && far >= kLeastNear)
        std::swap(near, far);
      else
        far = 0;
    }
    camera.zNear = float(near);
    camera.zFar = float(far);
    if (!(camera.zFar > camera.zNear)) camera.zFar = 0;
  }

  const Context& c_;
  const json::Value& perspective_;
  std::string place_;
};

}  // namespace

bool isOrthographic(const json::Value& camera) {
  const json::Value* type = camera.find("type");
  return type && type->string == "orthographic";
}

std::vector<Camera> readCameras(const Context& c) {
  std::vector<Camera> cameras;
  const json::Value* list = c.root.find("cameras");
  for (size_t i = 0; list && i < list->items.size(); ++i) {
    const json::Value& from = list->items[i];
    const json::Value* name = from.find("name");
    Camera& camera = cameras.emplace_back();
    camera.name = name && !name->string.empty() ? name->string : "camera " + std::to_string(i);
    if (isOrthographic(from)) continue;
    static const json::Value kNothing = json::parse("{}", "camera");
    const json::Value* perspective = from.find("perspective");
    CameraReader(c, perspective ? *perspective : kNothing,
                 nameOf("cameras", i, name ? name->string : "") + ".perspective")
        .read(camera);
  }
  return cameras;
}

void warnOfOrthographic(const Context& c) {
  const json::Value* list = c.root.find("cameras");
  for (size_t i = 0; list && i < list->items.size(); ++i) {
    if (!isOrthographic(list->items[i])) continue;
    const json::Value* name = list->items[i].find("name");
    c.warn(nameOf("cameras", i, name ? name->string : ""),
           "orthographic cameras are not supported: " +
               (c.scene.cameras.empty()
                    ? "a camera is chosen instead, unless the scene file has one"
                    : "the model's camera `" + c.scene.cameras[0].name + "` is used instead"));
  }
}

}  // namespace fovea::scene::gltf
