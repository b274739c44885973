#include "framework/session/course.h"

#include <algorithm>
#include <cmath>

#include "framework/scene/motion/motion.h"

namespace fovea::session {

scene::Moment Course::next(const scene::Scene& scene, uint64_t index, const Steering& steering) {
  const bool anew = !begun_ || steering.cut;
  scene::Moment m;
  m.index = index;
  m.time = steering.time;
  m.before = anew ? m.time : shown_.time;
  m.camera = steering.camera.value_or(scene::cameraAt(scene, m.time));
  m.previousCamera = anew ? m.camera : shown_.camera;
  m.eyes = steering.eyes;
  m.previousEyes = anew ? m.eyes : shown_.eyes;
  m.cameraCut = anew;
  m.gazes = scene::gazesAt(scene, m.time);
  for (size_t i = 0; i < m.gazes.size(); ++i)
    m.gazes[i] = steering.gazes[i].value_or(steering.gaze.value_or(m.gazes[i]));
  m.previousGazes = anew ? m.gazes : shown_.gazes;
  // As scene::momentAt() has it, from the frames as they were shown.
  bool jumped = false;
  for (size_t i = 0; i < scene::kInsets[0] && !anew; ++i)
    jumped |= glm::distance(m.gazes[i], shown_.gazes[i]) > scene::kGazeJump;
  sinceJump_ = jumped ? 0 : anew ? scene::kSaccadeFrames : std::min(sinceJump_ + 1, scene::kSaccadeFrames);
  m.saccade = 1 - float(sinceJump_) / float(scene::kSaccadeFrames);
  begun_ = true;
  shown_ = m;
  return m;
}

void Course::follow(const scene::Moment& moment) {
  begun_ = true;
  shown_ = moment;
  sinceJump_ = uint32_t(std::lround((1 - moment.saccade) * float(scene::kSaccadeFrames)));
}

}  // namespace fovea::session
