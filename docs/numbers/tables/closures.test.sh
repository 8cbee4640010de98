# Steady a_22 by closures, and the C_I that each needs for a measured one.
shearbed bench --case closures --out c >log
# The picture of the same run.
cmp c/closures-error.svg "$ROOT/docs/src/images/closures-error.svg" >&2 || { echo "bash docs/pictures.sh docs/src/images closures-error" >&2; exit 1; }
awk -F, -v order="natural ORE ORW IBOF hybrid quadratic" '
  BEGIN { n = split(order, closure, " ") }
  FNR == 1 { file++ }
  file == 1 && $1 == "shear" && ($2 == "0.0311" || $2 == "0.001") { a22[$2, $3] = $4; exact[$2] = $5 }
  file == 2 { c_i[$1] = $3 }
  END {
    split("0.0311 0.001", at, " ")
    for (k = 1; k <= 2; k++) {
      mark = at[k] == "0.0311" ? "<!--=diffusion.a22-0.0311-->" : ""
      printf "| %s | %.4f%s |", at[k], exact[at[k]], mark
      for (i = 1; i <= n; i++) printf " %.4f |", a22[at[k], closure[i]]
      print ""
    }
    printf "| fitted to $a_{22}$ = 0.8261 | %.4f |", c_i["exact"]
    for (i = 1; i <= n; i++) printf " %.4f |", c_i[closure[i]]
    print ""
  }' c/closures.csv c/closures-fitted.csv
