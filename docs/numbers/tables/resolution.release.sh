# Errors of X̄₁(T/2) against the step, 20 rods per cm³.
example resolution 2000 11.6 17 50 100 |
  awk -F' *[|] *' '$4 == 20 {
    split($5, fine, " ")
    printf "| %s | %s |", $2, fine[1]
    for (k = 6; k <= 11; k++) if (k != 9 && k != 10) { split($k, found, " "); sub("-", "−", found[1]); printf " %s |", found[1] }
    print ""
  }'
