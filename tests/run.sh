#!/usr/bin/env bash
# Installs what is missing, builds the preset `release` and runs every test but the long ones. Arguments go to ctest
# instead (-L unit, or -L long for those).
set -euo pipefail
top=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
started=$SECONDS

"$top/samples/setup.sh"
"$top/samples/build.sh"
cd "$top"
chosen=("$@")
[ $# -gt 0 ] || chosen=(-LE long)
built=$SECONDS
status=0
# Three at a time, as some wait for the clock or a browser.
ctest --preset release -j3 --output-on-failure --timeout 600 "${chosen[@]}" || status=$?
printf 'set-up and build took %d s, the tests %d s\n' $((built - started)) $((SECONDS - built))
if [ "$status" -ne 0 ]; then
  echo "tests: some FAILED, see above; again with: ctest --preset release --rerun-failed" >&2
  exit "$status"
fi
echo "tests: all passed"
if [ $# -eq 0 ]; then
  echo "tests: the long ones were left out; to run them: tests/run.sh -L long"
fi
