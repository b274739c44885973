#!/usr/bin/env bash
# Fuzzes each target for this many seconds, or this many executions if an `x` follows:
#
#   tests/fuzz/run.sh 600                          every target for ten minutes
#   tests/fuzz/run.sh 2000000x gaze_fuzz suite_fuzz
#
# Needs clang-16. Inputs are kept in build/fuzz/corpus from run to run, and those that add no coverage are removed at the
# end. An input that crashes, takes longer than 2 s or more than 1 GiB ends the run and is kept in build/fuzz/found.
# Memory counts when it is used: for an attribute with a forged size, OpenEXR requests 2 GiB before it notices the end of
# the file.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
[ $# -ge 1 ] || { sed -n '2,/^set/{/^#/s/^# \{0,1\}//p}' "$0" >&2; exit 2; }
case $1 in *x) amount=-runs=${1%x} ;; *) amount=-max_total_time=$1 ;; esac
shift
targets=("$@")
[ $# -gt 0 ] || for source in tests/fuzz/*_fuzz.cpp; do targets+=("$(basename "$source" .cpp)"); done

good=tests/data/hostile/good
seeds() {
  case $1 in
    gaze_fuzz) ls $good/*.csv samples/scenes/gazes/*.csv tests/fuzz/corpus/gaze/* ;;
    gltf_fuzz) ls $good/*.gl* tests/fuzz/corpus/gltf/* ;;
    head_trace_fuzz) ls tests/fuzz/corpus/head_trace/* ;;
    image_fuzz) ls tests/fuzz/corpus/image/* ;;
    graph_fuzz) ls tests/fuzz/corpus/graph/* ;;
    option_fuzz) ls tests/fuzz/corpus/option/* ;;
    pass_file_fuzz) ls samples/own_pass/files/passes/*.pass.json $good/*.pass.json ;;
    scene_file_fuzz) ls samples/scenes/*.json $good/scene*.json ;;
    suite_fuzz) ls benchmarks/suites/*.json $good/suite*.json ;;
  esac 2>/dev/null || true
}

[ -f build/fuzz/build.ninja ] || cmake --preset fuzz >/dev/null
ninja -C build/fuzz "${targets[@]}"
mkdir -p build/fuzz/found
for target in "${targets[@]}"; do
  corpus=build/fuzz/corpus/$target
  mkdir -p "$corpus" "$corpus.seeds"
  for file in $(seeds "$target"); do cp "$file" "$corpus.seeds/"; done
  # Of the built-in scenes this is the one that takes no seconds to make.
  [ "$target" != scene_file_fuzz ] || sed -i 's/"builtin": "[a-z]*"/"builtin": "cornellbox"/' "$corpus.seeds"/*
  # The words of the seeds are the words of the format.
  cat "$corpus.seeds"/* 2>/dev/null | LC_ALL=C grep -aoE '"[A-Za-z0-9_.@-]{1,32}"' | sort -u >"$corpus.dict" || true
  dictionary=()
  [ ! -s "$corpus.dict" ] || dictionary=(-dict="$corpus.dict")
  build/fuzz/bin/"$target" "$amount" -timeout=2 -rss_limit_mb=1024 -malloc_limit_mb=4096 -print_final_stats=1 \
    "${dictionary[@]}" -artifact_prefix=build/fuzz/found/"$target"- "$corpus" "$corpus.seeds" 2>"$corpus.log" ||
    { tail -40 "$corpus.log" >&2; echo "fuzz: $target failed, see $corpus.log" >&2; exit 1; }
  echo "$target: $(sed -n 's/^stat:://p' "$corpus.log" | tr -s '\n ' '  ')"
  mkdir "$corpus.small"
  build/fuzz/bin/"$target" -merge=1 -timeout=2 -rss_limit_mb=1024 -malloc_limit_mb=4096 \
    "$corpus.small" "$corpus" "$corpus.seeds" 2>>"$corpus.log"
  rm -r "$corpus" "$corpus.seeds"
  mv "$corpus.small" "$corpus"
done
