#include "tests/openxr/runtime.h"

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>

namespace fovea::test {

Runtime& runtime() {
  static Runtime only;
  return only;
}

Runtime::Runtime() : script(Script::load(std::getenv("FOVEA_XR_SCRIPT"))) {
  if (const char* folder = std::getenv("FOVEA_XR_OUTPUT")) output = folder;
}

void Runtime::violation(const std::string& text) {
  std::fprintf(stderr, "test runtime: %s\n", text.c_str());
  violations.push_back(text);
}

void Runtime::post(XrSessionState state) {
  session->state = state;
  XrEventDataBuffer buffer{XR_TYPE_EVENT_DATA_BUFFER};
  XrEventDataSessionStateChanged changed{XR_TYPE_EVENT_DATA_SESSION_STATE_CHANGED};
  changed.session = handleOf<XrSession>(session.get());
  changed.state = state;
  changed.time = session->display;
  std::memcpy(&buffer, &changed, sizeof(changed));
  events.push_back(buffer);
}

XrResult Runtime::scripted(const char* function) {
  const auto found = failing.find(function);
  if (found == failing.end() || found->second.count <= 0) return XR_SUCCESS;
  --found->second.count;
  return XrResult(found->second.result);
}

void Runtime::happen() {
  session->untracked = false;
  for (const ScriptedEvent& event : script.events) {
    if (event.frame != session->waits) continue;
    if (event.what == "unfocus") {
      post(XR_SESSION_STATE_VISIBLE);
    } else if (event.what == "hide") {
      post(XR_SESSION_STATE_VISIBLE);
      post(XR_SESSION_STATE_SYNCHRONIZED);
    } else if (event.what == "focus") {
      if (session->state == XR_SESSION_STATE_SYNCHRONIZED) post(XR_SESSION_STATE_VISIBLE);
      post(XR_SESSION_STATE_FOCUSED);
    } else if (event.what == "stop" || event.what == "exit") {
      session->exitAsked = event.what == "exit";
      post(XR_SESSION_STATE_STOPPING);
    } else if (event.what == "lose_session") {
      post(XR_SESSION_STATE_LOSS_PENDING);
    } else if (event.what == "lose_instance") {
      XrEventDataBuffer buffer{XR_TYPE_EVENT_DATA_BUFFER};
      XrEventDataInstanceLossPending lost{XR_TYPE_EVENT_DATA_INSTANCE_LOSS_PENDING};
      std::memcpy(&buffer, &lost, sizeof(lost));
      post(buffer);
    } else if (event.what == "miss") {
      session->display += script.period;
    } else if (event.what == "untracked") {
      session->untracked = true;
    } else if (event.what == "fail") {
      failing[event.function] = event;
    }
  }
}

void Runtime::endInstance() {
  if (session) violation("the instance ends before its session");
  if (!output.empty()) {
    const nlohmann::json log = {{"frames", frames}, {"violations", violations}};
    std::ofstream(output / "log.json") << log.dump(1) << "\n";
  }
  alive = false;
  extensions.clear();
  paths.clear();
  events.clear();
  for (Action* action : actions) delete action;
  actions.clear();
}

XrPosef poseOf(const Place& place) {
  const glm::quat q = glm::normalize(place.orientation);
  return {{q.x, q.y, q.z, q.w}, {place.position.x, place.position.y, place.position.z}};
}

}  // namespace fovea::test
