#!/usr/bin/env bash
# From a fresh clone to a globally lit picture: installs what is missing, builds, renders a built-in scene with a graph.
# The picture lands in the folder this is called from. More arguments go to `fovea render` (e.g. --size 512x512).
set -euo pipefail
top=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

"$top/samples/setup.sh"
"$top/samples/build.sh" fovea
# Frames of warm-up, so that VPLs and near-field light have converged, and the times do not include compiling shaders.
exec "$top/build/release/bin/fovea" render foveal_view --scene atrium --warmup 16 -o fovea-demo.png "$@"
