#!/usr/bin/env bash
# Makes the pictures of README and book: all that take a few seconds, those that take longer too, or the named ones.
# The test `docs` compares them byte for byte: the quick ones, and with DOCS_SLOW all.
# Usage: bash docs/pictures.sh DIR [slow | NAME...]      into DIR, as `bash docs/pictures.sh made damping`; builds the program if it is not installed
set -euo pipefail
ROOT=$(cd "$(dirname "$0")/.." && pwd)
mkdir -p "$1"
out=$(cd "$1" && pwd)
shift
if ! command -v shearbed >/dev/null; then
  cargo build --locked --quiet --manifest-path "$ROOT/validation/cli/Cargo.toml"
  PATH="$ROOT/target/debug:$PATH"
fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# The scene of a page's first block that writes it.
scene() { awk "/^cat > cell.toml/ { on = 1; next } /^END/ { exit } on" "$ROOT/docs/src/user/$1.md" >cell.toml; }

draw_diagrams() { python3 "$ROOT/docs/diagrams.py" "$out"; }

draw_fig4-n50() {
  shearbed run fig4-n50 --replicas 400 --out fig4 --quiet
  cp fig4/projections.svg "$out/fig4-n50.svg"
}

draw_damping() {
  scene first-run
  shearbed run cell.toml --out cell --quiet
  shearbed run cell.toml --set interaction.alpha=0 --out no-collisions --quiet
  shearbed run cell.toml --set interaction.alpha=0 --set particles.aspect_ratio_sd_percent=0 --out equal-rods --quiet
  shearbed plot cell no-collisions equal-rods --y x1 --out "$out/damping.svg" >/dev/null
}

draw_lengths() {
  (echo length_mm; for _ in {1..50}; do echo 0.36; echo 1.08; done) >mix.csv
  of() {
    shearbed run fig4-n50 --set 'title="Rods of several lengths"' --set time.periods=2 --replicas 400 "${@:2}" --out "$1" --quiet
  }
  of "all of 0.36 mm" --set particles.length_mm=0.36
  of "all of 0.72 mm"
  of "30 % scatter" --set particles.length_sd_percent=30
  of "half 0.36, half 1.08 mm" --set 'particles.rods={file="mix.csv"}'
  of "all of 1.08 mm" --set particles.length_mm=1.08
  shearbed plot "all of 0.36 mm" "all of 0.72 mm" "30 % scatter" "half 0.36, half 1.08 mm" "all of 1.08 mm" --y x1 \
    --out "$out/lengths.svg" >/dev/null
}

draw_collapse() {
  shearbed sweep fig8-a0.72 --set time.periods=1 --set 'title="Rods of Figs 7 and 8"' --replicas 100 --out collapse --quiet \
    --over interaction.alpha=0.1,0.2,0.4,0.8,1.6,3.2 --over interaction.concentration_per_cm3=20,100 --over particles.length_mm=0.36,1.44
  shearbed plot collapse --y x1_amplitude --x 'interaction.alpha*particles.length_mm*interaction.concentration_per_cm3^(1/3)' --log-x \
    --out "$out/collapse.svg" >/dev/null
}

draw_rods() {
  of() { shearbed run fig4-n50 --set time.periods=2 --out "$1" "${@:2}" --quiet; }
  of one --replicas 1 --set output.rods_every=4
  of many --replicas 400
  python3 "$ROOT/docs/moving.py" one/rods.csv many/projections.csv >"$out/rods.svg"
}

draw_fit-points() {
  scene fitting
  # The page's own points.
  awk '/^shearbed run cell.toml --set/ { on = 1 } /^head/ { exit } on' "$ROOT/docs/src/user/fitting.md" >points.sh
  bash -euo pipefail points.sh
  shearbed fit cell.toml --data points.csv --rods 1000 --over interaction.alpha=0.05:5 --out fit --quiet 2>/dev/null
  cp fit/points.svg "$out/fit-points.svg"
}

# Pictures of a bench: its name, and theirs.
bench() {
  shearbed bench --case "$1" --out bench --quiet
  for picture in "${@:2}"; do cp "bench/$picture.svg" "$out/"; done
}
draw_orders() { bench re11.6 orders; }
draw_closures-error() { bench closures closures-error; }
draw_brownian() { bench brownian brownian-start-up brownian-relaxation brownian-angle; }
draw_folgar-tucker() { bench folgar-tucker effective-ci folgar-tucker kicks-and-diffusion steady-orbits; }

names=(fig4-n50 damping lengths collapse brownian)
if command -v python3 >/dev/null; then names+=(diagrams rods); fi
case ${1:-} in
'') ;;
slow) names+=(orders fit-points closures-error folgar-tucker) ;;
*) names=("$@") ;;
esac
for name in "${names[@]}"; do
  declare -F "draw_$name" >/dev/null || { echo "no picture has the name $name" >&2; exit 2; }
  mkdir "$work/$name"
  cd "$work/$name"
  "draw_$name"
done
