#!/bin/bash
# Measures the numbers of docs/performance.md with the command in build/, into lab/bench/results/NAME-*.csv. The machine
# should be idle. Takes ten minutes on two cores.
# Usage: scripts/measure_performance.sh NAME
set -euo pipefail
cd "$(dirname "$0")/.."
name=${1:?usage: measure_performance.sh NAME}
bench() { # BENCHMARK SUFFIX OPTION...: the suffix of the file's name is the benchmark's unless it is given
    local file=lab/bench/results/$name-${2:-$1}.csv begun=$SECONDS
    build/singe bench "$1" "${@:3}" --csv "$file" > /dev/null
    echo "$file: $((SECONDS - begun)) s"
}
for threads in 1 2; do
    bench step "step-$threads" --springs 100000,1000000 --threads $threads
done
bench dynamics "" --springs 1000,4000,16000,100000,1000000,10000000 --substeps 1 --projections 7
bench dynamics paper --springs 1000,4000,16000,100000 --solver paper --substeps 1 --projections 7
bench swing "" --cells 32,50,100,150 --thickness 1,2,5
bench surface
bench compare
bench stability
scripts/draw_cost.py lab/bench/results/"$name"-{dynamics,paper}.csv docs/performance.svg
