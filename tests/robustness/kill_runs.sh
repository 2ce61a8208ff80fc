#!/bin/bash
# Ends `undula solve` and `undula train` at random moments and restarts them: the restarted run has to end with
# the tables, the state and the model of a run that nobody disturbed, bit for bit.
#
#   UNDULA=build/release/undula SAME_MODEL=build/release/same_model tests/robustness/kill_runs.sh 500 100 50
#
# Arguments: kills (SIGKILL) of solve, signals (SIGTERM and SIGINT in turns) of solve, kills of train. A run that
# ended before its kill does not count. UNDULA_SEED chooses the moments.
set -u
set -m # children do not ignore SIGINT
kills=${1:-500} signals=${2:-100} trainings=${3:-50}
undula=$(realpath "${UNDULA:?the undula binary}") same_model=$(realpath "${SAME_MODEL:?the same_model binary}")
data=$(realpath "$(dirname "$0")/../../data")
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMP_NUM_THREADS=1
RANDOM=${UNDULA_SEED:-1}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 2

fail() {
  echo "FAILED: $*"
  tail -n 20 err.txt
  exit 1
}

sed 's/^end_s = 0.1$/end_s = 0.8/' "$data/../tests/data/post_in_channel.toml" > post.toml
cat >> post.toml << 'END'
[output]
checkpoint_every = 3
fields_every = 20
END

solve="$undula solve post.toml"
train="$undula train $data/scenes/wave_pump_fixed.toml --set mesh.gap_elements=2 --set mesh.channel_size_mm=2
  --set mesh.membrane_size_mm=1 --set mesh.growth=0.6 --set time.steps_per_period=24 --set time.periods=3
  --set training.snapshots_per_period=24 --set training.periodic_tolerance=0.9 --set training.training_points=0
  --set training.held_out_points=3"

# A random moment (ms) in the first $1 milliseconds.
moment() { echo "$((RANDOM * 32768 + RANDOM)) $1" | awk '{ printf "%.3f", $1 % $2 / 1000 }'; }
milliseconds() { date +%s%3N; }

# Runs "$@" in the background and sends it $1 at a random moment of its $2 ms; true if it was there to get it.
disturb() {
  local signal=$1 duration=$2 child
  shift 2
  "$@" > out.txt 2> err.txt &
  child=$!
  sleep "$(moment "$duration")"
  kill -s "$signal" $child 2> /dev/null
  wait $child 2> /dev/null
  code=$?
  case $signal in
    KILL) [ $code -eq 137 ] ;;
    *) [ $code -eq 1 ] && grep -q "stopped by SIG$signal" err.txt || [ $code -eq $((128 + $(kill -l "$signal"))) ] ;;
  esac
}

same_run() {
  for file in time_series.csv statistics.csv {fluid,solids}_{20,40,60,80}.h5 checkpoints/checkpoint_80.h5; do
    cmp -s "whole/$file" "run/$file" || fail "$1: $file differs"
  done
  for file in fluid.xdmf solids.xdmf; do # a restart names the fields of a step in another order
    cmp -s <(sort "whole/$file") <(sort "run/$file") || fail "$1: $file differs"
  done
  [ -z "$(find run -name '*.partial')" ] || fail "$1: leftovers"
}

begin=$(milliseconds)
$solve --output whole > out.txt 2> err.txt || fail "the undisturbed solve"
duration=$(($(milliseconds) - begin))
echo "solve takes $duration ms undisturbed"

# Each run is disturbed again and again until it is through or three times, then restarted for good.
solve_disturbed() { # name of the signals..., number
  local count=$1 done_=0 through=0
  shift
  while [ $done_ -lt "$count" ]; do
    rm -rf run
    for attempt in 1 2 3; do
      local names=("$@") signal
      signal=${names[$((done_ % ${#names[@]}))]}
      if disturb "$signal" "$duration" $solve --output run $([ -e run/scene_resolved.toml ] && echo --restart); then
        done_=$((done_ + 1))
      elif [ $code -eq 0 ]; then
        through=$((through + 1))
        break
      else
        fail "$signal: exit code $code"
      fi
      [ $done_ -lt "$count" ] || break
    done
    $solve --output run --restart > out.txt 2> err.txt || fail "the restart after $signal"
    same_run "$signal"
  done
  echo "solve: $count times $* without loss ($through runs were through before)"
}
[ "$kills" -eq 0 ] || solve_disturbed "$kills" KILL
[ "$signals" -eq 0 ] || solve_disturbed "$signals" TERM INT

[ "$trainings" -eq 0 ] && exit 0
begin=$(milliseconds)
$train --output whole.h5 > out.txt 2> err.txt || fail "the undisturbed train"
duration=$(($(milliseconds) - begin))
echo "train takes $duration ms undisturbed"
done_=0
while [ $done_ -lt "$trainings" ]; do
  rm -rf model.h5 model.h5.*
  for attempt in 1 2 3 4 5 6; do
    [ $done_ -lt "$trainings" ] || break
    if disturb KILL "$duration" $train --output model.h5; then
      done_=$((done_ + 1))
    elif [ $code -eq 0 ]; then
      break
    else
      fail "train: exit code $code"
    fi
  done
  $train --output model.h5 > out.txt 2> err.txt || fail "the restart of train"
  "$same_model" whole.h5 model.h5 || fail "train: the model differs"
  [ -z "$(find . -name '*.partial')" ] || fail "train: leftovers"
done
echo "train: $trainings times KILL without loss"
