#include "samples/fovea/vr/tracking.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

namespace fovea::vr {
namespace {

Pose poseOf(const XrPosef& pose) {
  const XrVector3f& p = pose.position;
  const XrQuaternionf& q = pose.orientation;
  return {{p.x, p.y, p.z}, glm::quat(q.w, q.x, q.y, q.z)};
}

XrPosef identity() { return {{0, 0, 0, 1}, {0, 0, 0}}; }

XrSpace referenceSpace(XrSession session, XrReferenceSpaceType type) {
  XrReferenceSpaceCreateInfo info{XR_TYPE_REFERENCE_SPACE_CREATE_INFO};
  info.referenceSpaceType = type;
  info.poseInReferenceSpace = identity();
  XrSpace space = XR_NULL_HANDLE;
  check(xrCreateReferenceSpace(session, &info, &space), "asking for a space of the headset");
  return space;
}

bool knowsFloor(XrSession session) {
  uint32_t count = 0;
  check(xrEnumerateReferenceSpaces(session, 0, &count, nullptr), "asking for the spaces of the headset");
  std::vector<XrReferenceSpaceType> types(count);
  check(xrEnumerateReferenceSpaces(session, count, &count, types.data()),
        "asking for the spaces of the headset");
  return std::ranges::find(types, XR_REFERENCE_SPACE_TYPE_STAGE) != types.end();
}

bool orientated(XrSpaceLocationFlags flags) { return flags & XR_SPACE_LOCATION_ORIENTATION_VALID_BIT; }
bool placed(XrSpaceLocationFlags flags) { return flags & XR_SPACE_LOCATION_POSITION_VALID_BIT; }

}  // namespace

Tracking::Tracking(const Runtime& runtime, const Session& session, XrViewConfigurationType configuration,
                   bool stage)
    : runtime_(runtime), session_(session), configuration_(configuration) {
  if (stage && !knowsFloor(session.handle()))
    throw Error(ExitCode::NoDevice, "the headset does not know where the floor is",
                "set up its room, or leave out --floor");
  room_ =
      referenceSpace(session.handle(), stage ? XR_REFERENCE_SPACE_TYPE_STAGE : XR_REFERENCE_SPACE_TYPE_LOCAL);
  head_ = referenceSpace(session.handle(), XR_REFERENCE_SPACE_TYPE_VIEW);
  createActions();
  views_.assign(runtime.views(configuration).size(), {XR_TYPE_VIEW});
}

// Spaces end with the session.
Tracking::~Tracking() { xrDestroyActionSet(actions_); }

XrAction Tracking::action(XrActionType type, const char* name, const char* doc) const {
  XrActionCreateInfo info{XR_TYPE_ACTION_CREATE_INFO};
  info.actionType = type;
  std::strncpy(info.actionName, name, XR_MAX_ACTION_NAME_SIZE - 1);
  std::strncpy(info.localizedActionName, doc, XR_MAX_LOCALIZED_ACTION_NAME_SIZE - 1);
  XrAction made = XR_NULL_HANDLE;
  check(xrCreateAction(actions_, &info, &made), "describing what hands do");
  return made;
}

// A runtime need not know every device.
void Tracking::suggest(const char* profile,
                       const std::vector<std::pair<XrAction, const char*>>& bindings) const {
  std::vector<XrActionSuggestedBinding> list;
  for (const auto& [action, path] : bindings) list.push_back({action, runtime_.path(path)});
  XrInteractionProfileSuggestedBinding info{XR_TYPE_INTERACTION_PROFILE_SUGGESTED_BINDING};
  info.interactionProfile = runtime_.path(profile);
  info.countSuggestedBindings = uint32_t(list.size());
  info.suggestedBindings = list.data();
  const XrResult result = xrSuggestInteractionProfileBindings(runtime_.instance(), &info);
  if (result != XR_ERROR_PATH_UNSUPPORTED) check(result, std::string("describing ") + profile);
}

void Tracking::createActions() {
  XrActionSetCreateInfo info{XR_TYPE_ACTION_SET_CREATE_INFO};
  std::strncpy(info.actionSetName, "fovea", XR_MAX_ACTION_SET_NAME_SIZE - 1);
  std::strncpy(info.localizedActionSetName, "fovea", XR_MAX_LOCALIZED_ACTION_SET_NAME_SIZE - 1);
  check(xrCreateActionSet(runtime_.instance(), &info, &actions_), "describing what hands do");
  walk_ = action(XR_ACTION_TYPE_VECTOR2F_INPUT, "walk", "Fly forwards and sideways");
  turn_ = action(XR_ACTION_TYPE_VECTOR2F_INPUT, "turn", "Turn, rise and sink");
  for (const char* profile :
       {"/interaction_profiles/oculus/touch_controller", "/interaction_profiles/valve/index_controller",
        "/interaction_profiles/microsoft/motion_controller"})
    suggest(profile,
            {{walk_, "/user/hand/left/input/thumbstick"}, {turn_, "/user/hand/right/input/thumbstick"}});
  suggest("/interaction_profiles/htc/vive_controller",
          {{walk_, "/user/hand/left/input/trackpad"}, {turn_, "/user/hand/right/input/trackpad"}});
  if (runtime_.tracksGaze()) {
    gaze_ = action(XR_ACTION_TYPE_POSE_INPUT, "gaze", "Where the eyes look");
    suggest("/interaction_profiles/ext/eye_gaze_interaction",
            {{gaze_, "/user/eyes_ext/input/gaze_ext/pose"}});
    XrActionSpaceCreateInfo space{XR_TYPE_ACTION_SPACE_CREATE_INFO};
    space.action = gaze_;
    space.poseInActionSpace = identity();
    check(xrCreateActionSpace(session_.handle(), &space, &gazeSpace_), "asking for the gaze");
  }
  XrSessionActionSetsAttachInfo attach{XR_TYPE_SESSION_ACTION_SETS_ATTACH_INFO};
  attach.countActionSets = 1;
  attach.actionSets = &actions_;
  check(xrAttachSessionActionSets(session_.handle(), &attach), "describing what hands do");
}

glm::vec2 Tracking::stick(XrAction action) const {
  XrActionStateGetInfo info{XR_TYPE_ACTION_STATE_GET_INFO};
  info.action = action;
  XrActionStateVector2f state{XR_TYPE_ACTION_STATE_VECTOR2F};
  check(xrGetActionStateVector2f(session_.handle(), &info, &state), "asking what hands do");
  return state.isActive ? glm::vec2(state.currentState.x, state.currentState.y) : glm::vec2(0);
}

Tracked Tracking::at(XrTime time) {
  Tracked tracked;
  const XrActiveActionSet active{actions_, XR_NULL_PATH};
  XrActionsSyncInfo sync{XR_TYPE_ACTIONS_SYNC_INFO};
  sync.countActiveActionSets = 1;
  sync.activeActionSets = &active;
  check(xrSyncActions(session_.handle(), &sync), "asking what hands do");
  tracked.walk = stick(walk_);
  tracked.turn = stick(turn_);

  XrSpaceLocation head{XR_TYPE_SPACE_LOCATION};
  check(xrLocateSpace(head_, room_, time, &head), "asking where the head is");
  XrViewLocateInfo info{XR_TYPE_VIEW_LOCATE_INFO};
  info.viewConfigurationType = configuration_;
  info.displayTime = time;
  info.space = room_;
  XrViewState state{XR_TYPE_VIEW_STATE};
  uint32_t count = 0;
  check(xrLocateViews(session_.handle(), &info, &state, uint32_t(views_.size()), &count, views_.data()),
        "asking where the eyes are");
  constexpr XrViewStateFlags kKnown = XR_VIEW_STATE_ORIENTATION_VALID_BIT | XR_VIEW_STATE_POSITION_VALID_BIT;
  if (!orientated(head.locationFlags) || !placed(head.locationFlags) ||
      (state.viewStateFlags & kKnown) != kKnown)
    return tracked;
  tracked.head = poseOf(head.pose);
  for (const XrView& view : views_) {
    tracked.eyes.push_back(poseOf(view.pose));
    tracked.frusta.push_back({-std::tan(view.fov.angleLeft), std::tan(view.fov.angleRight),
                              std::tan(view.fov.angleUp), -std::tan(view.fov.angleDown)});
  }
  if (!gazeSpace_) return tracked;
  XrActionStateGetInfo wanted{XR_TYPE_ACTION_STATE_GET_INFO};
  wanted.action = gaze_;
  XrActionStatePose there{XR_TYPE_ACTION_STATE_POSE};
  check(xrGetActionStatePose(session_.handle(), &wanted, &there), "asking for the gaze");
  if (!there.isActive) return tracked;
  XrEyeGazeSampleTimeEXT sample{XR_TYPE_EYE_GAZE_SAMPLE_TIME_EXT};
  XrSpaceLocation gaze{XR_TYPE_SPACE_LOCATION, &sample};
  check(xrLocateSpace(gazeSpace_, room_, time, &gaze), "asking for the gaze");
  if (!orientated(gaze.locationFlags)) return tracked;
  tracked.gaze = poseOf(gaze.pose).orientation * glm::vec3(0, 0, -1);
  tracked.gazeTime = sample.time;
  return tracked;
}

}  // namespace fovea::vr
