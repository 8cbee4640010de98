#!/usr/bin/env bash
# Whether two programs give the same bits: every built-in scene with few replicas, and the evidence of the whole report.
# Usage: bash validation/same.sh OLD_PROGRAM NEW_PROGRAM      (exit 1 where a file differs, whose name is printed)
set -euo pipefail
old=$(realpath "$1") new=$(realpath "$2")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
evidence() {
  python3 - "$1" <<'PY'
import json, sys
report = json.load(open(sys.argv[1]))
print(json.dumps([[case["name"], case["verdict"], case["evidence"], case["controls"]] for case in report["cases"]], indent=1))
PY
}
for side in old new; do
  mkdir "$work/$side"
  cd "$work/$side"
  "${!side}" scenes | awk '{print $1}' | while read -r scene; do
    "${!side}" run "$scene" --replicas 3 --quiet --out "$scene" 2>/dev/null
  done
  "${!side}" validate --out report >/dev/null
  evidence report/report.json >evidence.json
  # What holds seconds differs from run to run.
  find . -name '*.csv' -o -name evidence.json | grep -vE '/(speed|work-precision|suspension-s|exact-against)' | sort | xargs cksum >sums
done
diff "$work/old/sums" "$work/new/sums" && echo "same bits: $(wc -l <"$work/new/sums") files"
