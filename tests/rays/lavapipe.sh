#!/usr/bin/env bash
# Prints the path of a file for VK_DRIVER_FILES that names a lavapipe with ray queries, which Debian 12 has among its
# backports. The first call downloads the package from the machine's own package sources and unpacks it into a cache
# folder; nothing is installed. Fails with the reason where it cannot be had.
set -euo pipefail

cache=${XDG_CACHE_HOME:-$HOME/.cache}/fovea-lavapipe
description=$cache/lavapipe.json
if [ -f "$description" ]; then
  echo "$description"
  exit 0
fi

fail() {
  echo "lavapipe: $1" >&2
  exit 1
}

command -v apt-get >/dev/null || fail "there is no apt-get"
codename=$(. /etc/os-release && echo "${VERSION_CODENAME:-}")
[ "$codename" = bookworm ] || fail "only Debian 12 is known to have the package"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p "$work"/{sources,lists/partial,archives/partial,root}

# The sources of the release, with the suite of backports in place of their own.
for file in /etc/apt/sources.list.d/*.sources; do
  [ -f "$file" ] || continue
  awk -v suite="$codename" 'BEGIN { RS = ""; ORS = "\n\n" }
    $0 ~ "Suites:[^\n]*[ ]" suite "([ \n]|$)" { gsub("Suites:[^\n]*", "Suites: " suite "-backports"); print }' \
    "$file" >>"$work/sources/backports.sources"
done
for file in /etc/apt/sources.list /etc/apt/sources.list.d/*.list; do
  [ -f "$file" ] || continue
  sed -n "s/^\(deb .*[ ]\)$codename\([ ].*\)$/\1$codename-backports\2/p" "$file" >>"$work/sources/backports.list"
done
options=(-o Dir::Etc::SourceList=/nonexistent -o Dir::Etc::SourceParts="$work/sources" -o Dir::State::Lists="$work/lists"
         -o Dir::Cache="$work" -o APT::Sandbox::User=root -o Debug::NoLocking=1
         -o Acquire::http::Timeout=20 -o Acquire::https::Timeout=20)
apt-get "${options[@]}" update >"$work/log" 2>&1 || fail "the package sources cannot be read"
(cd "$work" && apt-get "${options[@]}" download mesa-vulkan-drivers >>log 2>&1) ||
  fail "the package sources have no mesa-vulkan-drivers among the backports"
dpkg -x "$work"/mesa-vulkan-drivers_*.deb "$work/root"
library=$(cd "$work/root" && find . -name libvulkan_lvp.so)
[ -n "$library" ] || fail "the package holds no lavapipe"
mkdir -p "$cache"
# Both appear as a whole, as another process may be here as well.
cp "$work/root/$library" "$cache/libvulkan_lvp.so.$$"
mv "$cache/libvulkan_lvp.so.$$" "$cache/libvulkan_lvp.so"
printf '{"file_format_version": "1.0.1", "ICD": {"library_path": "%s", "api_version": "1.4.305"}}\n' \
  "$cache/libvulkan_lvp.so" >"$description.$$"
mv "$description.$$" "$description"
echo "$description"
