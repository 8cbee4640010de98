#!/usr/bin/env bash
# Mutation testing: cargo-mutants says what could be changed, one place at a time, and the tests that reach the place judge each
# change. All changes are built at once, each behind a switch (validation/examples/mutants); what no switch reaches, constants and
# `const fn`, is built one by one by cargo-mutants. Exit 2 where a change is caught by no test and docs/strength.md does not explain it.
# Usage: bash validation/mutation.sh [OPTIONS OF cargo mutants --list]
#   the core:                                    bash validation/mutation.sh --package shearbed
#   the acceptance rules:                        bash validation/mutation.sh --package shearbed-suite --file 'validation/src/accept/*.rs'
#   the core's lines that changed since COMMIT:  git diff COMMIT -- src >changes && bash validation/mutation.sh --package shearbed --in-diff changes
set -euo pipefail
cd "$(dirname "$0")/.."
mkdir -p target/mutants
cargo mutants --list --json "$@" >target/mutants.json
# What the copy is built from is built already: cargo goes by its times.
copy=target/mutants/tree/target/debug
if [ -d target/debug/deps ] && [ ! -d "$copy" ]; then
  mkdir -p "$copy/deps"
  cp -a target/debug/build target/debug/.fingerprint "$copy/"
  find target/debug/deps -name 'lib*' -exec cp -a -t "$copy/deps" {} +
fi
code=0
cargo run --locked --quiet -p shearbed-suite --example mutants -- target/mutants.json --seconds 600 || code=$?
[ "$code" = 0 ] || [ "$code" = 2 ] || exit "$code"
left=target/mutants/left.txt
[ -s "$left" ] || exit "$code"

names=()
while read -r name; do
  names+=(--re "^$(sed 's/[][\.*+?(){}|^$]/\\&/g' <<<"$name")\$")
done <"$left"
# Of cargo-mutants 27.1, --re lets all deleted fields through.
grep -q 'delete field' "$left" || names+=(--exclude-re 'delete field')
# Exit 2 and 3 are mutants that were missed or ran too long.
cargo mutants --output target/mutants --profile mutation --minimum-test-timeout 60 --no-times --cargo-arg=--locked --test-workspace=false \
  "$@" "${names[@]}" || [ $? = 2 ] || [ $? = 3 ]
# A place moves with the lines above it; the file, what is replaced and the function do not.
sed -n 's/^- `\([^`]*\.rs: .*\)`: .*/\1/p' docs/strength.md >target/mutants/explained.txt
if sed -E 's/^([^:]+):[0-9]+:[0-9]+: /\1: /' target/mutants/mutants.out/missed.txt | grep -vxFf target/mutants/explained.txt; then
  code=2
fi
exit "$code"
