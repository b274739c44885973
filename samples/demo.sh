#!/usr/bin/env bash
# From a fresh clone to a globally lit picture: installs what is missing, builds, renders a built-in scene with a graph.
# The picture lands in the folder this is called from. More arguments go to `fovea render` (e.g. --size 512x512).
set -euo pipefail
top=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

"$top/samples/setup.sh"
"$top/samples/build.sh" fovea
# A frame of warm-up, so that the times are those of rendering rather than of compiling shaders.
exec "$top/build/release/bin/fovea" render ir_1000 --scene atrium --warmup 1 -o fovea-demo.png "$@"
