#!/usr/bin/env bash
# The first minutes of a new user of the wheel: in a root of Debian 12, made by debootstrap and removed at the end, that has
# Python and a Vulkan driver but no compiler, it installs the wheel, makes a picture, and runs the suite `quick`. Then, with a
# compiler, it builds and tests the pass of samples/own_pass against the installed wheel. Needs root.
#   tests/python/bare_root.sh [WHEEL]     default: the one in build/wheels
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
wheel=${1:-$(echo build/wheels/fovea-*.whl)}
[ -f "$wheel" ] || { echo "bare_root: there is no $wheel; samples/make_wheel.sh makes one" >&2; exit 2; }
command -v debootstrap >/dev/null || apt-get install -y --no-install-recommends debootstrap >/dev/null

root=$(mktemp -d)
trap 'rm -rf "$root"' EXIT
debootstrap --variant=minbase --include=ca-certificates,mesa-vulkan-drivers,python3-venv bookworm "$root" >"$root.log" 2>&1 ||
  { cat "$root.log" >&2; exit 1; }
rm "$root.log"
# What this machine needs to reach the Python package index.
cp /etc/resolv.conf "$root/etc/"
rm -r "$root/etc/ssl/certs"
cp -rL /etc/ssl/certs "$root/etc/ssl/"
if [ -f /etc/pip.conf ]; then cp /etc/pip.conf "$root/etc/"; fi
cp "$wheel" "$root/root/"
cp -r samples/own_pass "$root/root/"

cat >"$root/root/steps.sh" <<'STEPS'
set -euo pipefail
mount -t proc proc /proc
cd /root
if command -v gcc g++ cc c++ >/dev/null; then echo "bare_root: there is a compiler" >&2; exit 1; fi
python3 -m venv environment
started=$SECONDS
environment/bin/pip install --quiet --disable-pip-version-check fovea-*.whl
installed=$SECONDS
environment/bin/python - <<'PYTHON'
import fovea

frame = fovea.Renderer("foveal", scene="cornellbox", size=(256, 256)).frame()
picture = next(iter(frame.values()))
assert picture.shape[:2] == (256, 256) and 0.01 < picture[..., :3].mean() < 10, picture.shape
fovea.write_image("picture.exr", picture)
PYTHON
environment/bin/fovea render ours --scene cornellbox --size 128x128 --quiet -o ours.exr
pictures=$SECONDS
environment/bin/fovea bench quick -o quick >bench.log 2>&1 || { cat bench.log >&2; exit 1; }
if grep -q "^fovea: warning" bench.log; then cat bench.log >&2; exit 1; fi
test -s picture.exr -a -s ours.exr -a -s quick/report.html
test -d "$(environment/bin/python -c 'import fovea; print(fovea.cmake_dir())')"
printf 'pip install took %d s, the pictures %d s, `fovea bench quick` %d s\n' \
  $((installed - started)) $((pictures - installed)) $((SECONDS - pictures))
[ $((pictures - started)) -lt 120 ] || { echo "bare_root: a picture takes two minutes or more" >&2; exit 1; }

apt-get install -qq --no-install-recommends cmake g++ libglm-dev libgtest-dev libvulkan-dev make \
  vulkan-validationlayers >apt.log 2>&1 || { cat apt.log >&2; exit 1; }
cmake -S own_pass -B built -D fovea_DIR="$(environment/bin/python -c 'import fovea; print(fovea.cmake_dir())')" >/dev/null
cmake --build built >/dev/null
ctest --test-dir built --output-on-failure
environment/bin/fovea render own_pass/outlined.json --plugin built/own_pass.so --scene cornellbox --size 64x64 --quiet -o lines.png
STEPS
unshare --mount --pid --fork chroot "$root" /usr/bin/env HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin bash /root/steps.sh
