//! Mistakes that are no wrong value of one key: what is missing, unknown, at odds with another key, or no TOML.

use super::{EXTENSION, INTERACTING, REVERSED, STEPPED};
use crate::refusal;

/// A part of the scene, what takes its place, and the message.
#[rustfmt::skip]
const OTHER_MISTAKES: &[(&str, &str, &str, &str)] = &[
    // A table or a key that is missing.
    (INTERACTING, "title = \"t\"\n", "", "1: title is missing: expected a text in quotes"),
    (INTERACTING, "[flow]\nshear_rate_per_s = 0.5\n", "", "1: flow is missing: expected a table [flow] with "),
    (INTERACTING, "shear_rate_per_s = 0.5", "", "2: flow.shear_rate_per_s is missing: shear_rate_per_s, gradient_per_s \
        or steps"),
    (INTERACTING, "count = 10\n", "", "4: particles.count is missing: expected a whole number from 1 to 100000000"),
    (INTERACTING, "alpha = 0.5\n", "", "10: interaction.alpha is missing: expected a finite number ≥ 0"),
    (INTERACTING, "periods = 1\n", "", "16: time.periods is missing: periods, strain or seconds must be given"),
    (EXTENSION, "[time]\nstrain = 2\noutputs_per_strain = 10\n", "",
     "1: time is missing: expected a table [time] with periods"),
    // An unknown key or table.
    (INTERACTING, "count", "cuont", "5: cuont = 10: unknown key `cuont`, expected one of `count`, `length_mm`"),
    (INTERACTING, "alpha", "α", "12: α = 0.5: "),
    (INTERACTING, "[particles]", "[particle]",
     "4: [particle]: unknown key `particle`, expected one of `title`, `flow`"),
    (INTERACTING, "title", "name = 1\ntitle", "1: name = 1: unknown key `name`, expected one of `title`"),
    (INTERACTING, "seed", "speed", "22: speed = 1: unknown key `speed`, expected `replicas` or `seed`"),
    (INTERACTING, "observables", "observable",
     "24: observable = [\"projections\"]: unknown key `observable`, expected"),
    // Something else where a table should be.
    (EXTENSION, "title = \"t\"\n", "title = \"t\"\noutput = 3\n", "2: output = 3 is not allowed: expected a table \
        [output]"),
    (EXTENSION, "[time]", "[[time]]", "9: time = "),
    // What does not go together.
    (EXTENSION, "aspect_ratio = 11.6", "aspect_ratio = 11.6\nphysical_aspect_ratio = 20\nshape_correlation = \"cox\"",
     "7: particles.aspect_ratio = 11.6 is not allowed: either aspect_ratio or physical_aspect_ratio, not both"),
    (EXTENSION, "aspect_ratio = 11.6\n", "", "4: particles.aspect_ratio is missing: expected "),
    (INTERACTING, "shear_rate", "gradient_per_s = [[0,0,0],[1,0,0],[0,0,0]]\nshear_rate",
     "4: flow.shear_rate_per_s = 0.5 is not allowed: either shear_rate_per_s or gradient_per_s, not both"),
    (EXTENSION, "gradient_per_s = [[-0.5, 0, 0], [0, 1, 0], [0, 0, -0.5]]", "shear_rate_per_s = 1e-308",
     "3: flow.shear_rate_per_s = 1e-308 is not allowed: such that the run lasts a finite number of seconds"),
    (EXTENSION, "[[-0.5, 0, 0], [0, 1, 0], [0, 0, -0.5]]", "[[0, -5e-324, 0], [5e-324, 0, 0], [0, 0, 5e-324]]",
     "3: flow.gradient_per_s = [[0, -5e-324, 0], [5e-324, 0, 0], [0, 0, 5e-324]] is not allowed: such that the run"),
    (EXTENSION, "[[-0.5, 0, 0], [0, 1, 0], [0, 0, -0.5]]", "[[1e308, 0, 0], [0, -1e308, 0], [0, 0, 0]]",
     "3: flow.gradient_per_s = [[1e308, 0, 0], [0, -1e308, 0], [0, 0, 0]] is not allowed: such that the run"),
    (INTERACTING, "shear_rate_per_s = 0.5", "gradient_per_s = [\n  [1, 0, 0],\n  [0, -1, 0], [0, 0, 0.1]]",
     "3: flow.gradient_per_s = [ [1, 0, 0], [0, -1, 0], [0, 0, 0.1]] is not allowed: where rods interact, a gradient \
      with ∂u_1/∂x_1 + "),
    (INTERACTING, "periods = 1", "periods = 1\nstrain = 1",
     "17: time.periods = 1 is not allowed: either periods or strain, not both"),
    (INTERACTING, "periods = 1\nsteps_per_period = 20", "periods = 101\nsteps_per_period = 10000000",
     "17: time.periods = 101 is not allowed: at most 1e9 steps in all"),
    (INTERACTING, "periods = 1", "strain = 1",
     "18: time.steps_per_period = 20 is not allowed: goes with periods; strain takes steps_per_strain"),
    (INTERACTING, "steps_per_period = 20", "outputs_per_strain = 5",
     "18: time.outputs_per_strain = 5 is not allowed: goes with strain; periods take outputs_per_period"),
    (INTERACTING, "concentration_per_cm3 = 50", "concentration_per_cm3 = 1e-320",
     "11: interaction.concentration_per_cm3 = 1e-320 is not allowed: expected a number for which the control volume"),
    (EXTENSION, "strain = 2\noutputs_per_strain = 10", "periods = 2",
     "10: time.periods = 2 is not allowed: rods of this aspect ratio have no period in this flow: give strain"),
    (EXTENSION, "strain = 2", "strain = 2\noutputs_per_period = 5",
     "11: time.outputs_per_period = 5 is not allowed: goes with periods"),
    (EXTENSION, "strain = 2", "strain = 2\nsteps_per_period = 5",
     "11: time.steps_per_period = 5 is not allowed: goes with periods"),
    (EXTENSION, "[[-0.5, 0, 0], [0, 1, 0], [0, 0, -0.5]]", "[[0, -1, 0], [1, 0, 0], [0, 0, 0]]",
     "10: time.strain = 2 is not allowed: this flow has no strain rate: give periods"),
    (EXTENSION, "outputs_per_strain = 10", "outputs_per_strain = 10\n[output]\nobservables = [\"particle_stress\"]",
     "13: output.observables = [\"particle_stress\"] is not allowed: particle_stress needs plane Couette flow"),
    (INTERACTING, "[\"projections\"]", "[\"projections\", \"stress\"]",
     "1: liquid.viscosity_pa_s is missing: give it, for stress is in Pa"),
    (INTERACTING, "[particles]", "[liquid]\nviscosity_pa_s = 0\n[particles]",
     "5: liquid.viscosity_pa_s = 0 is not allowed: expected a finite number > 0"),
    (EXTENSION, "outputs_per_strain = 10", "outputs_per_strain = 10\n[output]\nobservables = [\"orbit_constant\"]",
     "13: output.observables = [\"orbit_constant\"] is not allowed: orbit_constant needs plane Couette flow"),
    // The same shear in other axes, in which eq. 13 holds no more.
    (EXTENSION, "[[-0.5, 0, 0], [0, 1, 0], [0, 0, -0.5]]", "[[0, 1, 0], [0, 0, 0], [0, 0, 0]]\n[output]\nobservables = \
        [\"orbit_constant\"]",
     "5: output.observables = [\"orbit_constant\"] is not allowed: orbit_constant needs plane Couette flow"),
    // Flows one after another.
    (REVERSED, "strain = 3, ", "", "3: flow.steps.strain is missing: expected a finite number > 0"),
    (REVERSED, "strain = 3", "strain = -3", "3: flow.steps.strain = -3 is not allowed: expected a finite number > 0"),
    (REVERSED, "rate_per_s = 1", "rate_per_s = 0", "3: flow.steps.shear_rate_per_s = 0 is not allowed: expected a \
        finite number other"),
    (REVERSED, "strain = 3, ", "strain = 3, shear_rate_per_s = 1, ", "3: flow.steps.shear_rate_per_s = 1 is not \
        allowed: either it or"),
    (REVERSED, "[-1, 0, 0]", "[-1, 0]", "3: flow.steps.gradient_per_s = [[0, 0, 0], [-1, 0], [0, 0, 0]] is not \
        allowed: expected three"),
    (REVERSED, "[-1, 0, 0]", "[0, 0, 0]", "3: flow.steps.gradient_per_s = [[0, 0, 0], [0, 0, 0], [0, 0, 0]] is not \
        allowed: expected three"),
    (REVERSED, "strain = 3", "strain = 3, periods = 1", "3: flow.steps.periods = 1 is not allowed: strain, shear_rate"),
    (REVERSED, "strain = 5", "strain = 6", "10: time.strain = 6 is not allowed: at most 5, the strain of all \
        flow.steps"),
    (REVERSED, "strain = 5", "periods = 1", "10: time.periods = 1 is not allowed: no periods where one flow follows"),
    (REVERSED, "rate_per_s = 1", "rate_per_s = 1e-310", "3: flow.steps = [{ shear_rate_per_s = 1e-310, strain = 2 }, "),
    (REVERSED, "[time]", "[interaction]\nalpha = 1\nconcentration_per_cm3 = 1\n[time]", "3: flow.steps = "),
    (REVERSED, "strain = 5", "strain = 5\n[output]\nobservables = [\"orbit_constant\"]",
     "12: output.observables = [\"orbit_constant\"] is not allowed: orbit_constant needs plane Couette flow"),
    // Boxes and lengths.
    (INTERACTING, "concentration_per_cm3 = 50", "",
     "10: interaction.concentration_per_cm3 is missing: concentration_per_cm3, box_mm or particles.volume_fraction \
      must be given"),
    (INTERACTING, "concentration_per_cm3 = 50", "concentration_per_cm3 = 33.4\nbox_mm = [12, 5, 5]",
     "11: interaction.concentration_per_cm3 = 33.4 is not allowed: either it or box_mm, or both where they agree to \
      1e-3: 10 rods in [12.0, 5.0, 5.0] mm are 33.333"),
    (INTERACTING, "concentration_per_cm3 = 50", "box_mm = [12, 5]",
     "11: interaction.box_mm = [12, 5] is not allowed: expected [H1, H2, H3], three finite numbers > 0"),
    (INTERACTING, "concentration_per_cm3 = 50", "box_mm = [12, 5, 5, 5]",
     "11: interaction.box_mm = [12, 5, 5, 5] is not"),
    (INTERACTING, "concentration_per_cm3 = 50", "box_mm = [12, 5, 0]", "11: interaction.box_mm = [12, 5, 0] is not"),
    (INTERACTING, "concentration_per_cm3 = 50", "box_mm = [12, 5, nan]",
     "11: interaction.box_mm = [12, 5, nan] is not"),
    (INTERACTING, "concentration_per_cm3 = 50", "box_mm = \"cube\"", "11: interaction.box_mm = \"cube\" is not"),
    (INTERACTING, "concentration_per_cm3 = 50", "box_mm = [1e-300, 1e-300, 1e-300]",
     "11: interaction.box_mm = [1e-300, 1e-300, 1e-300] is not allowed: lengths for which the sides over the rods'"),
    (INTERACTING, "aspect_ratio_sd_percent = 3.6", "length_sd_percent = 33.4",
     "8: particles.length_sd_percent = 33.4 is not allowed: expected a number below 33.3333: with more, lengths ≤ 0"),
    (INTERACTING, "aspect_ratio_sd_percent = 3.6", "length_sd_percent = -1",
     "8: particles.length_sd_percent = -1 is not allowed: expected a finite number ≥ 0"),
    // Rods that diffuse.
    (INTERACTING, "aspect_ratio_sd_percent = 3.6", "rotary_diffusion_per_s = 0.1",
     "8: particles.rotary_diffusion_per_s = 0.1 is not allowed: 0, as rods with an [interaction] table do not diffuse"),
    (REVERSED, "aspect_ratio = 11.6", "aspect_ratio = 11.6\nrotary_diffusion_per_s = 0.1",
     "8: particles.rotary_diffusion_per_s = 0.1 is not allowed: 0, as rods in flow.steps do not diffuse"),
    // Times.
    (INTERACTING, "periods = 1", "periods = 1\nseconds = 2",
     "17: time.periods = 1 is not allowed: either periods or seconds, not both"),
    (EXTENSION, "strain = 2", "strain = 2\nseconds = 2",
     "10: time.strain = 2 is not allowed: either strain or seconds, not both"),
    (EXTENSION, "strain = 2", "seconds = 2",
     "11: time.outputs_per_strain = 10 is not allowed: goes with strain; seconds take outputs_per_second"),
    (EXTENSION, "strain = 2\noutputs_per_strain = 10", "seconds = 2\nsteps_per_strain = 2",
     "11: time.steps_per_strain = 2 is not allowed: goes with strain; seconds take steps_per_second"),
    (INTERACTING, "[0, 0.5]", "[0.15]",
     "25: output.rods_at = [0.15] is not allowed: different output times, k/10 up to 1; 0.15 is not one of them"),
    (INTERACTING, "[0, 0.5]", "[0, 1.1]",
     "25: output.rods_at = [0, 1.1] is not allowed: different output times, k/10 up to 1; 1.1 is not one of them"),
    (INTERACTING, "[0, 0.5]", "[0.5, 0.5000001]", "25: output.rods_at = [0.5, 0.5000001] is not allowed: different \
        output times, k/10 up to 1; 0.5000001 is not one of them"),
    (INTERACTING, "outputs_per_period = 10", "outputs_per_second = 2",
     "19: time.outputs_per_second = 2 is not allowed: goes with seconds; periods take outputs_per_period"),
    (INTERACTING, "rods_at", "times = [0.5]\nrods_at",
     "19: time.outputs_per_period = 10 is not allowed: either it or output.times, not both"),
    (STEPPED, "= 100", "= 100\n[output]\ntimes = [0.5, 1.5]",
     "16: output.times = [0.5, 1.5] is not allowed: up to 1e6 times within the run, which ends at time.periods = 1"),
    (STEPPED, "= 100", "= 100\n[output]\ntimes = [0.5, 0.25]",
     "16: output.times = [0.5, 0.25] is not allowed: expected a list of finite numbers ≥ 0 that grow"),
    (STEPPED, "= 100", "= 100\n[output]\ntimes = [0.125, 0.5]",
     "16: output.times = [0.125, 0.5] is not allowed: interacting rods need different times on their steps, k/100; \
      0.125 is not one of them: set steps_per_period"),
    (STEPPED, "= 100", "= 100\n[output]\ntimes = [0.5, 0.50000001]",
     "16: output.times = [0.5, 0.50000001] is not allowed: interacting rods need different times on their steps, \
      k/100; 0.50000001 is not one of them"),
    (STEPPED, "= 100", "= 100\n[output]\ntimes = [0.5]\nrods_at = [0.25]",
     "17: output.rods_at = [0.25] is not allowed: different output times, of output.times; 0.25 is not one of them"),
    (STEPPED, "periods = 1\nsteps_per_period = 100", "steps_per_second = 2",
     "12: time.periods is missing: periods, strain or seconds must be given"),
    // What is no TOML.
    (INTERACTING, "alpha = 0.5", "alpha =", "12: alpha =: "),
    (INTERACTING, "alpha = 0.5", "alpha = 0.5.1", "12: alpha = 0.5.1: "),
    (INTERACTING, "alpha = 0.5", "alpha", "12: alpha: key with no value, expected `=`"),
    (INTERACTING, "alpha = 0.5", "alpha = 0.5\nalpha = 0.5", "13: alpha = 0.5: duplicate key"),
    (INTERACTING, "[time]", "[flow]", "16: [flow]: duplicate key"),
    (INTERACTING, "[time]", "[time", "16: [time: unclosed table, expected `]`"),
    (INTERACTING, "title = \"t\"", "title = \"t", "1: title = \"t: "),
];

#[test]
fn any_other_mistake_is_named_with_its_line() {
    for (scene, part, replacement, start) in OTHER_MISTAKES {
        assert!(scene.contains(part), "{part}");
        let refusal = refusal(&scene.replacen(part, replacement, 1));
        assert!(refusal.starts_with(&format!("dir/s.toml:{start}")), "{start}\n{refusal}");
        assert_eq!(refusal.lines().count(), 1, "{refusal}");
    }
}
