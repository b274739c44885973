#!/usr/bin/env bash
# Installs fovea to a fresh folder, which other tests use as a stranger would: what belongs there is there, and every
# installed header compiles alone.
# Usage: install_test.sh BUILD_DIR PREFIX
set -euo pipefail
build=$1 prefix=$2
rm -rf "$prefix"
mkdir -p "$prefix"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

cmake --install "$build" --prefix "$prefix" >"$work/log" || { cat "$work/log"; exit 1; }
for file in bin/fovea share/fovea/graphs/direct.json share/fovea/shaders share/fovea/passes share/fovea/scenes; do
  [ -e "$prefix/$file" ] || { echo "the installation lacks $file"; exit 1; }
done

(cd "$prefix/include" && find . -name '*.h' | sort) >"$work/headers"
printf './fovea/%s.h\n' compare declaration device document error graph image pass passes registration scene scenes session test |
  diff - "$work/headers" || { echo "the installation holds other headers than the facade"; exit 1; }
while read -r header; do
  echo "#include \"$header\"" >"$work/header.cpp"
  c++ -std=c++20 -fsyntax-only -Wall -Wextra -Werror -Wno-missing-field-initializers -I"$prefix/include" "$work/header.cpp"
done <"$work/headers"
echo "passed"
