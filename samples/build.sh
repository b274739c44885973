#!/usr/bin/env bash
# Configures and builds the preset `release`; arguments are targets (default: everything). Quiet unless something fails.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

log=$(mktemp)
trap 'rm -f "$log"' EXIT
if ! cmake --preset release >"$log" 2>&1; then
  cat "$log" >&2
  echo "build: CMake could not configure the project; if this folder was moved or copied, remove build/release and retry" >&2
  exit 1
fi
echo "building in build/release (the first time takes minutes)"
cmake --build --preset release ${1:+--target "$@"} || {
  echo "build: failed, see above" >&2
  exit 1
}
