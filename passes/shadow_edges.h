// What the passes declare alike that decide the edges of shadows by rays, on the host or on the device.
#pragma once

#include "fovea/pass.h"
#include "passes/acuity.h"

namespace fovea::passes {

// The light that they change, and their parameters. usage: how they read and write that light.
inline void declareShadowEdges(graph::PassDeclaration& d, graph::Usage usage) {
  d.inout("direct", graph::image2D(VK_FORMAT_R16G16B16A16_SFLOAT), usage,
          "rgb: radiance towards the eye, W/(sr m^2); a: 0 where the shadow map is in doubt; becomes 1 "
          "where rays decide");
  declarePeriphery(
      d,
      "1 traces all pixels in doubt; 2 leaves out those outside the fovea where the eye resolves "
      "no more than every second pixel");
  d.counter("pixels", "pixels that were in doubt and traced");
}

}  // namespace fovea::passes
