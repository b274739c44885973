#!/usr/bin/env bash
# Installs the Debian packages that building, testing and running fovea need; only those that are missing.
#   samples/setup.sh          install
#   samples/setup.sh --list   print the package names
set -euo pipefail

packages=(
  # building
  ccache cmake g++ ninja-build pkg-config python3
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
  # tests and benchmarks
  clang-16 libclang-rt-16-dev clang-format clang-tidy libgtest-dev libgmock-dev libbenchmark-dev
  python3-jsonschema python3-matplotlib python3-numpy
  chromium chromium-driver python3-selenium
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
