//! The content of each figure, with its caption.

use super::beside::{EIGHTH, near};
use super::measured::measured;
use super::run::{Run, Runs, amplitude};
use super::*;
use crate::oracle::closed_form;
use crate::present::table::two_digits;

const PROJECTION: &str = "mean projection (rod lengths)";
const AMPLITUDE: &str = "amplitude A₁ of X̄₁ (rod lengths)";

/// All figures, in the paper's order.
pub(super) fn figures(runs: &Runs, effort: &Effort) -> Result<Vec<ReportFigure>, String> {
    let mut figures = vec![fig4_differences(runs)?, fig4(runs, effort)?, fig5(runs, effort)?, fig6_overlaid(runs)?];
    figures.extend(fig6(runs)?);
    figures.extend(amplitudes(runs)?);
    figures.push(one_family(runs)?);
    figures.push(fig11(runs)?);
    figures.push(fig12(runs)?);
    Ok(figures)
}

/// A figure of the paper against time, its vertical axis up to `most`; the catalogue has the cases that cite it.
fn against_time(
    [name, title]: [&str; 2],
    source: &str,
    caption: impl Into<String>,
    (y_name, most): (&str, f64),
    curves: Vec<Curve>,
) -> ReportFigure {
    ReportFigure::new([name, title], caption, ["time t/T (periods)", y_name])
        .curves(curves)
        .spans(Some((0.0, 6.0)), Some((0.0, most)))
        .judged(source, &[])
}

fn projections(run: &Run) -> Vec<Curve> {
    let channels = [("x1", "X̄₁ (gradient)"), ("x2", "X̄₂ (flow)"), ("x3", "X̄₃ (vorticity)")];
    channels.map(|(channel, label)| run.curve(channel, label)).into()
}

fn fig4(runs: &Runs, effort: &Effort) -> Result<ReportFigure, String> {
    let words = ["fig4", "Fig. 4: X̄₁ at three concentrations, α = 0.5"];
    let mut figure = against_time(words, "Fig. 4, eqs 4, 15", "", (PROJECTION, 0.5), Vec::new());
    let drawn = &mut figure.figure;
    let mut supplied = Vec::new();
    for n in [20, 50, 100] {
        let scene = format!("fig4-n{n}");
        let label = format!("n = {n} cm⁻³");
        drawn.curves.push(runs.get(&scene)?.curve("x1", label.as_str()));
        let known = drawn.points.len();
        supplied.push(format!("{label}: {}", measured(&scene, effort, drawn)?));
        for points in &mut drawn.points[known..] {
            points.label = format!("{label}, {}", points.label);
        }
    }
    figure.caption = format!(
        "The oscillation of X̄₁ about a plateau dies out, faster where n is larger. The maxima stay at multiples of \
         T/2. {}",
        supplied.join(" ")
    );
    Ok(figure)
}

/// The differences between the curves of Fig. 4, which are too close to be distinguished there.
fn fig4_differences(runs: &Runs) -> Result<ReportFigure, String> {
    let first = runs.get("fig4-n20")?;
    let curve = |n: u32| Ok(runs.get(&format!("fig4-n{n}"))?.less(first, "x1", format!("n = {n} less n = 20")));
    Ok(ReportFigure::new(
        ["fig4-differences", "Fig. 4: change of X̄₁ with concentration"],
        "Where n is larger, the maxima are lower and the minima higher. Replicas with the same random numbers are \
         compared, so that the band is narrower than those of the curves.",
        ["time t/T (periods)", "difference of X̄₁ (rod lengths)"],
    )
    .curves([50, 100].map(curve).into_iter().collect::<Result<Vec<_>, String>>()?)
    .spans(Some((0.0, 6.0)), None)
    .judged("Fig. 4, eqs 4, 15", &[]))
}

/// The results of Fig. 4 in numbers.
pub(super) fn answer(runs: &Runs) -> Result<String, String> {
    let at = |n: u32| {
        let run = runs.get(&format!("fig4-n{n}"))?;
        let output = run.times().iter().position(|t| (t - 2.0).abs() < 1e-9);
        let sample = run.sample("x1", |x1| output.map_or(f64::NAN, x1));
        Ok::<_, String>(format!("{} at n = {n}", two_digits(sample.mean, sample.se)))
    };
    Ok(format!(
        "In Fig. 4 X̄₁ at its maximum at t/T = 2 is {}, {} and {} per cm³; measured points are needed to say \
         whether nature does so too.",
        at(20)?,
        at(50)?,
        at(100)?
    ))
}

fn fig5(runs: &Runs, effort: &Effort) -> Result<ReportFigure, String> {
    let words = ["fig5", "Fig. 5: r_e = 14.2, σ = 8.5 %, n = 500 cm⁻³"];
    let curves = projections(runs.get("fig5")?);
    let mut figure = against_time(words, "Fig. 5, eqs 4, 11", "", (PROJECTION, 1.0), curves);
    let supplied = measured("fig5", effort, &mut figure.figure)?;
    figure.caption = format!(
        "The oscillations are damped out by t/T = 3, and X̄₁ stays where it is. X̄₃ still falls slowly and X̄₂ rises: \
         the orbits become steady later than the phases, and `steady-stays-put` judges what comes then. {supplied}"
    );
    Ok(figure)
}

