#ifdef FOVEA_EMBREE
#include <embree3/rtcore.h>

#include <algorithm>
#include <cstring>
#include <string>
#include <utility>

#include "fovea/error.h"
#include "framework/base/threads.h"
#include "framework/scene/rays/ray_tracer.h"

namespace fovea::scene {
namespace {

struct DeviceDeleter {
  void operator()(RTCDevice d) const { rtcReleaseDevice(d); }
};
struct SceneDeleter {
  void operator()(RTCScene s) const { rtcReleaseScene(s); }
};

[[noreturn]] void fail(RTCError error, const std::string& what) {
  throwIfNoThreads();
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
  EmbreeTracer(const Geometry& geometry, Accepts accepts, TriangleRange range)
      : accepts_(std::move(accepts)), first_(range.first) {
    device_.reset(rtcNewDevice(nullptr));
    if (!device_) fail(rtcGetDeviceError(nullptr), "making a device");
    scene_.reset(rtcNewScene(device_.get()));
    // Robust mode lets no light through the edge that two triangles share.
    rtcSetSceneFlags(scene_.get(), RTC_SCENE_FLAG_ROBUST);
    const uint32_t end = std::min(range.end, uint32_t(geometry.triangles.size()));
    if (first_ < end) addTriangles(geometry, end);
    rtcCommitScene(scene_.get());
    if (const RTCError error = rtcGetDeviceError(device_.get()); error != RTC_ERROR_NONE)
      fail(error, "building the acceleration structure of " + std::to_string(end - first_) + " triangles");
  }

  RayHit intersect(const Ray& ray) const override {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRayHit query{};
    query.ray = embreeRay(ray);
    query.hit.geomID = query.hit.primID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene_.get(), &context, &query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
    return {first_ + query.hit.primID, query.ray.tfar, query.hit.u, query.hit.v};
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
      const unsigned triangle = self.first_ + RTCHitN_primID(args->hit, args->N, i);
      const float u = RTCHitN_u(args->hit, args->N, i), v = RTCHitN_v(args->hit, args->N, i);
      if (!self.accepts_(triangle, u, v)) args->valid[i] = 0;
    }
  }

  // Triangles [first_, end) and the vertices from the first to the last that they use.
  void addTriangles(const Geometry& geometry, uint32_t end) {
    uint32_t low = ~0u, high = 0;
    for (uint32_t t = first_; t < end; ++t)
      for (const uint32_t v : geometry.triangles[t].v) low = std::min(low, v), high = std::max(high, v);
    RTCGeometry mesh = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* positions = static_cast<float*>(rtcSetNewGeometryBuffer(
        mesh, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), size_t(high - low) + 1));
    auto* indices = static_cast<uint32_t*>(rtcSetNewGeometryBuffer(
        mesh, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(uint32_t), end - first_));
    if (positions == nullptr || indices == nullptr) {
      rtcReleaseGeometry(mesh);
      fail(rtcGetDeviceError(device_.get()), "a buffer for " + std::to_string(end - first_) + " triangles");
    }
    std::memcpy(positions, geometry.positions.data() + low, (size_t(high - low) + 1) * sizeof(glm::vec3));
    for (uint32_t t = first_; t < end; ++t)
      for (const uint32_t v : geometry.triangles[t].v) *indices++ = v - low;
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
  uint32_t first_;  // index in the geometry of Embree's triangle 0
  std::unique_ptr<RTCDeviceTy, DeviceDeleter> device_;
  std::unique_ptr<RTCSceneTy, SceneDeleter> scene_;
};

}  // namespace

std::unique_ptr<RayTracer> makeEmbreeTracer(const Geometry& geometry, RayTracer::Accepts accepts,
                                            TriangleRange range) {
  return std::make_unique<EmbreeTracer>(geometry, std::move(accepts), range);
}

}  // namespace fovea::scene
#endif
