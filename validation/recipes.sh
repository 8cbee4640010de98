#!/usr/bin/env bash
# Follows CONTRIBUTING's recipes that need another program: adds a key, a command and a reference problem to a copy of the sources, as
# recipes/*.diff show them, and asks the program that is built from it for each of them; and makes a crate that uses the library.
# Usage: bash validation/recipes.sh
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
beside=$(mktemp -d)
trap 'rm -rf "$beside"' EXIT
copy=$beside/shearbed
mkdir "$copy"
cd "$root"
git ls-files -z | xargs -0 cp --parents -t "$copy"
# A folder of its own: cargo would take the copy's program for that of the sources.
export CARGO_TARGET_DIR=$root/target/recipes
# Other people's crates as they are built already: links, which take no room; none if another build changes them meanwhile.
if [ -d "$root/target/debug/deps" ] && [ ! -e "$CARGO_TARGET_DIR" ]; then
  mkdir -p "$CARGO_TARGET_DIR/debug"
  cp -al "$root"/target/debug/{deps,build,.fingerprint} "$CARGO_TARGET_DIR/debug/" || rm -rf "$CARGO_TARGET_DIR"
fi
cd "$copy"
git init --quiet
git apply --verbose validation/recipes/*.diff
cargo build --locked --quiet
shearbed=$CARGO_TARGET_DIR/debug/shearbed

says() { # WORDS COMMAND…: what the command prints has these words, whatever its exit code.
  local words=$1 printed
  shift
  printed=$("$@" 2>&1) || true
  grep -qF -- "$words" <<<"$printed" || { echo "$*: no '$words' in: $printed" >&2; exit 1; }
}
says "liquid.density_kg_per_m3 [kg/m³]" "$shearbed" scenes --keys
says "the rods' Reynolds number is" "$shearbed" plan fig4-n50 --set liquid.density_kg_per_m3=1e9 --set liquid.viscosity_pa_s=1
says "liquid.density_kg_per_m3 = -1 is not allowed: expected a finite number > 0" "$shearbed" plan fig4-n50 --set liquid.density_kg_per_m3=-1
says 73.4266 "$shearbed" period 11.6
says "shearbed period 11.6" "$shearbed" period --help
says "mid-flip-50" "$shearbed" problems
# The generated pages and the schema take up all three.
UPDATE_DOCS=1 cargo test --locked --quiet -p shearbed-cli --test docs generated
for made in "docs/src/reference/keys.md density_kg_per_m3" "docs/src/reference/commands.md shearbed period" "validation/schemas/scene.json density_kg_per_m3"; do
  says "${made#* }" cat "${made%% *}"
done
# A crate of one's own, by the commands at the head of its source; with the versions of this repository.
cd "$beside"
says "observed order 2.0" bash -ec "$(sed -n 's|^//! \(c[apo].*\)|\1|p' "$root/validation/recipes/own_method.rs" | sed 's,cd my_method,& \&\& cp ../shearbed/Cargo.lock .,')"
echo "recipes: a key, a command and a problem were added and found, and a crate of one's own shows its order"
