// Where head, eyes and gaze are, and what hands do, at the time at which a frame is seen.
#pragma once

#include "samples/fovea/vr/rig.h"
#include "samples/fovea/vr/session.h"

namespace fovea::vr {

class Tracking {
 public:
  // stage: whether the origin is on the floor of the room, instead of where the head was at first. Throws
  // Error(NoDevice) if the headset does not know the floor.
  Tracking(const Runtime& runtime, const Session& session, XrViewConfigurationType configuration, bool stage);
  ~Tracking();
  Tracking(const Tracking&) = delete;
  Tracking& operator=(const Tracking&) = delete;

  XrSpace room() const { return room_; }
  Tracked at(XrTime time);
  // As the runtime gave them, for the layer that shows the pictures made from them.
  const std::vector<XrView>& views() const { return views_; }

 private:
  void createActions();
  void suggest(const char* profile, const std::vector<std::pair<XrAction, const char*>>& bindings) const;
  XrAction action(XrActionType type, const char* name, const char* doc) const;
  glm::vec2 stick(XrAction action) const;

  const Runtime& runtime_;
  const Session& session_;
  XrViewConfigurationType configuration_;
  XrSpace room_ = XR_NULL_HANDLE, head_ = XR_NULL_HANDLE, gazeSpace_ = XR_NULL_HANDLE;
  XrActionSet actions_ = XR_NULL_HANDLE;
  XrAction walk_ = XR_NULL_HANDLE, turn_ = XR_NULL_HANDLE, gaze_ = XR_NULL_HANDLE;
  std::vector<XrView> views_;
};

}  // namespace fovea::vr
