#!/usr/bin/env bash
# Builds the sample program against the installed package, with a linker that keeps only libraries of which something is
# used, and compares what it renders with what the installed program does.
# Usage: embed_test.sh PREFIX SOURCE_DIR
set -euo pipefail
prefix=$1 source=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
unset FOVEA_DATA

cp -r "$source/samples/embed" "$work/embed"
sed -i 's/{128, 128}/{32, 32}/' "$work/embed/embed.cpp"  # a small picture compares as well
grep -q '{32, 32}' "$work/embed/embed.cpp" || { echo "the size of the sample's picture is not {128, 128}"; exit 1; }
cmake -S "$work/embed" -B "$work/build" -G Ninja -DCMAKE_PREFIX_PATH="$prefix" -DCMAKE_BUILD_TYPE=Release \
  -DCMAKE_EXE_LINKER_FLAGS=-Wl,--as-needed >"$work/log" || { cat "$work/log"; exit 1; }
cmake --build "$work/build"
cd "$work"
build/embed | tee printed
"$prefix/bin/fovea" render ours --scene atrium --size 32x32 --frames 4 --quiet -o radiance.pfm
oiiotool --stats radiance.pfm | sed -n 's/.*Stats Avg: *\([0-9.]*\) \([0-9.]*\) \([0-9.]*\).*/\1 \2 \3/p' >expected
echo "expected: $(cat expected)"
sed 's/mean radiance: //; s/ W.*//' printed | paste -d' ' - expected | awk '
  function near(a, b) { return a > 0 && (a - b) ^ 2 < (1e-4 + 1e-3 * b) ^ 2 }
  { found = near($1, $4) && near($2, $5) && near($3, $6) } END { exit !found }' ||
  { echo "the sample renders something else than the program"; exit 1; }

echo "== without the calls"
cp embed/embed.cpp whole.cpp
for library in scenes passes; do
  sed "/${library}::registerAll/d" whole.cpp >embed/embed.cpp
  cmake --build build
  code=0
  build/embed 2>log || code=$?
  cat log
  [ $code = 3 ] || { echo "exit code $code without $library"; exit 1; }
  grep -q "fovea::$library::registerAll()" log || { echo "the remedy is not named"; exit 1; }
done
echo "passed"
