// The session: its states and frames.
#include <cmath>

#include "tests/openxr/runtime.h"

namespace fovea::test {
namespace {

SessionState& current() { return *runtime().session; }

nlohmann::json jsonOf(const XrCompositionLayerProjectionView& view) {
  const XrQuaternionf& q = view.pose.orientation;
  const XrVector3f& p = view.pose.position;
  return {{"position", {p.x, p.y, p.z}},
          {"orientation", {q.x, q.y, q.z, q.w}},
          {"fov", {view.fov.angleLeft, view.fov.angleRight, view.fov.angleUp, view.fov.angleDown}}};
}

// Checks a layer, and takes its pictures.
XrResult show(const XrCompositionLayerProjection& layer, nlohmann::json& frame) {
  Runtime& r = runtime();
  SessionState& s = current();
  if (layer.viewCount != s.views) {
    r.violation("a layer has another number of views than the configuration");
    return XR_ERROR_VALIDATION_FAILURE;
  }
  if (!r.spaces.contains(reinterpret_cast<Space*>(layer.space))) return XR_ERROR_HANDLE_INVALID;
  for (uint32_t i = 0; i < layer.viewCount; ++i) {
    const XrCompositionLayerProjectionView& view = layer.views[i];
    auto* const chain = reinterpret_cast<Swapchain*>(view.subImage.swapchain);
    if (!r.swapchains.contains(chain)) return XR_ERROR_HANDLE_INVALID;
    if (chain->released < 0 || !chain->acquired.empty()) {
      r.violation("a layer shows an image that was not released");
      return XR_ERROR_LAYER_INVALID;
    }
    const XrRect2Di& rect = view.subImage.imageRect;
    if (rect.offset.x < 0 || rect.offset.y < 0 || rect.extent.width <= 0 || rect.extent.height <= 0 ||
        uint32_t(rect.offset.x + rect.extent.width) > chain->width ||
        uint32_t(rect.offset.y + rect.extent.height) > chain->height || view.subImage.imageArrayIndex != 0) {
      r.violation("a layer shows more than its image");
      return XR_ERROR_SWAPCHAIN_RECT_INVALID;
    }
    const XrQuaternionf& q = view.pose.orientation;
    if (std::abs(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w - 1) > 0.01f) return XR_ERROR_POSE_INVALID;
    frame["views"].push_back(jsonOf(view));
    if (!r.output.empty() && r.script.picturesEvery > 0 && s.submitted % r.script.picturesEvery == 0)
      r.write(*chain, s.submitted, i);
  }
  return XR_SUCCESS;
}

}  // namespace

XrResult createSession(XrInstance, const XrSessionCreateInfo* info, XrSession* session) {
  Runtime& r = runtime();
  if (const XrResult failed = r.scripted("xrCreateSession"); failed != XR_SUCCESS) return failed;
  if (r.session) return XR_ERROR_LIMIT_REACHED;
  const auto* binding = static_cast<const XrGraphicsBindingVulkan2KHR*>(info->next);
  if (!binding || binding->type != XR_TYPE_GRAPHICS_BINDING_VULKAN2_KHR)
    return XR_ERROR_GRAPHICS_DEVICE_INVALID;
  r.session = std::make_unique<SessionState>();
  SessionState& s = *r.session;
  s.device = binding->device;
  s.physical = binding->physicalDevice;
  s.queueFamily = binding->queueFamilyIndex;
  vkGetDeviceQueue(s.device, s.queueFamily, binding->queueIndex, &s.queue);
  s.display = 1'000'000'000;
  r.post(XR_SESSION_STATE_IDLE);
  r.post(XR_SESSION_STATE_READY);
  *session = handleOf<XrSession>(&s);
  return XR_SUCCESS;
}

XrResult destroySession(XrSession) {
  Runtime& r = runtime();
  if (!r.swapchains.empty()) r.violation("the session ends before its swapchains");
  for (Swapchain* chain : r.swapchains) {
    r.destroy(*chain);
    delete chain;
  }
  r.swapchains.clear();
  for (Space* space : r.spaces) delete space;
  r.spaces.clear();
  r.session.reset();
  r.events.clear();
  return XR_SUCCESS;
}

XrResult beginSession(XrSession, const XrSessionBeginInfo* info) {
  SessionState& s = current();
  if (s.running) return XR_ERROR_SESSION_RUNNING;
  if (s.state != XR_SESSION_STATE_READY) return XR_ERROR_SESSION_NOT_READY;
  const bool quad = info->primaryViewConfigurationType == XR_VIEW_CONFIGURATION_TYPE_PRIMARY_QUAD_VARJO;
  s.views = quad ? 4 : 2;
  if (s.views != runtime().script.views.size()) return XR_ERROR_VIEW_CONFIGURATION_TYPE_UNSUPPORTED;
  s.running = true;
  s.waited = s.begun = s.rendersNext = false;
  return XR_SUCCESS;
}

XrResult endSession(XrSession) {
  SessionState& s = current();
  if (!s.running) return XR_ERROR_SESSION_NOT_RUNNING;
  if (s.state != XR_SESSION_STATE_STOPPING) return XR_ERROR_SESSION_NOT_STOPPING;
  s.running = false;
  runtime().post(XR_SESSION_STATE_IDLE);
  runtime().post(s.exitAsked ? XR_SESSION_STATE_EXITING : XR_SESSION_STATE_READY);
  return XR_SUCCESS;
}

XrResult requestExitSession(XrSession) {
  SessionState& s = current();
  if (!s.running) return XR_ERROR_SESSION_NOT_RUNNING;
  s.exitAsked = true;
  if (s.state == XR_SESSION_STATE_FOCUSED) runtime().post(XR_SESSION_STATE_VISIBLE);
  if (s.state == XR_SESSION_STATE_VISIBLE) runtime().post(XR_SESSION_STATE_SYNCHRONIZED);
  runtime().post(XR_SESSION_STATE_STOPPING);
  return XR_SUCCESS;
}

XrResult waitFrame(XrSession, const XrFrameWaitInfo*, XrFrameState* state) {
  Runtime& r = runtime();
  SessionState& s = current();
  if (!s.running) return XR_ERROR_SESSION_NOT_RUNNING;
  if (s.waited) {
    r.violation("xrWaitFrame twice without xrBeginFrame");
    return XR_ERROR_CALL_ORDER_INVALID;
  }
  s.display += r.script.period;
  r.happen();
  ++s.waits;
  if (const XrResult failed = r.scripted("xrWaitFrame"); failed != XR_SUCCESS) return failed;
  s.waited = true;
  s.rendersNext = s.state == XR_SESSION_STATE_VISIBLE || s.state == XR_SESSION_STATE_FOCUSED;
  state->predictedDisplayTime = s.display;
  state->predictedDisplayPeriod = r.script.period;
  state->shouldRender = s.rendersNext;
  return XR_SUCCESS;
}

XrResult beginFrame(XrSession, const XrFrameBeginInfo*) {
  Runtime& r = runtime();
  SessionState& s = current();
  if (const XrResult failed = r.scripted("xrBeginFrame"); failed != XR_SUCCESS) return failed;
  if (!s.running) return XR_ERROR_SESSION_NOT_RUNNING;
  if (!s.waited) {
    r.violation("xrBeginFrame without xrWaitFrame");
    return XR_ERROR_CALL_ORDER_INVALID;
  }
  const bool discarded = s.begun;
  s.waited = false;
  s.begun = true;
  s.rendersThis = s.rendersNext;
  return discarded ? XR_FRAME_DISCARDED : XR_SUCCESS;
}

XrResult endFrame(XrSession, const XrFrameEndInfo* info) {
  Runtime& r = runtime();
  SessionState& s = current();
  if (const XrResult failed = r.scripted("xrEndFrame"); failed != XR_SUCCESS) return failed;
  if (!s.running) return XR_ERROR_SESSION_NOT_RUNNING;
  if (!s.begun) {
    r.violation("xrEndFrame without xrBeginFrame");
    return XR_ERROR_CALL_ORDER_INVALID;
  }
  s.begun = false;
  if (info->displayTime != s.display) r.violation("xrEndFrame with another time than xrWaitFrame predicted");
  if (info->environmentBlendMode != XR_ENVIRONMENT_BLEND_MODE_OPAQUE)
    return XR_ERROR_ENVIRONMENT_BLEND_MODE_UNSUPPORTED;
  nlohmann::json frame = {{"display_time", info->displayTime},
                          {"rendered", bool(s.rendersThis)},
                          {"views", nlohmann::json::array()}};
  if (info->layerCount > 0 && !s.rendersThis) r.violation("a layer in a frame that nobody sees");
  for (uint32_t i = 0; i < info->layerCount; ++i) {
    if (info->layers[i]->type != XR_TYPE_COMPOSITION_LAYER_PROJECTION) return XR_ERROR_LAYER_INVALID;
    const XrResult result =
        show(*reinterpret_cast<const XrCompositionLayerProjection*>(info->layers[i]), frame);
    if (result != XR_SUCCESS) return result;
  }
  r.frames.push_back(frame);
  if (info->layerCount > 0) ++s.submitted;
  if (s.state == XR_SESSION_STATE_READY) {  // the first frame: the application keeps pace
    r.post(XR_SESSION_STATE_SYNCHRONIZED);
    r.post(XR_SESSION_STATE_VISIBLE);
    r.post(XR_SESSION_STATE_FOCUSED);
  } else if (r.script.frames > 0 && s.submitted >= r.script.frames && s.state != XR_SESSION_STATE_STOPPING) {
    s.exitAsked = true;
    r.post(XR_SESSION_STATE_VISIBLE);
    r.post(XR_SESSION_STATE_SYNCHRONIZED);
    r.post(XR_SESSION_STATE_STOPPING);
  }
  return XR_SUCCESS;
}

}  // namespace fovea::test
