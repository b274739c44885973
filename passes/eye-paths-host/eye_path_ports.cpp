#include "passes/eye-paths-host/eye_path_ports.h"

#include "passes/bundles.h"

namespace fovea::passes {

using namespace graph;

void declareEyePaths(PassDeclaration& d, Usage write, Lifetime paths) {
  d.output("paths", "eye-paths", eyePathOutput(parameter("points"), parameter("paths"), write),
           "what the screen points show, where their paths end and the light found there; the paths of one "
           "point are `points` entries apart")
      .keep(paths);
  d.output(
      "change", changeBuffer(), write,
      "x: share c of the light found by the paths traced again that differs from what they found before, "
      "in [0, 1]; y: s = 16 j^2, after which a history of n samples is worth n / (1 + n s), j being the "
      "part of c that exceeds the changes in the frames before, or the share by which the light as a "
      "whole has grown or shrunk if that is more; z: s / (1 + s), the share that is lost, and a quarter "
      "less in each frame after; w: share by which the light as a whole has grown or shrunk, in [0, 1]");
  d.parameter("region", choice("fovea", {"fovea", "image", "mixed"}),
              "region in which the eye paths start, as in pass candidates");
  d.parameter("image_share", real(0.4, 0, 1),
              "share of starts in the whole image for region `mixed`, rounded to 64ths");
  d.parameter("points", integer(1024, 1, 65536),
              "number of screen points, the same as in pass vpl-intensity");
  d.parameter("paths", integer(8192, 64, 65536), "number of eye paths");
  d.parameter("bounces", integer(2, 1, 64),
              "reflections of the light before it reaches the visible surface: 1 is direct light at the "
              "ends, 2 matches a path tracer of depth 4");
  d.parameter("emission", flag(true),
              "whether the ends show the light that surfaces emit themselves; pass near-field brings it from "
              "there straight to what is seen");
  d.parameter("gathered", integer(2, 1, 256),
              "rays from each end that gather the second of these reflections");
  d.parameter("renew_frames", integer(1, 1, 1000),
              "frames in which all paths get new starts, a share of the points in each frame; the others "
              "keep theirs, so that the effect of a gaze jump comes in gradually");
  d.parameter("saccade_renew_frames", integer(0, 0, 1000),
              "in place of `renew_frames` for 8 frames after a jump of the gaze; 0 means no other");
  d.parameter("stray", real(0, 0, 1, "image widths"),
              "how far a start may be on screen from its place; a closer one that the eye still sees is "
              "kept, with the light it found, when it is due for renewal");
  d.parameter("trace_frames", integer(1, 1, 1000),
              "frames in which all paths are traced anew, those of a share of the points in each frame; "
              "the others keep the light they found unless their start is new; of them, twice as large a "
              "share is traced all the same as the light of the former has changed suddenly");
}

}  // namespace fovea::passes
