#!/usr/bin/env bash
# Makes docs/numbers.tsv, and the numbers of the book and the READMEs that are marked as `0.326<!--=fig4.x1-->`. Each row has the
# command that prints its number, run in an empty folder with the program on the PATH and the repository in $ROOT. So are the scripts of
# docs/numbers/tables, which print the rows of the table that stands before the line `<!--table:NAME-->`.
# Usage: bash docs/numbers.sh [release]      with `release` also what takes minutes to hours
set -euo pipefail
export ROOT=$(cd "$(dirname "$0")/.." && pwd)
cargo build --locked --quiet --manifest-path "$ROOT/validation/cli/Cargo.toml"
export PATH="$ROOT/target/debug:$PATH"
table=$ROOT/docs/numbers.tsv
work=$(mktemp -d)
export KEPT=$work/kept
mkdir "$KEPT"
# kept NAME COMMAND...: what the command prints; run once, however many rows and tables ask for it.
kept() {
  [ -f "$KEPT/$1" ] || { "${@:2}" >"$KEPT/$1.part" && mv "$KEPT/$1.part" "$KEPT/$1"; }
  cat "$KEPT/$1"
}
# example NAME ARGUMENT...: what an example prints, kept.
example() {
  kept "$*" cargo run --release --quiet --manifest-path "$ROOT/validation/Cargo.toml" --example "$1" -- "${@:2}"
}
export -f kept example
trap 'rm -rf "$work"' EXIT
head -n 1 "$table" >"$work/table"
tail -n +2 "$table" | while IFS=$'\t' read -r id value when command; do
  if [ "$when" = test ] || [ "${1:-}" = "$when" ]; then
    mkdir "$work/$id"
    found=$(cd "$work/$id" && bash -euo pipefail -c "$command" </dev/null)
    if [ "$found" != "$value" ]; then
      echo "$id: $value is now $found" >&2
      grep -rlF -- "<!--=$id-->" "$ROOT"/docs/src "$ROOT"/*.md "$ROOT"/*/README.md |
        xargs -r perl -pi -e 'BEGIN { ($was, $is, $id) = splice @ARGV, 0, 3 } s/\Q$was<!--=$id-->/$is<!--=$id-->/g' "$value" "$found" "$id"
    fi
    value=$found
  fi
  printf '%s\t%s\t%s\t%s\n' "$id" "$value" "$when" "$command" >>"$work/table"
done
cp "$work/table" "$table"
for script in "$ROOT"/docs/numbers/tables/*.sh; do
  name=$(basename "$script" .sh)
  when=${name##*.} name=${name%.*}
  if [ "$when" = test ] || [ "${1:-}" = "$when" ]; then
    mkdir "$work/$name"
    rows=$(cd "$work/$name" && bash -euo pipefail "$script" </dev/null)
    ROWS=$rows NAME=$name perl -0pi -e 's/(\n\|(?: --- \|)+\n)(?:\|[^\n]*\n)*(?=<!--table:\Q$ENV{NAME}\E-->)/$1$ENV{ROWS}\n/' "$ROOT"/docs/src/*/*.md
  fi
done
