# C_I, residual and stress of suspensions.
kept ci-suspensions python3 "$ROOT/docs/numbers/effective_ci.py" shearbed ci suspensions |
  awk -F' *[|] *' '$2 == "kick" && $3 != 0.1 && $4 != 20 {
    split($11, residual, " "); split($12, s, " "); split($13, n1, " "); split($14, n2, " ")
    printf "| %s | %s | %s | %s | %.2f | %.4f | %.1f | %.1f |\n", $3, $4, $5, $7, residual[1], s[1], 1e4 * n1[1], 1e4 * n2[1]
  }'
