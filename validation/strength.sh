#!/usr/bin/env bash
# Takes the numbers of docs/src/verification/error-rates.md, as for a release: false alarms, intervals of fits, mutated inputs, mutants.
# What each prints is kept in out/strength. What turned red stands in the tables of the first three; a reader at fault, a
# mutant that nothing caught end it. Half a day on two cores.
# Usage: bash validation/strength.sh [SEEDS [SEEDS OF --full [FITS [INPUTS]]]]     (200 20 800 1000000)
set -euo pipefail
cd "$(dirname "$0")/.."
seeds=${1:-200} full=${2:-20} fits=${3:-800} inputs=${4:-1000000}
kept=out/strength
mkdir -p "$kept"
cargo build --release --locked --quiet --workspace --bins --examples

keep() {
  echo "strength: $1"
  target/release/examples/"${@:2}" 2>&1 | tee "$kept/$1.txt"
}
keep seeds strength "$seeds"
keep seeds-full strength "$full" full
keep fits fit_covers "$fits"
for readers in scene sweep checkpoint data problems answers fits plots; do
  keep "inputs-$readers" fuzz "$readers" "$inputs" 21
done
echo "strength: mutants"
bash validation/mutation.sh 2>&1 | tee "$kept/mutants.txt"
