#!/usr/bin/env bash
# Puts deliberate mistakes into the core and the integrators, one at a time in a scratch clone, and prints which tests catch each.
# What cargo-mutants makes of itself, an operator for another, is left to mutation.sh.
# Usage: bash validation/mutants.sh [NAME ...]      (each mistake costs a build and a run of the gate)
set -euo pipefail
root=$(git -C "$(dirname "$0")" rev-parse --show-toplevel)
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
git clone --quiet "$root" "$scratch/clone"
cd "$scratch/clone"
export CARGO_TARGET_DIR="$scratch/target"

# name @@ file @@ what stands there @@ what is put there
mistakes=$(cat <<'LIST'
shape-factor-one@@src/jeffery.rs@@(aspect_ratio - inverse) / (aspect_ratio + inverse)@@1.0 + 0.0 * inverse
period-without-inverse@@src/jeffery.rs@@TAU * (aspect_ratio + 1.0 / aspect_ratio)@@TAU * aspect_ratio
phase-of-collided-rod@@src/rods.rs@@let phase = clock.phase(self.elapsed(rod, tick), clock.periods(&self.shapes, r));@@let phase = clock.phase(tick as f64, clock.periods(&self.shapes, r));
orbit-constant@@src/orientation.rs@@let in_plane = libm::hypot(p[0], p[1] / aspect_ratio);@@let in_plane = libm::hypot(p[0], p[1] * aspect_ratio);
isotropic-angle@@src/orientation.rs@@1.0 - 2.0 * r5,@@1.0 - r5,
arm-sign@@src/contact.rs@@separation.dot(&p_a.cross(&normal)) / square@@-separation.dot(&p_a.cross(&normal)) / square
sum-for-mean@@src/collision.rs@@rates[1] - line * (0.5 * gap / arm_b)@@rates[1] - line * (gap / arm_b)
printed-a13@@src/collision.rs@@(-rate.x * sin_phi + rate.y * cos_phi) / sin_theta@@(-rate.x * sin_phi + rate.y * cos_phi)
reach-without-m@@src/collision.rs@@alpha * libm::expm1(-libm::log(r) / m)@@alpha * libm::expm1(-libm::log(r) / 3.0)
next-nearest@@src/neighbours/pairs.rs@@if square < best_square && other != rod {@@if square < best_square && other != rod && (best.is_none() || other > 3) {
next-nearest-of-many@@src/neighbours/grid.rs@@let closer = square < best_square;@@let closer = square < best_square && (best.is_none() || other.rod > 3);
uniform-replacement@@src/volume.rs@@*x1 = h1 * rng.random::<f64>().sqrt();@@*x1 = h1 * rng.random::<f64>();
step-length@@src/suspension/liquid.rs@@plan.unit().strain / steps@@1.01 * plan.unit().strain / steps
liquid-at-rest@@src/suspension/liquid.rs@@Vector3::new(0.0, sign * separation.x, 0.0)@@Vector3::new(0.0, 0.0 * sign * separation.x, 0.0)
candidate-order@@src/suspension.rs@@a.0.total_cmp(&b.0).then(a.1.cmp(&b.1))@@a.1.cmp(&b.1)
deviation-not-percent@@src/rods/draw.rs@@let deviation = mean * particles.aspect_ratio_sd_percent / 100.0;@@let deviation = particles.aspect_ratio_sd_percent / 100.0;
signed-projection@@src/observable.rs@@sum.add_each(block.len, |i| p[i].abs())@@sum.add_each(block.len, |i| p[i])
standard-error@@src/ensemble.rs@@(self.deviation[k] / (replicas - 1.0) / replicas).sqrt()@@(self.deviation[k] / (replicas - 1.0)).sqrt()
flow-rate-of-a@@src/jeffery.rs@@half * (shape_factor - 1.0) * p.y@@half * (shape_factor + 1.0) * p.y
folded-angle@@src/orientation.rs@@libm::atan2(p2.abs(), p1.abs())@@libm::atan2(p1.abs(), p2.abs())
positions-half-full@@src/volume.rs@@*x = side * rng.random::<f64>();@@*x = 0.5 * side * rng.random::<f64>();
overshoot@@src/volume.rs@@let overshoot = x2.rem_euclid(h2);@@let overshoot = h2 * rng.random::<f64>();
volume-side@@src/volume.rs@@libm::cbrt(count as f64 / per_cubed_length)@@(count as f64 / per_cubed_length).sqrt()
planar-projection@@src/observable.rs@@zip([(p1, p2), (p2, p3), (p1, p3)])@@zip([(p1, p2), (p1, p3), (p2, p3)])
normal-part-changed@@src/collision.rs@@rates[0] + line * (0.5 * gap / arm_a)@@rates[0] * 0.9 + line * (0.5 * gap / arm_a)
mean-over-one-rod-less@@src/ensemble.rs@@let value = sum.value / n;@@let value = sum.value / (n - 1.0);
direction-not-rescaled@@src/propagator/mod.rs@@let scale = 1.0 / (q[0] * q[0] + q[1] * q[1] + q[2] * q[2]).sqrt();@@let scale = 1.0 + 0.0 * q[0];
kick-whole-turn@@src/suspension.rs@@norm(&(rates[k] - free[k]))@@norm(&rates[k])
short-arms-kept@@src/contact.rs@@r.abs() >= min;@@r.abs() >= 0.5 * min;
gap-without-turn@@src/collision.rs@@+ arm_b * line.dot(&rates[1]) - arm_a * line.dot(&rates[0]);@@;
rounded-rho@@src/propagator/general.rs@@(Ball::ONE.over(square), difference.over(square))@@(Ball::exact(1.0 / square.hi), difference.over(square))
replicas-share-streams@@src/random.rs@@let key = [replica, purpose as u64]@@let key = [replica / 64, purpose as u64]
kicks-bounded@@src/suspension.rs@@min_arm: interaction.min_contact_arm,@@min_arm: interaction.min_contact_arm.max(1.0),
pairs-behind-unseen@@src/neighbours/pairs.rs@@                .min(self.behind[rod])@@
rows-beside-unseen@@src/neighbours/grid.rs@@(low >= cell[axis][k] * width[axis]) &@@(low >= 0.0 * width[axis]) &
window-too-short@@src/neighbours/grid.rs@@(cell[2][high] * width[2] > x[2][k] + reach[k]);@@(cell[2][high] * width[2] > x[2][k]);
reach-rounded-down@@src/neighbours/grid.rs@@(reach(rod) as f32).next_up()@@0.9 * (reach(rod) as f32)
partners-length@@src/suspension.rs@@(self.reach.of(self.drawn[rod]) * rods.length(rod))@@(self.reach.of(self.drawn[rod]) * rods.length(nearest.other as usize))
shortest-arms-in-means@@src/suspension.rs@@self.rule.min_arm * self.rods.length(rod)@@self.rule.min_arm + 0.0 * self.rods.length(rod)
stress-by-squared-length@@src/rods.rs@@self.per_cube * length.powi(3)@@self.per_cube * length.powi(2)
inflow-by-other-side@@src/volume.rs@@*x1 = h1 * rng@@*x1 = h2 * rng
boxes-have-one-side@@src/scene.rs@@ControlVolume::of(sides.map(@@ControlVolume::of([sides[0]; 3].map(
places-drawn-anew@@src/suspension.rs@@Some(places) => volume.within(places, scene.particles.length_mm),@@Some(_) => volume.draw_positions(count, &rng(Purpose::Positions)),
lengths-of-a-file-lost@@src/rods/draw.rs@@if let Some(own) = particles.own_lengths_mm() {@@if let Some(own) = particles.own_lengths_mm().filter(|_| false) {
chunks-share-numbers@@src/random.rs@@ahead(rng, (k * CHUNK) as u64)@@ahead(rng, (0 * k * CHUNK) as u64)
replaced-share-numbers@@src/volume.rs@@ahead(rng, numbers * u128::from(left.iter().sum::<u64>()))@@ahead(rng, u128::from(left.iter().sum::<u64>()))
inflow-anywhere@@src/volume/inflow.rs@@if accepted * face.most >= self.speed_in(face, &entry) {@@if 0.0 * accepted >= self.speed_in(face, &entry) {
inflow-at-half-time@@src/volume/inflow.rs@@since * self.step@@(0.5 + 0.0 * since) * self.step
inflow-of-what-was-inside@@src/volume/inflow.rs@@!self.holds(&(self.back * x))@@self.holds(&x)
inflow-without-area@@src/volume/inflow.rs@@face.most * inflow.sides[j] * inflow.sides[k]@@face.most + 0.0 * inflow.sides[j] * inflow.sides[k]
inflow-shares-numbers@@src/volume/inflow.rs@@*rng = ahead(rng, NUMBERS);@@*rng = ahead(rng, 0 * NUMBERS);
liquid-transposed@@src/suspension/liquid.rs@@inflow.gradient() * separation@@inflow.gradient().transpose() * separation
spin-reversed@@src/jeffery.rs@@0.5 * (along - across)@@0.5 * (across - along)
collided-rods-move-too@@src/rods.rs@@u64::from(*since) <= tick)@@u64::from(*since) <= tick + 1)
all-move-as-the-first@@src/rods.rs@@mapped(map_of(maps, rod), [*p1@@mapped(&maps[0], [*p1
any-trace@@src/scene/check.rs@@trace.abs() > INCOMPRESSIBLE@@trace.abs() > 1e300 + INCOMPRESSIBLE
mirrored-free-phase@@src/rods.rs@@clock.phase(tick as f64, clock.sign)@@clock.phase(tick as f64, 1.0)
chunks-not-added@@src/observable/sum.rs@@self.value += other.value;@@self.value = other.value;
whole-turns-late@@src/phase.rs@@Self::of_part(turns.fract())@@Self::of_part((TAU * turns).sin().atan2((TAU * turns).cos()) / TAU)
larger-factor-kept@@src/propagator/modes.rs@@(Ball::ONE, exp(-lead))@@(exp(lead), Ball::ONE)
pair-error-lost@@src/propagator/modes.rs@@let omega = (-self.square).sqrt();@@let omega = (-self.square.middle()).sqrt();
projector-left-out@@src/propagator/modes.rs@@sinh - rest * middle.scaled(2.0),@@sinh,
reach-not-asked@@src/propagator/general.rs@@reached[i] || (0..3).any(@@true || (0..3).any(
kick-overflows@@src/collision.rs@@largest * (v / largest).norm()@@v.norm()
non-finite-goes-on@@src/suspension.rs@@if !end.iter().all(|component| component.is_finite()) {@@if end.iter().all(|component| component.is_infinite()) {
seconds-overflow@@src/scene/check/time.rs@@if duration_s.is_finite() {@@if !duration_s.is_nan() {
rate-overflows@@src/flow.rs@@largest * part(&Self(self.0 / largest)).norm() * std::f64::consts::SQRT_2@@part(self).norm() * std::f64::consts::SQRT_2
rk4-weights@@validation/src/integrators/fixed.rs@@y + (k1 + (k2 + k3) * 2.0 + k4) * (h / 6.0)@@y + (k1 + k2 * 3.0 + k3 + k4) * (h / 6.0)
projection-left-out@@validation/src/integrators/fixed.rs@@rk4(|y| problem.rate(&y), p, h).normalize()@@rk4(|y| problem.rate(&y), p, h)
dexp-sign@@validation/src/integrators/sphere.rs@@omega - 0.5 * once@@omega + 0.5 * once
newton-ends-early@@validation/src/integrators/sphere.rs@@if change.norm() <= NEWTON_TOLERANCE {@@if change.norm() <= 1e-3 {
newton-not-damped@@validation/src/integrators/sphere.rs@@if next.norm() < miss.norm() {@@if next.norm().is_finite() {
short-from-shape@@validation/src/integrators/problem.rs@@short: 1.0 / (1.0 + square),@@short: 0.5 - 0.5 * (square - 1.0) / (square + 1.0),
southern-half@@validation/src/integrators/exact.rs@@let p = if start.z < 0.0 { -*start } else { *start };@@let p = *start;
slope-of-p2@@validation/src/integrators/problem.rs@@p * Vector3::new(shape * p.y, shape * p.x, 0.0).transpose()@@p * Vector3::new(shape * p.y, 0.0 * shape * p.x, 0.0).transpose()
loose-tolerance@@validation/src/integrators/adaptive.rs@@start.into_inner(), tolerance, tolerance);@@start.into_inner(), 1e3 * tolerance, 1e3 * tolerance);
LIST
)
missed=0
while IFS= read -r line; do
  name=${line%%@@*} rest=${line#*@@}
  file=${rest%%@@*} rest=${rest#*@@}
  old=${rest%%@@*} new=${rest#*@@}
  if [ $# -gt 0 ] && [[ " $* " != *" $name "* ]]; then continue; fi
  text=$(cat "$file")
  if [[ $text != *"$old"* ]]; then echo "$name: its text is not in $file any more"; missed=1; continue; fi
  printf '%s\n' "${text/"$old"/"$new"}" >"$file"
  log="$scratch/$name.txt"
  code=0
  cargo test --no-fail-fast -p shearbed >"$log" 2>&1 || code=$?
  cargo test --no-fail-fast -p shearbed-suite --lib --test gate >>"$log" 2>&1 || code=$?
  caught=$(sed -nE 's/^test ([^ ]+) .*FAILED$/\1/p' "$log" | sort -u | paste -sd ' ')
  if [ "$code" = 0 ]; then missed=1; echo "$name: MISSED"; else echo "$name: ${caught:-$(grep -m1 '^error' "$log")}"; fi
  git checkout --quiet -- .
done <<<"$mistakes"
exit $missed
