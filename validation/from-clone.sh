#!/usr/bin/env bash
# Wall and CPU seconds from a fresh clone of this commit to an installed program, to the report and to a green gate. Packages
# are fetched first, which is not timed.
set -euo pipefail
from=$(cd "$(dirname "$0")/.." && pwd)
clone=$(mktemp -d)
trap 'rm -rf "$clone"' EXIT
git clone --quiet "$from" "$clone"
cd "$clone"
unset CARGO_TARGET_DIR
cargo fetch --quiet --locked
TIMEFORMAT='%R s wall, %U s user, %S s system'
step() {
  echo "== $*"
  time "$@" >"$clone/log" 2>&1 || { tail -50 "$clone/log"; exit 1; }
}
step cargo install --locked --path validation/cli --root "$clone/installed"
step cargo build --locked
step cargo run --locked -- validate
step cargo test --locked --no-run
step cargo test --locked
