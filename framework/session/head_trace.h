// Where head, eyes and gaze were in every frame of a run, as a table: what `fovea vr` records and `fovea render` replays.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "framework/session/course.h"

namespace fovea::session {

// The moments as a table with a row a frame, whose numbers are exact: t in seconds; head.x, head.y, head.z (metres,
// relative to Scene::origin) and head.qx, head.qy, head.qz, head.qw (orientation) of the camera; head.gaze_x and
// head.gaze_y; and the same of each view whose eye does not follow from the camera ("left.x"), with the tangents of its
// field of view, left.left, left.right, left.up and left.down.
std::string headTraceTable(const std::vector<scene::Moment>& moments);

// What each frame shows, from such a table. Views without columns follow from the scene. Throws Error(BadInput) with the
// file and the line of every mistake.
std::vector<Steering> parseHeadTrace(std::string_view text, const std::string& file,
                                     const scene::Camera& camera);
std::vector<Steering> readHeadTrace(const std::filesystem::path& file, const scene::Camera& camera);

// The frames of such a table, each of which follows from those before it, as when they were recorded.
std::vector<scene::Moment> replay(const scene::Scene& scene, const std::vector<Steering>& rows);

}  // namespace fovea::session
