#!/usr/bin/env bash
# Makes the pictures of README and book. The test `docs` compares them byte for byte: those of seconds, and with DOCS_SLOW those of a minute.
# Usage: bash docs/pictures.sh DIR [slow|release]      into DIR; with `release` also what takes minutes and no test compares
set -euo pipefail
ROOT=$(cd "$(dirname "$0")/.." && pwd)
mkdir -p "$1"
out=$(cd "$1" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

if command -v python3 >/dev/null; then python3 "$ROOT/docs/diagrams.py" "$out"; fi

shearbed run fig4-n50 --replicas 400 --out fig4 --quiet
cp fig4/projections.svg "$out/fig4-n50.svg"

# The scene of a page's first block that writes it.
scene() { awk "/^cat > cell.toml/ { on = 1; next } /^END/ { exit } on" "$ROOT/docs/src/user/$1.md" >cell.toml; }

scene first-run
shearbed run cell.toml --out cell --quiet
shearbed run cell.toml --set interaction.alpha=0 --out no-collisions --quiet
shearbed run cell.toml --set interaction.alpha=0 --set particles.aspect_ratio_sd_percent=0 --out equal-rods --quiet
shearbed plot cell no-collisions equal-rods --y x1 --out "$out/damping.svg" >/dev/null

(echo length_mm; for _ in {1..50}; do echo 0.36; echo 1.08; done) >mix.csv
lengths() {
  shearbed run fig4-n50 --set 'title="Rods of several lengths"' --set time.periods=2 --replicas 400 "${@:2}" --out "$1" --quiet
}
lengths "all of 0.36 mm" --set particles.length_mm=0.36
lengths "all of 0.72 mm"
lengths "30 % scatter" --set particles.length_sd_percent=30
lengths "half 0.36, half 1.08 mm" --set 'particles.rods={file="mix.csv"}'
lengths "all of 1.08 mm" --set particles.length_mm=1.08
shearbed plot "all of 0.36 mm" "all of 0.72 mm" "30 % scatter" "half 0.36, half 1.08 mm" "all of 1.08 mm" --y x1 \
  --out "$out/lengths.svg" >/dev/null

shearbed sweep fig8-a0.72 --set time.periods=1 --set 'title="Rods of Figs 7 and 8"' --replicas 100 --out collapse --quiet \
  --over interaction.alpha=0.1,0.2,0.4,0.8,1.6,3.2 --over interaction.concentration_per_cm3=20,100 --over particles.length_mm=0.36,1.44
shearbed plot collapse --y x1_amplitude --x 'interaction.alpha*particles.length_mm*interaction.concentration_per_cm3^(1/3)' --log-x \
  --out "$out/collapse.svg" >/dev/null
[ -n "${2:-}" ] || exit 0

moving() { shearbed run fig4-n50 --set time.periods=2 --out "$1" "${@:2}" --quiet; }
moving one --replicas 1 --set output.rods_every=4
moving many --replicas 400
python3 "$ROOT/docs/moving.py" one/rods.csv many/projections.csv >"$out/rods.svg"

shearbed bench --case re11.6 --out rk --quiet
cp rk/orders.svg "$out/orders.svg"

scene fitting
# The page's own points.
awk '/^shearbed run cell.toml --set/ { on = 1 } /^head/ { exit } on' "$ROOT/docs/src/user/fitting.md" >points.sh
bash -euo pipefail points.sh
shearbed fit cell.toml --data points.csv --rods 1000 --over interaction.alpha=0.05:5 --out fit --quiet 2>/dev/null
cp fit/points.svg "$out/fit-points.svg"

shearbed bench --case closures --out closures --quiet
cp closures/closures-error.svg "$out/closures-error.svg"
shearbed bench --case brownian --out brownian --quiet
cp brownian/brownian-*.svg "$out"
[ "$2" = release ] || exit 0

shearbed bench --case folgar-tucker --out ci --quiet
for picture in effective-ci folgar-tucker kicks-and-diffusion steady-orbits; do cp "ci/$picture.svg" "$out/$picture.svg"; done