/// X̄₁ of the three panels in one picture.
fn fig6_overlaid(runs: &Runs) -> Result<ReportFigure, String> {
    let scenes = [
        ("fig6-uniform", "free, one size"),
        ("fig6-polydisperse", "free, σ = 3.6 %"),
        ("fig6-interacting", "one size, n = 50 cm⁻³"),
    ];
    let curves = scenes.map(|(scene, label)| Ok(runs.get(scene)?.curve("x1", label)));
    Ok(against_time(
        ["fig6", "Fig. 6: X̄₁ without damping, with unequal sizes, with collisions"],
        "Fig. 6, eq. 4",
        "The spread of r_e alone, and collisions alone, damp the oscillation; free rods of one size keep it. The three \
         panels below have all projections.",
        (PROJECTION, 0.5),
        curves.into_iter().collect::<Result<_, String>>()?,
    ))
}

fn fig6(runs: &Runs) -> Result<Vec<ReportFigure>, String> {
    let panels = [
        (
            ["fig6-uniform", "Fig. 6, top: free rods of one size"],
            "Undamped: every half period repeats the first, from X̄₁ ≈ 1/2 down to almost 0.",
        ),
        (
            ["fig6-polydisperse", "Fig. 6, middle: free rods, σ = 3.6 %"],
            "Rods of different sizes turn at different rates, and the oscillation dies out without any collision.",
        ),
        (
            ["fig6-interacting", "Fig. 6, bottom: one size, n = 50 cm⁻³"],
            "Collisions alone damp the oscillation as well; the period is the same in all three panels.",
        ),
    ];
    let panel = |(words, caption): ([&str; 2], &str)| {
        let curves = projections(runs.get(words[0])?);
        Ok(against_time(words, "Fig. 6, eq. 4", caption, (PROJECTION, 1.0), curves))
    };
    panels.into_iter().map(panel).collect()
}

/// The scenes of a figure with their labels.
type Compared = &'static [(&'static str, &'static str)];

/// Figs 7 to 10: number, scenes, title, expected feature.
const AMPLITUDES: [(u32, Compared, &str, &str); 4] = [
    (
        7,
        &[("fig7-n20", "n = 20 cm⁻³"), ("fig7-n50", "n = 50 cm⁻³"), ("fig7-n100", "n = 100 cm⁻³")],
        "A₁ and the concentration",
        "The amplitude decays faster where n is larger. A₁ is the height of a maximum of X̄₁ above the mean of the \
         minima on its two sides: the paper defines it in a drawing that is not at hand, and this interpretation gives \
         free rods of one size the \"approximately 1/2\" of its text.",
    ),
    (
        8,
        &[("fig8-a0.36", "a = 0.36 mm"), ("fig8-a0.72", "a = 0.72 mm"), ("fig8-a1.44", "a = 1.44 mm")],
        "A₁ and the rod length, n = 50 cm⁻³",
        "Longer rods of the same shape meet more often, and the amplitude decays faster.",
    ),
    (
        9,
        &[("fig9-sd0", "σ = 0"), ("fig9-sd1.8", "σ = 1.8 %"), ("fig9-sd3.6", "σ = 3.6 %"), ("fig9-sd7.2", "σ = 7.2 %")],
        "A₁ and the spread of r_e, free rods",
        "Without collisions the amplitude decays by the spread of r_e alone: not at all at σ = 0, faster the larger σ \
         is. A curve ends where its oscillation is lost in noise.",
    ),
    (
        10,
        &[
            ("fig10-interacting-sd0", "n = 50 cm⁻³, σ = 0"),
            ("fig10-free-sd0", "free, σ = 0"),
            ("fig10-interacting-sd3.6", "n = 50 cm⁻³, σ = 3.6 %"),
            ("fig10-free-sd3.6", "free, σ = 3.6 %"),
        ],
        "A₁ with and without collisions",
        "Collisions add to what the spread of r_e damps: for either σ the interacting rods lie below the free ones.",
    ),
];

fn amplitudes(runs: &Runs) -> Result<Vec<ReportFigure>, String> {
    let draw = |(number, scenes, title, caption): (u32, Compared, &str, &str)| {
        let curve = |(scene, label): &(&str, &str)| Ok(amplitude(runs.get(scene)?, *label));
        let curves = scenes.iter().map(curve).collect::<Result<_, String>>()?;
        let words = [&format!("fig{number}")[..], &format!("Fig. {number}: {title}")];
        Ok(against_time(words, &format!("Fig. {number}"), caption, (AMPLITUDE, 0.5), curves))
    };
    AMPLITUDES.into_iter().map(draw).collect()
}

