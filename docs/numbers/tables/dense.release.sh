# X̄₁(2T) against the step at several concentrations: the scene of Fig. 7 with `kick`, 2000 replicas.
for per_cm3 in 50 200 500 1000; do
  printf '| %s |' "$per_cm3"
  for steps in 200 800 3200; do
    kept "dense-$per_cm3-$steps" bash -c "shearbed run fig7-n50 --replicas 2000 --set interaction.concentration_per_cm3=$per_cm3 \
      --set interaction.update='\"kick\"' --set time.periods=2 --set time.outputs_per_period=1 \
      --set time.steps_per_period=$steps --out out --force --quiet 2>&1 && cat out/projections.csv" |
      tail -n 1 | awk -F, '{ printf " %.4f |", $4 }'
  done
  echo
done
