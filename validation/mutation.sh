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
out=target/mutants
mkdir -p "$out"
cargo mutants --list --json "$@" >"$out/list.json"
if ! grep -q '"name"' "$out/list.json"; then
  echo "mutation: nothing to change there"
  exit 0
fi
# What the copy is built from is built already: cargo goes by its times.
if [ -d target/debug/deps ] && [ ! -d "$out/target" ]; then
  mkdir -p "$out/target/debug/deps"
  cp -a target/debug/build target/debug/.fingerprint "$out/target/debug/"
  find target/debug/deps -name 'lib*' -exec cp -a -t "$out/target/debug/deps" {} +
fi
cargo run --locked --quiet -p shearbed-suite --example mutants -- "$out/list.json" --seconds 600

if [ -s "$out/left.txt" ]; then
  names=()
  while read -r name; do
    names+=(--re "^$(sed 's/[][\.*+?(){}|^$]/\\&/g' <<<"$name")\$")
  done <"$out/left.txt"
  # Of cargo-mutants 27.1, --re lets all deleted fields through.
  grep -q 'delete field' "$out/left.txt" || names+=(--exclude-re 'delete field')
  # Exit 2 and 3 are mutants that were missed or ran too long.
  cargo mutants --output "$out" --profile mutation --minimum-test-timeout 60 --no-times --cargo-arg=--locked --test-workspace=false \
    "$@" "${names[@]}" || [ $? = 2 ] || [ $? = 3 ]
  cat "$out/mutants.out/missed.txt" >>"$out/open.txt"
fi

# A place moves with the lines above it; the file, what is replaced and the function do not.
sed -n 's/^- `\([^`]*\.rs: .*\)`: .*/\1/p' docs/strength.md >"$out/explained.txt"
if sed -E 's/^([^:]+):[0-9]+:[0-9]+: /\1: /' "$out/open.txt" | grep -vxFf "$out/explained.txt"; then
  echo "mutation: caught by no test"
  exit 2
fi
echo "mutation: every one was caught, or docs/strength.md explains it"