/// A₁ of the first maxima of Figs 7 and 8 against α a n^(1/3) of their runs.
fn one_family(runs: &Runs) -> Result<ReportFigure, String> {
    let maxima = |(number, scenes, ..): &(u32, Compared, &str, &str), time: f64| {
        let mut heights = Vec::new();
        for (scene, _) in *scenes {
            let run = runs.get(scene)?;
            let height = near(&amplitude(run, ""), time, EIGHTH);
            heights.extend(height.map(|[y, half]| (one_length(run.scene()), y, half)));
        }
        Ok::<_, String>(Points::with_bars(format!("Fig. {number}, t/T = {time}"), heights, |height| height))
    };
    let mut figure = ReportFigure::new(
        ["fig7-fig8", "Figs 7 and 8 as one family"],
        "At the same α a n^(1/3) the amplitude is the same, whether concentration or length differs: the points of \
         Fig. 7 lie on the lines through those of Fig. 8. The run in the middle belongs to both. The law is exact, as \
         all runs have equally many rods in the cube of their concentration.",
        ["α a n^(1/3) (–)", &format!("log {AMPLITUDE}")],
    )
    .judged("Figs 7, 8, eq. 7", &["one-length-scale"]);
    for time in [0.5, 1.0, 1.5] {
        figure.figure.points.push(maxima(&AMPLITUDES[0], time)?);
        let Points { label, x, y, y_error, .. } = maxima(&AMPLITUDES[1], time)?;
        figure.figure.curves.push(Curve { label, x, y, half_band: y_error });
    }
    Ok(figure)
}

/// α a n^(1/3), the only length of rods of one size in the cube of their concentration; NaN for others.
fn one_length(scene: &Scene) -> f64 {
    let given = scene.interaction.as_ref().and_then(|given| Some((given.alpha, given.concentration_per_cm3?)));
    given.map_or(f64::NAN, |(alpha, per_cm3)| alpha * 0.1 * scene.particles.length_mm * per_cm3.cbrt())
}

/// φ̄ is averaged over the last periods of a run: whole periods, so that remaining oscillations average out.
const STEADY_PERIODS: f64 = 3.0;

fn fig11(runs: &Runs) -> Result<ReportFigure, String> {
    let mut steady = Vec::new();
    for name in ["5", "10", "11.6", "14.2", "20", "30", "50"] {
        let run = runs.get(&format!("fig11-re{name}"))?;
        let times = run.times();
        let first = times.last().copied().unwrap_or(0.0) - STEADY_PERIODS;
        let late: Vec<usize> = (0..times.len()).filter(|k| times[*k] > first + 1e-9).collect();
        let sample = run.sample("phi", |phi| late.iter().map(|k| phi(*k)).sum::<f64>() / late.len() as f64);
        steady.push(run.point((run.scene().particles.aspect_ratio, sample)));
    }
    // The table needs the curve at each point.
    let drawn = (4..=220).map(|k| 0.25 * f64::from(k));
    let mut ratios: Vec<f64> = drawn.chain(steady.iter().map(|point| point.0)).collect();
    ratios.sort_by(f64::total_cmp);
    let caption = format!(
        "The steady mean angle of interacting rods lies close to the time average of a single rod, π/4 at r_e = 1 and \
         towards π/2 for long rods. Each point is the mean over the last {STEADY_PERIODS} periods of ten, with its 95 \
         % interval."
    );
    Ok(ReportFigure::new(
        ["fig11", "Fig. 11: the steady mean angle and the aspect ratio"],
        caption,
        ["aspect ratio r_e (–)", "mean angle φ (rad)"],
    )
    .curves([Curve::of("⟨φ⟩, one rod (eq. 19)", ratios, |r| (r, closed_form::mean_angle(r)))])
    .points([Points::with_bars("steady φ̄, interacting rods", steady, |point| point)])
    .judged("Fig. 11, eqs 18, 19, 20", &[]))
}

fn fig12(runs: &Runs) -> Result<ReportFigure, String> {
    let run = runs.get("fig12")?;
    let channels = [("x1x2", "x_1x_2 plane"), ("x2x3", "x_2x_3 plane"), ("x1x3", "x_1x_3 plane")];
    let curves = channels.map(|(channel, label)| run.curve(channel, label));
    Ok(against_time(
        ["fig12", "Fig. 12: planar projections, n = 50 cm⁻³, σ = 3.6 %"],
        "Fig. 12, eq. 21",
        "Rods lie along the flow most of the time: their shadows on the two planes that hold axis 2 are long, and the \
         third oscillates most. The paper's figure shows typical results only.",
        ("planar projection (rod lengths)", 1.0),
        curves.into(),
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn eight_times_the_concentration_is_twice_the_length() {
        let of = |name: &str| one_length(&crate::input::scenes::scene(name).unwrap());
        // By hand: ½ · 0.072 cm · (50 cm⁻³)^(1/3).
        assert!((of("fig7-n50") - 0.1326251).abs() < 1e-7);
        assert_eq!(of("fig8-a1.44"), 2.0 * of("fig7-n50"));
        let mut dense = crate::input::scenes::scene("fig7-n50").unwrap();
        lab::interaction(&mut dense).concentration_per_cm3 = Some(400.0);
        assert!((one_length(&dense) / of("fig8-a1.44") - 1.0).abs() < 1e-15);
    }
}
