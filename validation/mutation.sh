#!/usr/bin/env bash
# Mutation testing of the core: cargo-mutants changes one place at a time. The core's own tests judge each mutant first; the
# suite's (minutes each) judge those that they miss. Prints what neither catches and docs/strength.md does not explain; exit 2 then.
# Usage: bash validation/mutation.sh [OPTIONS OF cargo mutants]
#   all of it, some 20 hours on two cores:      bash validation/mutation.sh
#   one mutant of 24, an even sample:           bash validation/mutation.sh --sharding round-robin --shard 7/24
#   the lines that changed since a commit:      git diff COMMIT >changes && bash validation/mutation.sh --in-diff changes
set -euo pipefail
diff=()
if [ "${1:-}" = --in-diff ]; then
  diff=(--in-diff "$(realpath "$2")")
  shift 2
fi
cd "$(dirname "$0")/.."
out=target/mutation
rm -rf "$out"
mkdir -p "$out"/{own,suite}

# Exit 2 and 3 are mutants that were missed or ran too long: no failure of the run itself.
mutants() {
  cargo mutants --package shearbed --minimum-test-timeout 60 --no-times --cargo-arg=--locked "$@" || [ $? = 2 ] || [ $? = 3 ]
}
mutants --output "$out/own" --profile mutation "${diff[@]}" "$@"
if [ ! -s "$out/own/mutants.out/missed.txt" ]; then
  echo "mutation: nothing was missed by the core's own tests"
  exit 0
fi

again=()
while read -r name; do
  again+=(--re "^$(sed 's/[][\.*+?(){}|^$]/\\&/g' <<<"$name")\$")
done <"$out/own/mutants.out/missed.txt"
# Of cargo-mutants 27.1, --re lets all deleted fields through.
grep -q 'delete field' "$out/own/mutants.out/missed.txt" || again+=(--exclude-re 'delete field')
mutants --output "$out/suite" --baseline skip --timeout 600 --test-package shearbed-suite "${again[@]}" -- --lib --test gate --test program

# A place moves with the lines above it; the file, what is replaced and the function do not.
without_place() { sed -E 's/^([^:]+):[0-9]+:[0-9]+: /\1: /'; }
sed -n 's/^- `\(src\/.*\)`: .*/\1/p' docs/strength.md >"$out/explained.txt"
missed=$(without_place <"$out/suite/mutants.out/missed.txt" | grep -vxFf "$out/explained.txt" || true)
if [ -n "$missed" ]; then
  printf 'mutation: caught by no test:\n%s\n' "$missed"
  exit 2
fi
echo "mutation: what the core's own tests missed, the suite's caught, or docs/strength.md explains"
