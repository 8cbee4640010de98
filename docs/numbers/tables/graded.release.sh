# Right and wrong integrators by the grader's verdict. The program ends with 1 where a verdict is wrong.
kept graded bash -c 'cargo run --release --quiet --manifest-path "$ROOT/validation/Cargo.toml" --example graded_integrators -- --all --quick || true' |
  awk -F' *[|] *' '
    BEGIN {
      split("Runge–Kutta 1–8|multistep 2–4|implicit, symplectic 1–6|Lie-group 1–4|splitting 1–4|adaptive 3(2)–8(5,3)", names, "|")
      split("Runge–Kutta|multistep|implicit|Lie-group|splitting|adaptive", starts, "|")
    }
    $4 ~ /^[0-9]+$/ {
      for (k = 1; k <= 6; k++) if (index($2, starts[k]) == 1) family = k
      split($9, verdict, " of ")
      if ($2 ~ /one coefficient wrong/) { wrong[family] += $3; found[family] += verdict[1] }
      else { right[family] += $3; failed[family] += verdict[2] - verdict[1] }
    }
    END { for (k = 1; k <= 6; k++) printf "| %s | %d | %d | %d | %d |\n", names[k], right[k], failed[k], wrong[k], found[k] }'
