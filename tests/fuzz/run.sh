#!/bin/sh
# Runs every fuzz target for some seconds, or all of them for some hours, two at a time: run.sh BUILD_DIR [SECONDS |
# HOURSh]. Fails when one of them finds something; what it found is left in BUILD_DIR/fuzz/TARGET/. Fails too when one
# makes less than SLOWEST runs in a second of processor time: so few find nothing. The slowest, fuzz_step, made 2 when its
# sheets were large, and makes 12 to 26 with small ones.
set -u
build=${1:?usage: run.sh BUILD_DIR [SECONDS | HOURSh]}
seconds=${2:-30}
SLOWEST=4
seeds=$(cd "$(dirname "$0")" && pwd)/seeds
build=$(cd "$build" && pwd) || exit 2
case $seconds in *h)
    targets=$(find "$build/tests/fuzz" -maxdepth 1 -name 'fuzz_*' -type f -perm -u+x | wc -l)
    seconds=$(echo "${seconds%h} $targets" | awk '{printf "%d", $1 * 3600 * 2 / $2}')
esac
export UBSAN_OPTIONS="halt_on_error=1:print_stacktrace=1${UBSAN_OPTIONS:+:$UBSAN_OPTIONS}"

# Leaves its summary in BUILD_DIR/fuzz/TARGET/summary.
fuzz() {
    name=$(basename "$1" | sed 's/^fuzz_//')
    work=$build/fuzz/$name
    mkdir -p "$work/corpus" "$work/findings"
    start="$work/corpus"
    limit=10 # s for one input, of a reader; whole simulations have more
    case $name in step | snapshot | calls | replay) limit=120 ;; esac
    if [ -d "$seeds/$name" ]; then start="$start $seeds/$name"; fi
    # shellcheck disable=SC2086
    if "$1" -max_total_time="$seconds" -timeout="$limit" -rss_limit_mb=2048 -max_len=65536 -print_final_stats=1 \
        -artifact_prefix="$work/findings/" $start >"$work/log" 2>&1; then
        runs=$(sed -n 's/^stat::number_of_executed_units: *//p' "$work/log")
        times >"$work/times" # the second line is the children's, such as 1m2.34s 0m0.50s
        sed 1d "$work/times" | tr 'ms' '  ' | awk -v name="$name" -v runs="${runs:-0}" -v slowest=$SLOWEST '{
            cpu = 60 * $1 + $2 + 60 * $3 + $4
            printf "  fuzz_%s: %s, %d runs, %.0f in a second of processor time\n", name,
                   runs < slowest * cpu ? "TOO SLOW" : "ok", runs, runs / cpu
        }' >"$work/summary"
    else
        tail -n 40 "$work/log"
        if [ "$name" = calls ]; then # what it found as recordings, which `singe replay` repeats (docs/replay.md)
            for found in "$work/findings"/*-*; do
                case $found in *.singerec.?) continue ;; esac
                SINGE_RECORD=$found.singerec "$1" "$found" >/dev/null 2>&1
            done
        fi
        echo "  fuzz_$name: FOUND SOMETHING, see $work/log and $work/findings" >"$work/summary"
    fi
}

rm -f "$build"/fuzz/*/summary
count=0
for program in "$build"/tests/fuzz/fuzz_*; do
    [ -f "$program" ] && [ -x "$program" ] || continue
    count=$((count + 1))
    echo "$(basename "$program"): $seconds s"
    fuzz "$program" &
    [ $((count % 2)) = 1 ] || wait
done
wait
if [ $count = 0 ]; then
    echo "no fuzz targets under $build/tests/fuzz" >&2
    exit 2
fi
echo "fuzzing:"
cat "$build"/fuzz/*/summary
[ "$(cat "$build"/fuzz/*/summary | grep -c ': ok, ')" = $count ]
