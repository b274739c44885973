#!/usr/bin/env bash
# Installs fovea to an empty prefix and uses it from there as an outsider would: every installed header compiles
# alone, the sample pass builds against the package, passes its own test, renders through --plugin, and changes the picture as
# its parameter says.
# Usage: own_pass_test.sh BUILD_DIR SOURCE_DIR
set -euo pipefail
build=$1 source=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
unset FOVEA_DATA
prefix=$work/prefix

cmake --install "$build" --prefix "$prefix" >"$work/log" || { cat "$work/log"; exit 1; }
for file in bin/fovea share/fovea/graphs/direct.json share/fovea/shaders/tonemap/tonemap.frag share/fovea/scenes; do
  [ -e "$prefix/$file" ] || { echo "the installation lacks $file"; exit 1; }
done

echo "== installed headers"
(cd "$prefix/include" && find . -name '*.h' | sort) >"$work/headers"
printf './fovea/%s.h\n' declaration error graph image pass registration scene test | diff - "$work/headers" ||
  { echo "the installation holds other headers than the facade"; exit 1; }
while read -r header; do
  echo "#include \"$header\"" >"$work/header.cpp"
  c++ -std=c++20 -fsyntax-only -Wall -Wextra -Werror -Wno-missing-field-initializers -I"$prefix/include" "$work/header.cpp"
done <"$work/headers"

echo "== the sample, built against the package"
cp -r "$source/samples/own_pass" "$work/own_pass"
cmake -S "$work/own_pass" -B "$work/build" -G Ninja -DCMAKE_PREFIX_PATH="$prefix" -DCMAKE_BUILD_TYPE=Release >"$work/log" ||
  { cat "$work/log"; exit 1; }
cmake --build "$work/build"

echo "== mistakes in the use of the package's functions"
mistake() {  # what the message says, lines of CMake
  mkdir -p "$work/mistake"
  { printf 'cmake_minimum_required(VERSION 3.25)\nproject(mistake CXX)\nfind_package(fovea REQUIRED)\n'
    printf '%s\n' "${@:2}"; } >"$work/mistake/CMakeLists.txt"
  touch "$work/mistake/a.cpp"
  if cmake -S "$work/mistake" -B "$work/mistake/build" -G Ninja -DCMAKE_PREFIX_PATH="$prefix" >"$work/log" 2>&1; then
    echo "accepted: ${*:2}"
    exit 1
  fi
  tr -s '\n ' ' ' <"$work/log" | grep -q "$1" || { cat "$work/log"; exit 1; }
}
mistake 'fovea_add_pass_plugin(empty) names no source file' 'fovea_add_pass_plugin(empty)'
mistake 'has made no plug-in `missing`' 'fovea_add_pass_test(a_test missing a.cpp)'

echo "== its own test"
ctest --test-dir "$work/build" --output-on-failure --no-tests=error

echo "== listed"
fovea=$prefix/bin/fovea
plugin=$work/build/own_pass.so
"$fovea" passes outline --plugin "$plugin" | grep -q strength

echo "== compiled for another version"
mkdir "$work/other"
LC_ALL=C sed 's/fovea [0-9]\.[0-9]\.[0-9] /fovea 9.9.9 /g' "$plugin" >"$work/other/own_pass.so"
code=0
"$fovea" passes --plugin "$work/other/own_pass.so" 2>"$work/log" || code=$?
cat "$work/log"
[ $code = 3 ] || { echo "exit code $code for a plug-in of another version"; exit 1; }
grep -q "own_pass.so: error: the plug-in was compiled for fovea 9.9.9, but this is fovea " "$work/log"
grep -q "compile it again" "$work/log"

echo "== rendered through the plug-in"
# Data files come from the installation, not from the sources: this graph is only there.
echo '{ "extends": "direct.json" }' >"$prefix/share/fovea/graphs/only_installed.json"
(cd "$work" && "$fovea" check only_installed)
common=(--scene cornellbox --size 96x96 --set vpl_count=32 --quiet)
cd "$work"
"$fovea" render ir_1000 "${common[@]}" -o stock.png
"$fovea" render own_pass/outlined.json "${common[@]}" --plugin "$plugin" -o outlined.png
"$fovea" render own_pass/outlined.json "${common[@]}" --plugin "$plugin" --set outline.strength=0 -o plain.png
idiff stock.png plain.png || { echo "without strength the outline pass must change nothing"; exit 1; }
if idiff stock.png outlined.png >"$work/log"; then
  echo "the outline pass changed nothing"
  exit 1
fi
mean() { oiiotool --stats "$1" | sed -n 's/.*Stats Avg: *\([0-9.]*\).*/\1/p'; }
echo "mean of red: stock $(mean stock.png), outlined $(mean outlined.png)"
awk -v a="$(mean stock.png)" -v b="$(mean outlined.png)" 'BEGIN { exit !(b > 0.5 * a && b < a) }' ||
  { echo "outlines must darken the picture a little"; exit 1; }
echo "== passes in files"
"$fovea" render own_pass/files/outlined.json "${common[@]}" -o file.png
if idiff stock.png file.png >"$work/log"; then
  echo "the outline pass in a file changed nothing"
  exit 1
fi
for graph in blurred trails; do "$fovea" check "own_pass/files/$graph.json"; done
echo "passed"
