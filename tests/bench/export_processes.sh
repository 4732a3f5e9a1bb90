#!/bin/sh
# How much faster two processes make data sets than one: each exports the same flight with one
# thread. Prints frames per second and the ratio; the fourth run repeats the first, to show what
# the machine's own unrest is worth.
# Usage: export_processes.sh PROGRAM [SCENARIO] [SECONDS_OF_FLIGHT]
set -eu
program=$(realpath "$1")
here=$(dirname "$(realpath "$0")")
scenario=${2:-$here/../../scenarios/course.json}
flight_s=${3:-10}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT INT TERM

export_once() {
  "$program" export "$scenario" --format png --out "$work/$1" --threads 1 --to "$flight_s" \
    --quiet --json > "$work/$1.json"
}
now_ms() { date +%s%3N; }

export_once warm_up  # the built-in world is made at its first use
frames=$(sed -n 's/^  "frames": \([0-9]*\).*/\1/p' "$work/warm_up.json")
rm -rf "$work/warm_up"

measure_one() {
  begin=$(now_ms)
  export_once "$1"
  one_ms=$(($(now_ms) - begin))
  rm -rf "${work:?}/$1"
}
measure_two() {
  begin=$(now_ms)
  export_once a & first=$!
  export_once b & second=$!
  wait "$first"
  wait "$second"
  two_ms=$(($(now_ms) - begin))
  rm -rf "$work/a" "$work/b"
}

for round in 1 2 3; do
  measure_one one
  measure_two
  awk -v r="$round" -v n="$frames" -v one="$one_ms" -v two="$two_ms" 'BEGIN {
    printf "round %d: one process %.1f frames/s, two %.1f frames/s, ratio %.2f\n",
           r, 1000 * n / one, 2000 * n / two, 2 * one / two }'
done
measure_one again
awk -v n="$frames" -v one="$one_ms" 'BEGIN {
  printf "again:   one process %.1f frames/s\n", 1000 * n / one }'
