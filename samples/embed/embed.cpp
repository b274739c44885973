// Renders the atrium by foveated instant radiosity and prints the mean of the pixels.
#include <cstdio>

#include "fovea/passes.h"
#include "fovea/scenes.h"
#include "fovea/session.h"

int main() try {
  fovea::passes::registerAll();
  fovea::scenes::registerAll();
  fovea::Diagnostics messages;
  const fovea::scene::Scene scene = fovea::scene::load("atrium", messages);
  fovea::graph::Session session("ours", scene, {.size = {128, 128}, .read = {"radiance"}});
  fovea::graph::FrameResult frame;
  for (uint64_t i = 0; i < 4; ++i) frame = session.render(i);  // each frame improves on the last one
  const fovea::image::Image picture = session.picture(frame, "radiance");
  double mean[3] = {};
  for (size_t i = 0; i < picture.data.size(); ++i)
    if (const size_t c = i % picture.channels; c < 3)
      mean[c] += picture.data[i] / (picture.width * picture.height);
  std::printf("mean radiance: %.6f %.6f %.6f W/(sr m^2)\n", mean[0], mean[1], mean[2]);
} catch (const fovea::Error& error) {
  std::fprintf(stderr, "embed: %s\n", error.what());
  return int(error.code());
}
