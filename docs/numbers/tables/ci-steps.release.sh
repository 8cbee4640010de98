# C_I, N₁ and means against the step, by each update.
kept ci-steps python3 "$ROOT/docs/numbers/effective_ci.py" shearbed ci steps |
  awk -F' *[|] *' '
    $2 ~ /^(kick|rotation|angles)$/ && $6 ~ /^(200|800|3200|6400)$/ {
      first = !($2 in rows)
      split($13, n1, " "); split($15, x1, " "); split($16, a11, " "); split($17, a22, " ")
      c_i = $7; sub(/ .*/, "", c_i); sub("-", "−", c_i)
      if ($2 == "kick" && first) { $6 = "200 (default)"; c_i = $7 "<!--=ci.kick-->" }
      rows[$2] = rows[$2] "|" (first ? " `" $2 "` " : " ") \
        sprintf("| %s | %s | %.1f | %.4f | %.4f | %.3f |\n", $6, c_i, 1e4 * n1[1], x1[1], a11[1], a22[1])
    }
    END { printf "%s", rows["kick"] rows["rotation"] rows["angles"] }'
