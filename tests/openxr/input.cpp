// Spaces, actions and views: where the scripted head, eyes and hands are.
#include <cmath>
#include <cstring>

#include "tests/openxr/runtime.h"

namespace fovea::test {
namespace {

char onlySet = 0;  // the address of the only action set

constexpr XrSpaceLocationFlags kTracked =
    XR_SPACE_LOCATION_ORIENTATION_VALID_BIT | XR_SPACE_LOCATION_POSITION_VALID_BIT |
    XR_SPACE_LOCATION_ORIENTATION_TRACKED_BIT | XR_SPACE_LOCATION_POSITION_TRACKED_BIT;
constexpr float kFloor = -1.6f;  // of the stage, in the local space

double secondsAt(XrTime time) { return double(time) * 1e-9 - 1; }

Place operator*(const Place& a, const Place& b) {
  return {a.position + a.orientation * b.position, a.orientation * b.orientation};
}

// A place of the local space in terms of another one that does not turn.
Place in(const Space& space, Place place) {
  if (space.kind == Space::Kind::Stage) place.position.y -= kFloor;
  return place;
}

bool isSpace(XrSpace space) { return runtime().spaces.contains(reinterpret_cast<Space*>(space)); }
const Space& spaceOf(XrSpace space) { return *reinterpret_cast<Space*>(space); }
bool isAction(XrAction action) { return runtime().actions.contains(reinterpret_cast<Action*>(action)); }
const Action& actionOf(XrAction action) { return *reinterpret_cast<Action*>(action); }

bool bound(const Action& action, const std::string& part) {
  for (const std::string& path : action.paths)
    if (path.find(part) != std::string::npos) return true;
  return false;
}

XrResult makeSpace(Space::Kind kind, XrSpace* space) {
  auto* made = new Space{kind};
  runtime().spaces.insert(made);
  *space = handleOf<XrSpace>(made);
  return XR_SUCCESS;
}

}  // namespace

XrResult enumerateReferenceSpaces(XrSession, uint32_t capacity, uint32_t* count,
                                  XrReferenceSpaceType* types) {
  *count = 3;
  if (capacity == 0) return XR_SUCCESS;
  if (capacity < 3) return XR_ERROR_SIZE_INSUFFICIENT;
  types[0] = XR_REFERENCE_SPACE_TYPE_VIEW;
  types[1] = XR_REFERENCE_SPACE_TYPE_LOCAL;
  types[2] = XR_REFERENCE_SPACE_TYPE_STAGE;
  return XR_SUCCESS;
}

XrResult createReferenceSpace(XrSession, const XrReferenceSpaceCreateInfo* info, XrSpace* space) {
  switch (info->referenceSpaceType) {
    case XR_REFERENCE_SPACE_TYPE_VIEW:
      return makeSpace(Space::Kind::View, space);
    case XR_REFERENCE_SPACE_TYPE_LOCAL:
      return makeSpace(Space::Kind::Local, space);
    case XR_REFERENCE_SPACE_TYPE_STAGE:
      return makeSpace(Space::Kind::Stage, space);
    default:
      return XR_ERROR_REFERENCE_SPACE_UNSUPPORTED;
  }
}

XrResult createActionSpace(XrSession, const XrActionSpaceCreateInfo* info, XrSpace* space) {
  if (!isAction(info->action)) return XR_ERROR_HANDLE_INVALID;
  if (actionOf(info->action).type != XR_ACTION_TYPE_POSE_INPUT) return XR_ERROR_ACTION_TYPE_MISMATCH;
  return makeSpace(Space::Kind::Gaze, space);
}

XrResult destroySpace(XrSpace space) {
  if (!isSpace(space)) return XR_ERROR_HANDLE_INVALID;
  runtime().spaces.erase(reinterpret_cast<Space*>(space));
  delete reinterpret_cast<Space*>(space);
  return XR_SUCCESS;
}

XrResult locateSpace(XrSpace space, XrSpace base, XrTime time, XrSpaceLocation* location) {
  Runtime& r = runtime();
  if (const XrResult failed = r.scripted("xrLocateSpace"); failed != XR_SUCCESS) return failed;
  if (!isSpace(space) || !isSpace(base)) return XR_ERROR_HANDLE_INVALID;
  if (time <= 0) return XR_ERROR_TIME_INVALID;
  location->locationFlags = 0;
  location->pose = poseOf({});
  if (r.session->untracked) return XR_SUCCESS;
  const double seconds = secondsAt(time);
  Place place = r.script.head(seconds);
  if (spaceOf(space).kind == Space::Kind::Gaze) {
    // What the tracker knows is older than the frame.
    const double seen = seconds - double(r.script.gazeLatency) * 1e-9;
    const std::optional<glm::quat> gaze = r.script.gaze(seen);
    if (!gaze) return XR_SUCCESS;
    place = place * Place{glm::vec3(0), *gaze};
    for (auto* next = static_cast<XrBaseOutStructure*>(location->next); next; next = next->next)
      if (next->type == XR_TYPE_EYE_GAZE_SAMPLE_TIME_EXT)
        reinterpret_cast<XrEyeGazeSampleTimeEXT*>(next)->time = time - r.script.gazeLatency;
  } else if (spaceOf(space).kind != Space::Kind::View) {
    place = {};
  }
  location->pose = poseOf(in(spaceOf(base), place));
  location->locationFlags = kTracked;
  return XR_SUCCESS;
}

XrResult locateViews(XrSession, const XrViewLocateInfo* info, XrViewState* state, uint32_t capacity,
                     uint32_t* count, XrView* views) {
  Runtime& r = runtime();
  if (const XrResult failed = r.scripted("xrLocateViews"); failed != XR_SUCCESS) return failed;
  if (!isSpace(info->space)) return XR_ERROR_HANDLE_INVALID;
  *count = uint32_t(r.script.views.size());
  if (capacity == 0) return XR_SUCCESS;
  if (capacity < *count) return XR_ERROR_SIZE_INSUFFICIENT;
  state->viewStateFlags =
      r.session->untracked ? 0
                           : XR_VIEW_STATE_ORIENTATION_VALID_BIT | XR_VIEW_STATE_POSITION_VALID_BIT |
                                 XR_VIEW_STATE_ORIENTATION_TRACKED_BIT | XR_VIEW_STATE_POSITION_TRACKED_BIT;
  const Place head = r.script.head(secondsAt(info->displayTime));
  for (uint32_t i = 0; i < *count; ++i) {
    const ScriptedView& view = r.script.views[i];
    views[i].pose = poseOf(in(spaceOf(info->space), head * view.inHead));
    views[i].fov = {view.left, view.right, view.up, view.down};
  }
  return XR_SUCCESS;
}

XrResult createActionSet(XrInstance, const XrActionSetCreateInfo*, XrActionSet* set) {
  *set = handleOf<XrActionSet>(&onlySet);
  return XR_SUCCESS;
}

XrResult destroyActionSet(XrActionSet) { return XR_SUCCESS; }

XrResult createAction(XrActionSet, const XrActionCreateInfo* info, XrAction* action) {
  auto* made = new Action{info->actionType, {}};
  runtime().actions.insert(made);
  *action = handleOf<XrAction>(made);
  return XR_SUCCESS;
}

XrResult suggestInteractionProfileBindings(XrInstance, const XrInteractionProfileSuggestedBinding* info) {
  Runtime& r = runtime();
  if (r.session && r.session->attached) return XR_ERROR_ACTIONSETS_ALREADY_ATTACHED;
  const std::string profile = r.paths.at(info->interactionProfile - 1);
  const bool known = profile == "/interaction_profiles/oculus/touch_controller" ||
                     profile == "/interaction_profiles/ext/eye_gaze_interaction";
  if (!known) return XR_ERROR_PATH_UNSUPPORTED;
  for (uint32_t i = 0; i < info->countSuggestedBindings; ++i) {
    const XrActionSuggestedBinding& binding = info->suggestedBindings[i];
    if (!isAction(binding.action)) return XR_ERROR_HANDLE_INVALID;
    reinterpret_cast<Action*>(binding.action)->paths.insert(r.paths.at(binding.binding - 1));
  }
  return XR_SUCCESS;
}

XrResult attachSessionActionSets(XrSession, const XrSessionActionSetsAttachInfo*) {
  if (runtime().session->attached) return XR_ERROR_ACTIONSETS_ALREADY_ATTACHED;
  runtime().session->attached = true;
  return XR_SUCCESS;
}

XrResult syncActions(XrSession, const XrActionsSyncInfo*) {
  Runtime& r = runtime();
  if (const XrResult failed = r.scripted("xrSyncActions"); failed != XR_SUCCESS) return failed;
  if (!r.session->attached) return XR_ERROR_ACTIONSET_NOT_ATTACHED;
  return r.session->state == XR_SESSION_STATE_FOCUSED ? XR_SUCCESS : XR_SESSION_NOT_FOCUSED;
}

XrResult getActionStateVector2f(XrSession, const XrActionStateGetInfo* info, XrActionStateVector2f* state) {
  Runtime& r = runtime();
  if (!isAction(info->action)) return XR_ERROR_HANDLE_INVALID;
  const Action& action = actionOf(info->action);
  const bool left = bound(action, "/user/hand/left"), right = bound(action, "/user/hand/right");
  state->isActive = r.session->state == XR_SESSION_STATE_FOCUSED && (left || right);
  const glm::vec2 stick = state->isActive ? r.script.stick(r.seconds(), right) : glm::vec2(0);
  state->currentState = {stick.x, stick.y};
  state->changedSinceLastSync = XR_FALSE;
  state->lastChangeTime = 0;
  return XR_SUCCESS;
}

XrResult getActionStatePose(XrSession, const XrActionStateGetInfo* info, XrActionStatePose* state) {
  if (!isAction(info->action)) return XR_ERROR_HANDLE_INVALID;
  state->isActive =
      runtime().session->state == XR_SESSION_STATE_FOCUSED && bound(actionOf(info->action), "/user/eyes_ext");
  return XR_SUCCESS;
}

}  // namespace fovea::test
