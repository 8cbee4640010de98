# How often the intervals of whole fits hold the planted values: hours.
rows() {
  example fit_covers "$@" |
    awk '
      function share(text) { sub(/ %.*/, "", text); p = text / 100; e = 100 * sqrt(p * (1 - p) / fits); return e ? sprintf("%.0f ± %.0f %%", text, e) : "100 %" }
      BEGIN { split("α|m|r_e|the spread|n", label, "|"); split("alpha|m|aspect_ratio|aspect_ratio_sd_percent|concentration", start, "|") }
      /^# answered/ { fits = $3; chi_square = $11 + 0 }
      /interval .* interval/ {
        key = substr($2, 1, length($2) - 1); sub(/_per_cm3.*/, "", key)
        for (k = 1; k <= 5; k++) if (key == start[k]) name[++keys] = label[k]
        split($0, part, "interval "); inner[keys] = share(part[2]); outer[keys] = share(part[3])
      }
      END {
        for (k = 1; k <= keys; k++) {
          with = keys == 1 ? "" : ", with " (name[3 - k] == "the spread" ? "the spread of r_e" : name[3 - k])
          printf "| %s%s | %d | %s | %s |", name[k], with, fits, inner[k], outer[k]
          print k == 1 ? sprintf(" %.3f ± %.3f |", chi_square, sqrt(2 / ((40 - keys) * fits))) : " |"
        }
      }'
}
alpha=interaction.alpha=0.2:3
rows 800 $alpha
rows 100 $alpha interaction.m=1.2:6
rows 60 particles.aspect_ratio=10:30
rows 50 $alpha particles.aspect_ratio_sd_percent=0:20
rows 90 $alpha particles.aspect_ratio=10:30
rows 50 $alpha interaction.concentration_per_cm3=500:5000
