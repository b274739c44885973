#!/usr/bin/env bash
# Installs the Debian packages that building, testing and running fovea need; only those that are missing. For the
# module for Python it makes an environment with packages of the Python package index, in $XDG_CACHE_HOME/fovea-python.
#   samples/setup.sh          install
#   samples/setup.sh --list   print the package names
set -euo pipefail

packages=(
  # building
  ccache cmake g++ ninja-build pkg-config python3 python3-dev python3-venv
  # Vulkan: headers and loader, a driver that renders on the CPU, validation layers
  libvulkan-dev mesa-vulkan-drivers vulkan-validationlayers
  # shaders: GLSL to SPIR-V, reflection
  glslang-dev glslang-tools spirv-tools libspirv-cross-c-shared-dev
  # maths, JSON, command line, text, hashes
  libglm-dev nlohmann-json3-dev libcli11-dev libfmt-dev libxxhash-dev
  # models, images, rays, mesh simplification, subdivision surfaces
  libtinygltf-dev libdraco-dev libopenimageio-dev openimageio-tools libembree-dev libmeshoptimizer-dev libosd-dev
  # `fovea view`: web server, JPEG
  libcivetweb-dev libturbojpeg0-dev
  # images without OpenImageIO, for the preset `portable`
  libpng-dev libstb-dev libtinyexr-dev
  # `fovea vr`: headers and loader of OpenXR, and its validation layer for tests
  libopenxr-dev openxr-layer-corevalidation
  # captures of frames
  librenderdoc-dev
  # tests and benchmarks
  clang-16 libclang-rt-16-dev clang-format clang-tidy libgtest-dev libgmock-dev libbenchmark-dev
  python3-jsonschema python3-matplotlib python3-numpy
  chromium chromium-driver python3-selenium fish zsh
)

fail() {
  printf 'setup: %s\n' "$@" >&2
  exit 1
}

case "${1:-}" in
  --list) printf '%s\n' "${packages[@]}"; exit 0 ;;
  "") ;;
  *) fail "unknown argument $1; usage: samples/setup.sh [--list]" ;;
esac

# Made anew when its list of packages has changed. Without a network, the module and its tests are left out.
makePythonEnvironment() {
  local list environment
  list=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)/framework/python/requirements.txt
  environment=${XDG_CACHE_HOME:-$HOME/.cache}/fovea-python
  if cmp -s "$list" "$environment/requirements.txt"; then return; fi
  echo "setup: installing packages for Python into $environment"
  if /usr/bin/python3 -m venv --clear "$environment" &&
    "$environment/bin/pip" install --quiet --disable-pip-version-check -r "$list"; then
    cp "$list" "$environment/requirements.txt"
  else
    rm -rf "$environment"
    echo "setup: the packages for Python cannot be installed (no network?): the module for Python is left out" >&2
  fi
}

if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
  fail "this is no Debian system (there is no dpkg or apt-get)." \
       "fovea is built and tested on Debian 12; elsewhere install what these packages hold:" "${packages[*]}"
fi

missing=()
for package in "${packages[@]}"; do
  status=$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null || true)
  [ "$status" = installed ] || missing+=("$package")
done
if [ ${#missing[@]} -eq 0 ]; then
  makePythonEnvironment
  exit 0
fi

release=$( (. /etc/os-release && echo "${ID:-unknown} ${VERSION_ID:-}") 2>/dev/null || echo unknown)
if [ "$release" != "debian 12" ]; then
  echo "setup: this is $release; only Debian 12 is tested, going on" >&2
fi

root=()
if [ "$(id -u)" -ne 0 ]; then
  command -v sudo >/dev/null ||
    fail "packages are missing, and installing them needs root. Run this as root, then try again:" \
         "apt-get update && apt-get install --no-install-recommends ${missing[*]}"
  root=(sudo)
fi

echo "setup: installing ${missing[*]}"
apt=("${root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -qq -o DPkg::Lock::Timeout=300)
# The lists may be old or absent, so they are renewed first; if that fails, those there may still do.
"${apt[@]}" update || echo "setup: the package lists could not be renewed (no network?), trying with the old ones" >&2
"${apt[@]}" install -y --no-install-recommends "${missing[@]}" >/dev/null ||
  fail "apt-get could not install: ${missing[*]}" "Its messages above say why: a missing network, a full disk, another release than Debian 12."
makePythonEnvironment
