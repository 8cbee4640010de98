#!/usr/bin/env bash
# Mutation testing with cargo-mutants: each change of the core that its own tests do not catch is tried on the gate.
# .cargo/mutants.toml lists the changes that change no result. Exit 2 where a change is caught by nothing.
# Usage: bash validation/mutation.sh [OPTIONS OF cargo mutants]
#   of all: bash validation/mutation.sh
#   of what changed since COMMIT: git diff COMMIT -- src >changes && bash validation/mutation.sh --in-diff changes
set -euo pipefail
cd "$(dirname "$0")/.."
out=target/mutants
common=(--package shearbed --profile mutation --minimum-test-timeout 60 --no-times --cargo-arg=--locked)
mkdir -p "$out"
cargo mutants --output "$out" "${common[@]}" "$@" || [ $? = 2 ] || [ $? = 3 ]
missed=$out/mutants.out/missed.txt
if [ ! -s "$missed" ]; then
  echo "mutation: every one was caught by the core's tests"
  exit 0
fi
names=()
while read -r name; do
  names+=(--re "^$(sed 's/[][\.*+?(){}|^$]/\\&/g' <<<"$name")\$")
done <"$missed"
cargo mutants --output "$out/gate" "${common[@]}" --test-package shearbed-validation "${names[@]}" -- --test gate
