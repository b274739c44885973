#!/usr/bin/env bash
# Makes one folder (under 40 MB) with the program, its libraries and data that runs on another x86-64 Linux machine with
# nothing but glibc (no older than this machine's) and a Vulkan loader and driver.
#   samples/make_portable.sh [FOLDER]     default: build/fovea-portable; an earlier bundle there is replaced
set -euo pipefail
top=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
out=$(realpath -m "${1:-$top/build/fovea-portable}")
limitMb=40

fail() {
  printf 'make_portable: %s\n' "$@" >&2
  exit 1
}

trap 'echo "make_portable: stopped at line $LINENO" >&2' ERR

[ $# -le 1 ] || fail "usage: samples/make_portable.sh [FOLDER]"
if [ -e "$out" ] && [ ! -f "$out/BUNDLE" ] && [ -n "$(ls -A "$out" 2>/dev/null || echo file)" ]; then
  fail "$out exists and is no earlier bundle; name another folder"
fi

"$top/samples/setup.sh"
cd "$top"
log=$(mktemp)
stage=
trap 'rm -rf "$log" ${stage:+"$stage"}' EXIT
cmake --preset portable >"$log" 2>&1 || { cat "$log" >&2; fail "CMake could not configure the preset portable"; }
echo "building in build/portable (the first time takes minutes)"
cmake --build --preset portable --target fovea || fail "the build failed, see above"

mkdir -p "$(dirname "$out")"
stage=$(mktemp -d "$(dirname "$out")/.portable.XXXXXX")  # renamed at the end: no half-made bundle stays
chmod 755 "$stage"
cmake --install build/portable --prefix "$stage" --strip >"$log" 2>&1 || { cat "$log" >&2; fail "the installation failed"; }
rm -rf "$stage/include" "$stage"/lib/cmake "$stage"/lib/*/cmake

# Every library that is neither glibc's nor the Vulkan loader comes along, with its licence. The C++ runtime stays apart:
# a driver may need a newer one than ours, so ours is used only where the system's does not do.
mkdir -p "$stage/lib/fallback" "$stage/licenses"
addLicence() {
  if [ -f "/usr/share/doc/$1/copyright" ]; then cp -L "/usr/share/doc/$1/copyright" "$stage/licenses/$1"; fi
}
# Linked statically, or all header.
for package in glslang-dev spirv-tools libspirv-cross-c-shared-dev libdraco-dev libglm-dev nlohmann-json3-dev libcli11-dev; do addLicence "$package"; done
while read -r name file; do
  case "$name" in
    libc.so.*|libm.so.*|libdl.so.*|libpthread.so.*|librt.so.*|libresolv.so.*|libvulkan.so.*|ld-linux*|linux-vdso*) continue ;;
    libfovea.so.*|libfovea-*.so.*) continue ;;
    libstdc++.so.*|libgcc_s.so.*) cp -L "$file" "$stage/lib/fallback/$name" ;;
    *) cp -L "$file" "$stage/lib/$name" ;;
  esac
  # dpkg may know the file below /lib or below /usr/lib, which are the same folder.
  package=$(dpkg-query -S "*-linux-gnu/$(basename "$(realpath "$file")")" 2>/dev/null | head -n1 | cut -d: -f1 || true)
  addLicence "${package:-none}"
done < <(ldd "$top/build/portable/bin/fovea" | awk '$2 == "=>" && $3 ~ /^\// {print $1, $3}')
cp LICENSE "$stage/licenses/fovea"

cat >"$stage/fovea" <<'LAUNCHER'
#!/bin/sh
# Starts bin/fovea; with the C++ runtime of this bundle only where the system has none that is new enough.
here=$(dirname "$(readlink -f "$0")")
if ! "$here/bin/fovea" --version >/dev/null 2>&1; then
  LD_LIBRARY_PATH="$here/lib/fallback${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}"
  export LD_LIBRARY_PATH
fi
exec "$here/bin/fovea" "$@"
LAUNCHER
chmod +x "$stage/fovea"

glibc=$(objdump -T "$stage"/bin/fovea "$stage"/lib/*.so* "$stage"/lib/fallback/*.so* | grep -o 'GLIBC_2\.[0-9.]*' | sort -uV | tail -n1)
printf 'fovea %s, portable bundle: run ./fovea; needs %s and a Vulkan 1.3 driver.\n' \
  "$("$stage/fovea" --version | grep -o '[0-9][0-9.]*' | head -n1)" "${glibc/_/ }" >"$stage/BUNDLE"

# What it claims, checked: complete without this machine's libraries, small enough, and it starts in an empty environment.
outside=$(env -i LD_LIBRARY_PATH="$stage/lib/fallback" ldd "$stage/bin/fovea" | grep -v "$stage" |
  grep -vE 'linux-vdso|ld-linux|lib(c|m|dl|pthread|rt|resolv)\.so|libvulkan\.so' || true)
[ -z "$outside" ] || fail "the bundle is not complete:" "$outside"
size=$(du -sb "$stage" | cut -f1)
[ "$size" -lt $((limitMb * 1000000)) ] || fail "the bundle takes $((size / 1000000)) MB, more than $limitMb MB"
env -i "$stage/fovea" check ir_1000 >"$log" 2>&1 || { cat "$log" >&2; fail "the bundle does not run in an empty environment"; }

rm -rf "$out"
mv "$stage" "$out"
stage=
echo "$out: $(((size + 500000) / 1000000)) MB, $(cat "$out/BUNDLE")"
