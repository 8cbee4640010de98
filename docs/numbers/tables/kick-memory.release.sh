# Kicks above 0.1 rad by the side of the gap, at a coarse and a fine step.
example time_step full |
  awk -F' *[|] *' '
    /^$/ { tables += said; said = 0 }
    /^[|]/ { said = 1 }
    tables == 0 && ($2 == 50 || $2 == 12800) { printf "| %s | %s | %s | %s | %s |\n", $2 == 50 ? 50 : "12,800", $8, $9, $10, $11 }'
