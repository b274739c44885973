#ifdef FOVEA_EMBREE
#include <embree3/rtcore.h>

#include <algorithm>
#include <cstring>
#include <string>
#include <utility>

#include "framework/base/diagnostic.h"
#include "framework/scene/ray_tracer.h"

namespace fovea::scene {
namespace {

struct DeviceDeleter {
  void operator()(RTCDevice d) const { rtcReleaseDevice(d); }
};
struct SceneDeleter {
  void operator()(RTCScene s) const { rtcReleaseScene(s); }
};

[[noreturn]] void fail(RTCError error, const std::string& what) {
  const bool memory = error == RTC_ERROR_OUT_OF_MEMORY;
  throw Error(memory ? ExitCode::OutOfMemory : ExitCode::Internal,
              "ray tracing (Embree): " + what + " failed with error " + std::to_string(int(error)),
              memory ? "use a smaller scene or free memory" : "");
}

RTCRay embreeRay(const Ray& ray) {
  RTCRay r{};
  r.org_x = ray.origin.x, r.org_y = ray.origin.y, r.org_z = ray.origin.z;
  r.dir_x = ray.direction.x, r.dir_y = ray.direction.y, r.dir_z = ray.direction.z;
  r.tnear = ray.near, r.tfar = ray.far;
  r.mask = ~0u;
  return r;
}

class EmbreeTracer : public RayTracer {
 public:
  EmbreeTracer(const Geometry& geometry, Accepts accepts) : accepts_(std::move(accepts)) {
    device_.reset(rtcNewDevice(nullptr));
    if (!device_) fail(rtcGetDeviceError(nullptr), "making a device");
    scene_.reset(rtcNewScene(device_.get()));
    // Robust: no light through the edge that two triangles share.
    rtcSetSceneFlags(scene_.get(), RTC_SCENE_FLAG_ROBUST);
    if (!geometry.empty()) addTriangles(geometry);
    rtcCommitScene(scene_.get());
    if (const RTCError error = rtcGetDeviceError(device_.get()); error != RTC_ERROR_NONE)
      fail(error, "building the acceleration structure of " + std::to_string(geometry.triangles.size()) + " triangles");
  }

  RayHit intersect(const Ray& ray) const override {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRayHit query{};
    query.ray = embreeRay(ray);
    query.hit.geomID = query.hit.primID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene_.get(), &context, &query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
    return {query.hit.primID, query.ray.tfar, query.hit.u, query.hit.v};
  }

  bool occluded(const Ray& ray) const override {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRay query = embreeRay(ray);
    rtcOccluded1(scene_.get(), &context, &query);
    return query.tfar < 0;
  }

 private:
  static void filter(const RTCFilterFunctionNArguments* args) {
    const auto& self = *static_cast<const EmbreeTracer*>(args->geometryUserPtr);
    for (unsigned i = 0; i < args->N; ++i) {
      if (args->valid[i] != -1) continue;
      const unsigned triangle = RTCHitN_primID(args->hit, args->N, i);
      const float u = RTCHitN_u(args->hit, args->N, i), v = RTCHitN_v(args->hit, args->N, i);
      if (!self.accepts_(triangle, u, v)) args->valid[i] = 0;
    }
  }

  void addTriangles(const Geometry& geometry) {
    RTCGeometry mesh = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* positions = static_cast<float*>(rtcSetNewGeometryBuffer(
        mesh, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), geometry.positions.size()));
    auto* indices = static_cast<uint32_t*>(rtcSetNewGeometryBuffer(
        mesh, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(uint32_t), geometry.triangles.size()));
    if (positions == nullptr || indices == nullptr) {
      rtcReleaseGeometry(mesh);
      fail(rtcGetDeviceError(device_.get()), "a buffer for " + std::to_string(geometry.triangles.size()) + " triangles");
    }
    std::memcpy(positions, geometry.positions.data(), geometry.positions.size() * sizeof(glm::vec3));
    for (size_t t = 0; t < geometry.triangles.size(); ++t) std::copy_n(geometry.triangles[t].v, 3, indices + 3 * t);
    if (accepts_) {
      rtcSetGeometryUserData(mesh, this);
      rtcSetGeometryIntersectFilterFunction(mesh, &filter);
      rtcSetGeometryOccludedFilterFunction(mesh, &filter);
    }
    rtcCommitGeometry(mesh);
    rtcAttachGeometry(scene_.get(), mesh);
    rtcReleaseGeometry(mesh);
  }

  Accepts accepts_;
  std::unique_ptr<RTCDeviceTy, DeviceDeleter> device_;
  std::unique_ptr<RTCSceneTy, SceneDeleter> scene_;
};

}  // namespace

std::unique_ptr<RayTracer> makeEmbreeTracer(const Geometry& geometry, RayTracer::Accepts accepts) {
  return std::make_unique<EmbreeTracer>(geometry, std::move(accepts));
}

}  // namespace fovea::scene
#endif
