# Rods off Jeffery's motion by more than an angle, in per cent: kicks of 800 steps a period, and diffusion.
kept folgar-tucker shearbed bench --case folgar-tucker --out "$KEPT/folgar-tucker.out" >/dev/null
awk -F, '
  function share(k) { return $k == 0 ? "0" : sprintf("%.*f ± %.*f", digits[k], $k, digits[k], $(k + 1)) }
  NR == 1 { for (k = 1; k <= NF; k++) column[$k] = k; next }
  $1 == 4 {
    near = column["> 0.01 rad"]; far = column["> 0.1 rad"]; farthest = column["> 0.5 rad"]; orbit = column["C_b > 0.5"]
    digits[near] = 3; digits[far] = $3 == "kicks" ? 3 : 4; digits[farthest] = 4; digits[orbit] = 2
    printf "| %s | %s | %s | %s | %s |\n", $3, share(near), share(far), share(farthest), share(orbit)
  }' "$KEPT/folgar-tucker.out/kicks-and-diffusion.csv"
